//! Why a command fails.

use sir_parallel::ConnectError;
use sir_pipeline::ErrorKind;
use sir_pipeline::view_factors::ViewFactorsError;
use sir_study::StudyError;
use thiserror::Error;

use crate::validate::error::ValidationError;

/// Why a command fails. Every message ends with what to do, where that is not obvious.
#[derive(Debug, Error)]
pub enum CliError {
    /// A pipeline is wrong, or its run failed.
    #[error(transparent)]
    Pipeline(#[from] sir_pipeline::Error),
    /// A study failed.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// Answers are wrong, or cannot be checked.
    #[error(transparent)]
    Validation(#[from] ValidationError),
}

impl From<ConnectError> for CliError {
    fn from(error: ConnectError) -> Self {
        Self::Pipeline(error.into())
    }
}

impl From<ViewFactorsError> for CliError {
    fn from(error: ViewFactorsError) -> Self {
        Self::Pipeline(error.into())
    }
}

impl CliError {
    /// Returns the kind of failure.
    #[must_use]
    pub fn kind(&self) -> ErrorKind {
        match self {
            Self::Pipeline(error) => error.kind(),
            Self::Study(error) => error.kind(),
            Self::Validation(error) => error.kind(),
        }
    }
}
