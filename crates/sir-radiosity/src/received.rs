//! Power received by the sides of patches.

use sha2::{Digest, Sha256};
use sir_mesh::SideId;

use crate::Quanta;

/// Power received per side, and the sum of the squares of what each line brought.
///
/// If lines bring the amounts `w` independently, the variance of their sum is estimated by `Σw²` (compound Poisson);
/// that is where the standard errors of a single run come from.
#[derive(Clone, Debug, PartialEq)]
pub struct Received {
    /// Power received, indexed by [`SideId`].
    pub power: Vec<Quanta>,
    /// Estimated variance of `power` per band \[quanta²\], indexed by [`SideId`].
    pub variance: Vec<[f64; 3]>,
}

impl Received {
    /// Nothing received yet on this number of sides.
    #[must_use]
    pub fn nothing(sides: usize) -> Self {
        Self { power: vec![Quanta::ZERO; sides], variance: vec![[0.0; 3]; sides] }
    }

    /// A line brings power to a side.
    #[inline]
    pub fn add(&mut self, side: SideId, power: Quanta) {
        self.power[side.index()] += power;
        let variance = &mut self.variance[side.index()];
        for (v, p) in variance.iter_mut().zip(power.0) {
            *v += p as f64 * p as f64;
        }
    }

    /// SHA-256 of the tallies in hexadecimal: the same for the same result, on any machine.
    #[must_use]
    pub fn hash(&self) -> String {
        let mut hasher = Sha256::new();
        for power in &self.power {
            for band in power.0 {
                hasher.update(band.to_le_bytes());
            }
        }
        hasher.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
    }
}
