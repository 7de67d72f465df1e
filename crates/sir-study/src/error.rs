//! The error type of the studies.

use sir_pipeline::ErrorKind;
use sir_view::ViewError;
use thiserror::Error;

use crate::experiment::error::ExperimentError;
use crate::scaling::error::ScalingError;

/// Failure of a study.
#[derive(Debug, Error)]
pub enum StudyError {
    /// A pipeline is invalid, or its scene cannot be read.
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
    /// Returns the kind of failure.
    #[must_use]
    pub fn kind(&self) -> ErrorKind {
        match self {
            Self::Pipeline(error) => error.kind(),
            Self::View(_) => ErrorKind::Failed,
            Self::Scaling(error) => error.kind(),
            Self::Experiment(error) => error.kind(),
        }
    }
}
