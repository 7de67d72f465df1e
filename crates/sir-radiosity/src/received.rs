//! Power received by the sides of patches.

use sha2::{Digest, Sha256};

use crate::power::Quanta;
use crate::power::visit_quanta;
use crate::visitor::Visitor;
use crate::visitor::visit_floats;

/// Power received per side, with its variance.
#[derive(Clone, Debug, PartialEq)]
pub struct Received {
    /// Power received, indexed by [`SideId`](sir_mesh::SideId).
    pub power: Vec<Quanta>,
    /// Estimated variance of `power` per band \[quanta²\], indexed by [`SideId`](sir_mesh::SideId).
    ///
    /// If lines bring the amounts `w` independently, the variance of their sum is about `Σw²` (compound Poisson), and
    /// smaller where the number of lines is corrected. The standard errors of a single run follow from it.
    pub variance: Vec<[f32; 3]>,
}

impl Received {
    /// Returns zero power for this number of sides.
    #[must_use]
    pub fn nothing(sides: usize) -> Self {
        Self { power: vec![Quanta::ZERO; sides], variance: vec![[0.0; 3]; sides] }
    }

    /// Returns the SHA-256 hash of the tallies in hexadecimal. It is the same for the same result on any machine.
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

    pub(crate) fn visit(&mut self, visitor: &mut dyn Visitor) {
        visit_quanta(&mut self.power, visitor);
        visit_floats(&mut self.variance, visitor);
    }
}
