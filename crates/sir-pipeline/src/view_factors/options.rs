//! The options of a computation of view factors.

use std::num::NonZeroUsize;
use std::path::PathBuf;

use serde::Serialize;
use sir_geom::SidesPolicy;
use sir_radiosity::ViewFactorSettings;

/// Options of a computation of view factors.
#[derive(Clone, Debug)]
pub struct ViewFactorsOptions {
    /// The scene file.
    pub scene: PathBuf,
    /// Criterion by which surfaces are grouped.
    pub by: By,
    /// Sides of surfaces that send and receive. The other sides absorb: the share that arrives there is `blocked`.
    pub sides: SidesPolicy,
    /// Stopping criteria, and the seed.
    pub settings: ViewFactorSettings,
    /// True to also adjust the factors, within their errors, to satisfy reciprocity and row sums of 1.
    pub closure: bool,
    /// Directory of the files; `None` to write nothing.
    pub out: Option<PathBuf>,
    /// True to replace view factors in `out`.
    pub force: bool,
    /// Number of threads of each process; `None` for one per processor core.
    pub threads: Option<NonZeroUsize>,
}

/// Criterion by which surfaces are grouped.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum By {
    /// The material.
    #[default]
    Material,
    /// The name: of the node, or else of its mesh (glTF); in an `o` or `g` statement (OBJ).
    Group,
}
