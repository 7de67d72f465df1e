//! Errors.

use sir_geom::SceneError;
use sir_parallel::RunError;
use sir_radiosity::ModelError;
use thiserror::Error;

/// Why a validation cannot be done. (That an answer is wrong is no error, but a verdict.)
#[derive(Debug, Error)]
pub enum ValidateError {
    /// A file of exact answers cannot be understood.
    #[error("{name} is not a file of exact answers; compare it with the one in crates/sir-validate/data")]
    File {
        /// Its name.
        name: &'static str,
        /// What is wrong, and where.
        source: serde_json::Error,
    },
    /// A part of a case has another layout than cases of its kind.
    #[error("`{what}` of case {case} has an unknown layout")]
    Layout {
        /// The case.
        case: String,
        /// `inputs` or `values`.
        what: &'static str,
        /// What is wrong.
        source: serde_json::Error,
    },
    /// A part of a case is missing.
    #[error("case {case} has no {what}")]
    Missing {
        /// The case.
        case: String,
        /// What is missing.
        what: &'static str,
    },
    /// Someone asked for a case that is not there.
    #[error("there is no case {asked}; the cases are {known}")]
    NoCase {
        /// What was asked for.
        asked: String,
        /// Names of all cases.
        known: String,
    },
    /// The surfaces of a case do not make a scene.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// They cannot be cut into patches, or not be traced.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// The light cannot be computed, or someone wanted to stop.
    #[error(transparent)]
    Run(#[from] RunError),
}

impl ValidateError {
    /// Whether someone wanted to stop.
    #[must_use]
    pub fn is_interrupt(&self) -> bool {
        matches!(self, Self::Run(RunError::Interrupted { .. }))
    }

    /// Whether what was asked for makes no sense: a case that is not there, or a file that is none of exact answers.
    #[must_use]
    pub fn is_usage(&self) -> bool {
        match self {
            Self::File { .. } | Self::Layout { .. } | Self::Missing { .. } | Self::NoCase { .. } => true,
            Self::Scene(_) | Self::Model(_) | Self::Run(_) => false,
        }
    }
}
