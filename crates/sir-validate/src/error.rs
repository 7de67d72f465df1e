//! Errors of a validation.

use sir_geom::SceneError;
use sir_parallel::RunError;
use sir_photometry::PhotometryError;
use sir_radiosity::ModelError;
use thiserror::Error;

/// Error of a validation. (A wrong answer is not an error, but a verdict.)
#[derive(Debug, Error)]
pub enum ValidateError {
    /// A file of exact answers cannot be parsed.
    #[error("{name} is not a file of exact answers; compare it with the one in crates/sir-validate/data")]
    File {
        /// Name of the file.
        name: &'static str,
        /// Problem and its position.
        source: serde_json::Error,
    },
    /// A part of a case does not have the layout of cases of its kind.
    #[error("`{what}` of case {case} has an unknown layout")]
    Layout {
        /// ID of the case.
        case: String,
        /// `inputs` or `values`.
        what: &'static str,
        /// Problem.
        source: serde_json::Error,
    },
    /// A part of a case is missing.
    #[error("case {case} has no {what}")]
    Missing {
        /// ID of the case.
        case: String,
        /// Missing part.
        what: &'static str,
    },
    /// A selected case does not exist.
    #[error("there is no case {asked}; the cases are {known}")]
    NoCase {
        /// Selected ID.
        asked: String,
        /// IDs of all cases.
        known: String,
    },
    /// The surfaces of a case do not make a scene.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The surfaces cannot be cut into patches, or not be traced.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// The photometric file of a lamp cannot be read.
    #[error(transparent)]
    Photometry(#[from] PhotometryError),
    /// The solver failed or was interrupted.
    #[error(transparent)]
    Run(#[from] RunError),
}

impl ValidateError {
    /// Returns true if the run was interrupted.
    #[must_use]
    pub fn is_interrupt(&self) -> bool {
        matches!(self, Self::Run(RunError::Interrupted { .. }))
    }

    /// Returns true if the request was invalid: an unknown case, or a file that is not one of exact answers.
    #[must_use]
    pub fn is_usage(&self) -> bool {
        match self {
            Self::File { .. } | Self::Layout { .. } | Self::Missing { .. } | Self::NoCase { .. } => true,
            Self::Scene(_) | Self::Model(_) | Self::Photometry(_) | Self::Run(_) => false,
        }
    }
}
