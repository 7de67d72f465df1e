//! Error types.

use std::io;
use std::path::PathBuf;

use sir_radiosity::SolveError;
use thiserror::Error;

/// Error of a stage that did not finish.
#[derive(Debug, Error)]
pub enum RunError {
    /// The light cannot be computed.
    #[error(transparent)]
    Solve(#[from] SolveError),
    /// The observer asked to stop.
    #[error("interrupted after {done} of {total} lines")]
    Interrupted {
        /// Number of lines done.
        done: u64,
        /// Total number of lines.
        total: u64,
    },
    /// A checkpoint cannot be saved or restored.
    #[error(transparent)]
    Checkpoint(#[from] CheckpointError),
}

/// Error while saving or restoring a checkpoint.
#[derive(Debug, Error)]
pub enum CheckpointError {
    /// The checkpoint cannot be written. An earlier one, if any, is still there.
    #[error(
        "cannot write the checkpoint {}; free disk space or use another directory{}",
        path.display(),
        if *earlier { " (an earlier checkpoint is still intact, and the run can be resumed from it)" } else { "" }
    )]
    Write {
        /// Path of the checkpoint.
        path: PathBuf,
        /// True if there is an earlier checkpoint.
        earlier: bool,
        /// Error of the operating system.
        source: io::Error,
    },
    /// The checkpoint cannot be read.
    #[error("cannot read the checkpoint {}", path.display())]
    Read {
        /// Path of the checkpoint.
        path: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },
    /// Another rank cannot save or restore the checkpoint. The error of that rank has the reason.
    #[error("rank {rank} cannot save or restore the checkpoint")]
    Elsewhere {
        /// Rank that failed.
        rank: usize,
    },
    /// The file is no valid checkpoint of this program, or does not belong to the stage.
    #[error("cannot resume from {}: {why}", path.display())]
    Unfit {
        /// Path of the checkpoint.
        path: PathBuf,
        /// Reason.
        why: String,
    },
}
