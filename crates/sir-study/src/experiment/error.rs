//! Why an experiment fails.

use std::path::PathBuf;

use sir_pipeline::ErrorKind;
use thiserror::Error;

/// Why the experiment cannot be done.
#[derive(Debug, Error)]
pub enum ExperimentError {
    /// No pipelines were named, and the usual ones are not there.
    #[error(
        "there is no {}; start the experiment in the folder of the project, which has the scenes, or name other pipelines",
        path.display()
    )]
    NoScenes {
        /// Where one of them should be.
        path: PathBuf,
    },
    /// There is nothing to measure.
    #[error(
        "{} has no `Multipath` stage, which the experiment is about; add for instance `Multipath(lines: \
         1_000_000)` after `FirstShot`", path.display()
    )]
    NoMultipath {
        /// The pipeline.
        path: PathBuf,
    },
    /// Two pipelines would write to the same place.
    #[error("two of the pipelines are called {name}; rename the file or the folder of one")]
    SameName {
        /// Their name.
        name: String,
    },
    /// The scene file cannot be read.
    #[error("cannot read the scene {}", path.display())]
    Scene {
        /// The file.
        path: PathBuf,
        /// What the operating system says.
        source: std::io::Error,
    },
    /// A picture of the report cannot be written.
    #[error("cannot write the picture {}", path.display())]
    Picture {
        /// The file.
        path: PathBuf,
        /// Why not.
        source: std::io::Error,
    },
    /// Ctrl-C or SIGTERM.
    #[error("interrupted; start the same experiment with the directory {} to continue", directory.display())]
    Interrupted {
        /// Where the finished runs are.
        directory: PathBuf,
    },
}

impl ExperimentError {
    /// Returns the kind of failure.
    #[must_use]
    pub fn kind(&self) -> ErrorKind {
        match self {
            Self::NoScenes { .. } | Self::NoMultipath { .. } | Self::SameName { .. } => ErrorKind::Usage,
            Self::Scene { .. } | Self::Picture { .. } => ErrorKind::Failed,
            Self::Interrupted { .. } => ErrorKind::Interrupted,
        }
    }
}
