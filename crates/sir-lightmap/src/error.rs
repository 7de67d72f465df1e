//! Errors of lightmaps.

use std::path::PathBuf;

use sir_geom::LoadError;
use sir_view::ViewError;
use thiserror::Error;

/// Error of making or writing a lightmap.
#[derive(Debug, Error)]
pub enum LightmapError {
    /// The glTF file of the scene cannot be read again.
    #[error(transparent)]
    Load(#[from] LoadError),
    /// A file cannot be written.
    #[error(transparent)]
    View(#[from] ViewError),
    /// The charts do not fit the pages.
    #[error("{what}; set `size: {needed}` or more, or a smaller `{or}`")]
    TooSmall {
        /// What does not fit, and why.
        what: String,
        /// Size with which they would fit \[texels\].
        needed: u32,
        /// Field that is another remedy.
        or: &'static str,
    },
    /// The surfaces cannot be unwrapped.
    #[error("the surfaces of the scene cannot be unwrapped: {0}")]
    Unwrap(uvunwrap::Error),
    /// A reference in the glTF file is wrong.
    #[error("cannot write the lit scene: {}: {what}", path.display())]
    Document {
        /// Path of the glTF file.
        path: PathBuf,
        /// The problem.
        what: String,
    },
    /// The work was stopped.
    #[error("the lightmap was stopped before it was complete")]
    Stopped,
}
