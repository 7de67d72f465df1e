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
    /// The size of a quantum.
    pub unit: PowerUnit,
    /// Where the power of this stage went.
    ///
    /// In multipath, `emitted` is what the lines took from the sources by forecast, which differs from the reflected
    /// direct power by chance; in batches it is that power.
    pub balance: Balance,
    /// What the lines met.
    pub counts: Counts,
    /// Power added to what was received to make up for the unshot; none in multipath, where the unshot is missing.
    pub extrapolated: Quanta,
}
