//! Light that a run has computed.

use std::sync::Arc;

use sir_geom::Rgb;
use sir_mesh::{Per, SideSums};
use sir_radiosity::Solution;

/// Light after a stage.
pub(crate) struct Computed {
    pub(crate) solution: Solution,
    /// Parts of the scene for which there are tables.
    pub(crate) parts: Vec<PartErrors>,
    /// Name of the stage after which it is, if a later stage changes the light.
    pub(crate) not_final: Option<&'static str>,
    /// Direct irradiance \[W/m²\], if a page needs it and it is known.
    pub(crate) direct: Option<Arc<[Rgb]>>,
}

/// Parts of the scene, with the standard errors of their light.
pub(crate) struct PartErrors {
    pub(crate) sums: Arc<SideSums>,
    /// Standard errors of irradiance and radiosity \[W/m²\], if the spread of repeats tells them.
    pub(crate) errors: Option<Vec<[Rgb; 2]>>,
}

impl Computed {
    /// Returns the parts of this kind, if the pipeline has a table of them.
    pub(crate) fn parts(&self, per: Per) -> Option<&PartErrors> {
        self.parts.iter().find(|parts| parts.sums.per() == per)
    }
}
