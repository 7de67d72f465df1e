//! Which view factors to compute, and how well.

use std::num::NonZeroUsize;
use std::path::PathBuf;

use serde::Serialize;
use sir_geom::SidesPolicy;
use sir_radiosity::ViewFactorSettings;

/// Which view factors to compute, and how well.
#[derive(Clone, Debug)]
pub struct ViewFactorsOptions {
    /// The scene file.
    pub scene: PathBuf,
    /// What makes a group of surfaces.
    pub by: By,
    /// Which sides of surfaces send and receive. The other sides absorb: what arrives there is `blocked`.
    pub sides: SidesPolicy,
    /// When to stop, and the seed.
    pub settings: ViewFactorSettings,
    /// Also adjust the factors, within their errors, so that they obey reciprocity and each row adds up to 1.
    pub closure: bool,
    /// Directory for the files; `None` to write nothing.
    pub out: Option<PathBuf>,
    /// Whether to replace view factors in `out`.
    pub force: bool,
    /// Threads of each process; `None` for one per processor core.
    pub threads: Option<NonZeroUsize>,
}

/// What makes a group of surfaces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum By {
    /// A material.
    #[default]
    Material,
    /// A name: of a node, or else of its mesh (glTF); in an `o` or `g` statement (OBJ).
    Group,
}
