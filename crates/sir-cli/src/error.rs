//! Why a command fails.

use sir_parallel::ConnectError;
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
    /// The exit code of the program: 2 for wrong usage or a wrong pipeline, 130 if interrupted, else 1.
    #[must_use]
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Pipeline(error) => error.exit_code(),
            Self::Study(error) => error.exit_code(),
            Self::Validation(error) => error.exit_code(),
        }
    }
}
