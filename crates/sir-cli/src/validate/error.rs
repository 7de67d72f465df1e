//! Why a validation fails.

use std::io;
use std::path::PathBuf;

use sir_pipeline::ErrorKind;
use sir_validate::ValidateError;
use thiserror::Error;

/// Why a validation fails.
#[derive(Debug, Error)]
pub enum ValidationError {
    /// The cases cannot be run, or someone wanted to stop.
    #[error(transparent)]
    Cases(ValidateError),
    /// A file of exact answers cannot be read.
    #[error("cannot read {}; --reference needs a folder with {}", path.display(), sir_validate::FILES.join(", "))]
    ReadReference {
        /// The file.
        path: PathBuf,
        /// What the operating system says.
        source: io::Error,
    },
    /// Some answers are wrong, or too noisy to tell.
    #[error(
        "{summary} Try another --seed: chance does not fail twice. If an answer stays wrong, please report it with the table"
    )]
    Failed {
        /// How many answers passed, in a sentence.
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
