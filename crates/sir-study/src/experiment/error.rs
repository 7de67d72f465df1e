//! The error type of the experiment.

use std::path::PathBuf;

use sir_pipeline::ErrorKind;
use thiserror::Error;

/// Failure of the experiment.
#[derive(Debug, Error)]
pub enum ExperimentError {
    /// No pipelines were given, and a default one does not exist.
    #[error(
        "there is no {}; start the experiment in the project folder, which has the scenes, or name other pipelines",
        path.display()
    )]
    NoScenes {
        /// Path of the missing pipeline.
        path: PathBuf,
    },
    /// The pipeline has no `Multipath` stage, so there is nothing to measure.
    #[error(
        "{} has no `Multipath` stage, which the experiment is about; add for instance `Multipath(lines: \
         1_000_000)` after `FirstShot`", path.display()
    )]
    NoMultipath {
        /// The pipeline.
        path: PathBuf,
    },
    /// Two pipelines have the same name and would write to the same directory.
    #[error("two of the pipelines are called {name}; rename the file or the folder of one")]
    SameName {
        /// Name of both pipelines.
        name: String,
    },
    /// A picture of the report cannot be written.
    #[error("cannot write the picture {}", path.display())]
    Picture {
        /// The file.
        path: PathBuf,
        /// Error of drawing or of the operating system.
        source: std::io::Error,
    },
    /// Interrupted by Ctrl-C or SIGTERM.
    #[error("interrupted; start the same experiment with the directory {} to continue", directory.display())]
    Interrupted {
        /// Output directory with the finished runs.
        directory: PathBuf,
    },
}

impl ExperimentError {
    /// Returns the kind of failure.
    #[must_use]
    pub fn kind(&self) -> ErrorKind {
        match self {
            Self::NoScenes { .. } | Self::NoMultipath { .. } | Self::SameName { .. } => ErrorKind::Usage,
            Self::Picture { .. } => ErrorKind::Failed,
            Self::Interrupted { .. } => ErrorKind::Interrupted,
        }
    }
}
