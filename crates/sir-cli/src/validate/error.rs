//! The error type of `sir validate`.

use std::io;
use std::path::PathBuf;

use sir_pipeline::ErrorKind;
use sir_validate::ValidateError;
use thiserror::Error;

/// Failure of a validation.
#[derive(Debug, Error)]
pub enum ValidationError {
    /// The cases cannot be run, or the validation was interrupted.
    #[error(transparent)]
    Cases(ValidateError),
    /// A file of exact answers cannot be read.
    #[error("cannot read {}; --reference needs a folder with {}", path.display(), sir_validate::FILES.join(", "))]
    ReadReference {
        /// The file.
        path: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },
    /// Some answers are wrong, or too noisy to tell.
    #[error(
        "{summary} Try another --seed: a failure by chance is unlikely to recur. If an answer stays wrong, please report it with the table"
    )]
    Failed {
        /// Number of answers that passed, in a sentence.
        summary: String,
    },
}

impl ValidationError {
    /// Returns the kind of failure.
    #[must_use]
    pub fn kind(&self) -> ErrorKind {
        match self {
            Self::Cases(error) if error.is_interrupt() => ErrorKind::Interrupted,
            Self::Cases(error) if error.is_usage() => ErrorKind::Usage,
            Self::ReadReference { .. } => ErrorKind::Usage,
            Self::Cases(_) | Self::Failed { .. } => ErrorKind::Failed,
        }
    }
}
