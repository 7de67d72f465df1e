//! The error type of view factors.

use std::path::PathBuf;

use sir_radiosity::{ClosureError, ModelError};
use thiserror::Error;

use crate::error_kind::ErrorKind;

/// Failure of a computation of view factors.
#[derive(Debug, Error)]
pub enum ViewFactorsError {
    /// View factors between named parts are requested, but no part has a name.
    #[error(
        "{} names no groups (glTF: names of nodes or meshes; OBJ: statements `o` or `g`); group the surfaces by material instead",
        scene.display()
    )]
    NoGroups {
        /// The scene file.
        scene: PathBuf,
    },
    /// The output directory already holds view factors.
    #[error("{} already holds view factors; choose another directory, or allow them to be replaced", directory.display())]
    Exists {
        /// The directory.
        directory: PathBuf,
    },
    /// The scene has too many triangles.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// The factors cannot be adjusted to reciprocity and sums of 1.
    #[error("the factors cannot be adjusted to reciprocity and sums of 1")]
    Closure(#[from] ClosureError),
}

impl ViewFactorsError {
    /// Returns the kind of failure.
    #[must_use]
    pub fn kind(&self) -> ErrorKind {
        match self {
            Self::NoGroups { .. } | Self::Exists { .. } => ErrorKind::Usage,
            Self::Closure(_) | Self::Model(_) => ErrorKind::Failed,
        }
    }
}
