//! The outcome of a transport.

use crate::counted::Counted;
use crate::power::{PowerUnit, Quanta};
use crate::received::Received;
use crate::solution::Solution;
use crate::totals::{Balance, Counts};

/// The light after all reflections.
#[derive(Clone, Debug)]
pub struct Transported {
    /// Irradiance of all sides.
    pub solution: Solution,
    /// Power received by each side, direct and indirect: the exact tallies.
    pub received: Received,
    /// What the lines have brought, of which `received` has an estimate; `None` in replicas.
    pub counted: Option<Counted>,
    /// Size of a quantum.
    pub unit: PowerUnit,
    /// Energy balance of this stage.
    ///
    /// In multipath, `emitted` is the power that the lines took from the sources by forecast, which differs from the
    /// reflected direct power by chance. In batches it is the reflected direct power.
    pub balance: Balance,
    /// Counts of lines and hits.
    pub counts: Counts,
    /// What was unshot when the lines ended, and was sent on by random walks. Nothing in replicas, where the unshot power
    /// is missing.
    pub walked: Walked,
}

/// Power that random walks have sent on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Walked {
    /// Number of walks.
    pub walks: u64,
    /// Power with which they started.
    pub power: Quanta,
}
