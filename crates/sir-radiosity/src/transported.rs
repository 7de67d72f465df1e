//! The outcome of a transport.

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
    /// Size of a quantum.
    pub unit: PowerUnit,
    /// Energy balance of this stage.
    ///
    /// In multipath, `emitted` is the power that the lines took from the sources by forecast, which differs from the
    /// reflected direct power by chance. In batches it is the reflected direct power.
    pub balance: Balance,
    /// Counts of lines and hits.
    pub counts: Counts,
    /// Power added to the received power for what is unshot at the end. Zero in multipath, where the unshot power is
    /// missing.
    pub extrapolated: Quanta,
}
