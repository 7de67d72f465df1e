//! The error type of the commands.

use sir_parallel::ConnectError;
use sir_pipeline::ErrorKind;
use sir_pipeline::view_factors::ViewFactorsError;
use sir_study::StudyError;
use thiserror::Error;

use crate::validate::error::ValidationError;

/// Failure of a command. Every message ends with what to do, unless that is obvious.
#[derive(Debug, Error)]
pub enum CliError {
    /// Invalid pipeline, or failed run.
    #[error(transparent)]
    Pipeline(#[from] sir_pipeline::Error),
    /// Failed study.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// Wrong answers, or answers that cannot be checked.
    #[error(transparent)]
    Validation(#[from] ValidationError),
    /// Several ranks were started for a command that drafts a pipeline.
    #[error(
        "`sir light` runs in one process; write the pipeline with `sir light SCENE --dry-run`, and start `sir run` on several ranks"
    )]
    LightOnRanks,
    /// The page of a run cannot be served.
    #[error("the page cannot be served on this computer; run it without --watch")]
    Watch(#[source] std::io::Error),
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
            Self::LightOnRanks => ErrorKind::Usage,
            Self::Watch(_) => ErrorKind::Failed,
        }
    }
}
