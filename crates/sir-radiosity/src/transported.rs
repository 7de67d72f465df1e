//! The outcome of a transport.

use crate::counted::Counted;
use crate::model::Model;
use crate::power::{PowerUnit, Quanta};
use crate::received::Received;
use crate::solution::Solution;
use crate::totals::{Balance, Counts};
use crate::workers::{OneWorker, Workers};

/// The light after all reflections.
#[derive(Clone, Debug)]
pub struct Transported {
    /// Power received by each side, without what counted lines have brought: that of shots and random walks; in replicas,
    /// of all lines.
    pub uncounted: Received,
    /// What counted lines have brought; `None` in replicas.
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

impl Transported {
    /// Returns the power received by each side, direct and indirect, with the variance that this run states.
    #[must_use]
    pub fn received(&self, model: &Model, workers: &dyn Workers) -> Received {
        let mut received = self.uncounted.clone();
        if let Some(counted) = &self.counted {
            counted.add_to(&mut received, model, workers);
        }
        received
    }

    /// Returns the irradiance of all sides.
    #[must_use]
    pub fn solution(&self, model: &Model) -> Solution {
        Solution::new(model, &self.received(model, &OneWorker), self.unit)
    }
}
