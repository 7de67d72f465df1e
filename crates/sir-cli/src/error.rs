//! Why a command fails.

use std::io;
use std::path::PathBuf;

use thiserror::Error;

use crate::diagnostic::Diagnostics;

/// Why a command fails. Every message ends with what to do, where that is not obvious.
#[derive(Debug, Error)]
pub enum Error {
    /// The pipeline file has problems.
    #[error(transparent)]
    Pipeline(#[from] Diagnostics),
    /// The pipeline file cannot be read.
    #[error("cannot read the pipeline {}: {source}", path.display())]
    ReadPipeline {
        /// The file.
        path: PathBuf,
        /// What the operating system says.
        source: io::Error,
    },
}
