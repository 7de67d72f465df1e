//! Why a study fails.

use sir_view::ViewError;
use thiserror::Error;

use crate::experiment::error::ExperimentError;
use crate::scaling::error::ScalingError;

/// Why a study fails.
#[derive(Debug, Error)]
pub enum StudyError {
    /// A pipeline is wrong, or its scene cannot be read.
    #[error(transparent)]
    Pipeline(#[from] sir_pipeline::Error),
    /// A result cannot be read, compared or written.
    #[error(transparent)]
    View(#[from] ViewError),
    /// Speed-ups cannot be measured.
    #[error(transparent)]
    Scaling(#[from] ScalingError),
    /// The experiment cannot be done.
    #[error(transparent)]
    Experiment(#[from] ExperimentError),
}

impl StudyError {
    /// The exit code of the program.
    #[must_use]
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Pipeline(error) => error.exit_code(),
            Self::View(_) => 1,
            Self::Scaling(error) => error.exit_code(),
            Self::Experiment(error) => error.exit_code(),
        }
    }
}
