//! Why there are no view factors.

use std::path::PathBuf;

use sir_radiosity::{ClosureError, ModelError};
use thiserror::Error;

/// Why there are no view factors.
#[derive(Debug, Error)]
pub enum ViewFactorsError {
    /// View factors between named parts are asked for, and no part has a name.
    #[error(
        "{} names no groups (glTF: names of nodes or meshes; OBJ: statements `o` or `g`); use --by material",
        scene.display()
    )]
    NoGroups {
        /// The scene file.
        scene: PathBuf,
    },
    /// The output directory holds view factors already.
    #[error("{} holds view factors already; choose another --out, or replace them with --force", directory.display())]
    Exists {
        /// The directory.
        directory: PathBuf,
    },
    /// The scene has too many triangles.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// The factors cannot be adjusted as --closure asks.
    #[error("--closure is impossible")]
    Closure(#[from] ClosureError),
}

impl ViewFactorsError {
    /// The exit code of the program.
    #[must_use]
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::NoGroups { .. } | Self::Exists { .. } => 2,
            Self::Closure(_) | Self::Model(_) => 1,
        }
    }
}
