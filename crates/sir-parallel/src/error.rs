//! Errors.

use std::io;
use std::path::PathBuf;

use sir_radiosity::SolveError;
use thiserror::Error;

/// Why a stage did not finish.
#[derive(Debug, Error)]
pub enum RunError {
    /// The light cannot be computed.
    #[error(transparent)]
    Solve(#[from] SolveError),
    /// The observer asked to stop.
    #[error("interrupted after {done} of {total} lines")]
    Interrupted {
        /// Lines done.
        done: u64,
        /// Lines asked for.
        total: u64,
    },
    /// A checkpoint could not be saved or restored.
    #[error(transparent)]
    Checkpoint(#[from] CheckpointError),
}

/// Why a checkpoint cannot be saved or restored.
#[derive(Debug, Error)]
pub enum CheckpointError {
    /// It cannot be written. The one before it is still there.
    #[error("cannot write the checkpoint {}; make room for it, or take another directory (an earlier checkpoint is still whole, and the run can be resumed from it)", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// What the operating system says.
        source: io::Error,
    },
    /// It cannot be read.
    #[error("cannot read the checkpoint {}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the operating system says.
        source: io::Error,
    },
    /// Another rank could not save or restore it; it says why.
    #[error("rank {rank} cannot save or restore the checkpoint")]
    Elsewhere {
        /// The rank.
        rank: usize,
    },
    /// It is not what this program wrote.
    #[error("{} is not a checkpoint that can be resumed: {why}", path.display())]
    Unfit {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        why: String,
    },
}
