//! Why a run fails.

use std::io;
use std::path::{Path, PathBuf};

use sir_geom::LoadError;
use sir_parallel::{ConnectError, RunError};
use sir_radiosity::{ModelError, SolveError};
use sir_view::ViewError;
use thiserror::Error;

use crate::error_kind::ErrorKind;
use crate::text::diagnostic::Diagnostics;
use crate::view_factors::error::ViewFactorsError;

/// Why a run fails. Every message ends with what to do, where that is not obvious.
#[derive(Debug, Error)]
pub enum Error {
    /// The pipeline file has problems.
    #[error(transparent)]
    Pipeline(#[from] Diagnostics),
    /// The scene cannot be cut into patches, or not be traced.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// The pipeline file cannot be read.
    #[error("cannot read the pipeline {}", path.display())]
    ReadPipeline {
        /// The file.
        path: PathBuf,
        /// What the operating system says.
        source: io::Error,
    },
    /// What was given as a pipeline file is no text.
    #[error("{} is not a text file, but a pipeline is one", path.display())]
    NotText {
        /// The file.
        path: PathBuf,
    },
    /// What was given as a pipeline file is too long for one.
    #[error("{} has more than {most} bytes, but a pipeline is a short text", path.display())]
    LongPipeline {
        /// The file.
        path: PathBuf,
        /// The most bytes that are read.
        most: u64,
    },
    /// The run does not fit the memory of this machine.
    #[error(
        "the run needs {needed} of memory beside its scene, but {available} are available; make fewer patches or smaller pictures, \
         end other programs, or take a machine with more memory"
    )]
    Memory {
        /// What it needs beside the scene, as `sir check` counts it.
        needed: String,
        /// What the operating system can give.
        available: String,
    },
    /// The run directory that was asked for holds a result already.
    #[error("{} holds a result already; choose another run directory, or allow it to be replaced", directory.display())]
    Exists {
        /// The directory.
        directory: PathBuf,
    },
    /// The run directory that was asked for holds an interrupted run.
    #[error(
        "{} holds an interrupted run; resume it, choose another run directory, or allow it to be replaced",
        directory.display()
    )]
    ExistsInterrupted {
        /// The directory.
        directory: PathBuf,
    },
    /// The run directory cannot be made.
    #[error("cannot make the directory {}; choose another", path.display())]
    Directory {
        /// The directory.
        path: PathBuf,
        /// What the operating system says.
        source: io::Error,
    },
    /// The scene cannot be read.
    #[error(transparent)]
    Load(#[from] LoadError),
    /// The light cannot be computed.
    #[error(transparent)]
    Run(#[from] RunError),
    /// The run was stopped, and can go on.
    #[error("interrupted after {done} of {total} lines; resume the run in {} to continue", directory.display())]
    Interrupted {
        /// Lines done in this stage.
        done: u64,
        /// Lines of the stage.
        total: u64,
        /// The run directory.
        directory: PathBuf,
    },
    /// The run was stopped while it wrote its files, and can go on.
    #[error("interrupted while files were written; resume the run in {} to continue from its last checkpoint", directory.display())]
    InterruptedSaving {
        /// The run directory.
        directory: PathBuf,
    },
    /// The run was stopped while it measured at sensors, and can go on.
    #[error("interrupted at the sensors; resume the run in {} to continue from its last checkpoint", directory.display())]
    InterruptedMeasuring {
        /// The run directory.
        directory: PathBuf,
    },
    /// A file of a run cannot be written, for want of space on a disk, for instance.
    #[error(
        "the run in {} is not complete; free some space or fix the problem below, then resume the run from its last checkpoint",
        directory.display()
    )]
    NotWritten {
        /// The run directory.
        directory: PathBuf,
        /// The file, and what the operating system says.
        source: ViewError,
    },
    /// A run cannot go on.
    #[error("the run in {} cannot be resumed: {why}", directory.display())]
    CannotResume {
        /// The run directory.
        directory: PathBuf,
        /// Why not, and what to do.
        why: String,
    },
    /// The processes of a run cannot work together.
    #[error(transparent)]
    Connect(#[from] ConnectError),
    /// Another rank has failed, and says why.
    #[error("rank {rank} failed")]
    Elsewhere {
        /// The rank.
        rank: usize,
        /// Kind of its error.
        kind: ErrorKind,
    },
    /// A rank has read something else than the first one.
    #[error(
        "rank {rank} has read another pipeline or scene than rank 0, or is another version of the program; all machines \
         must see the same files"
    )]
    OtherInput {
        /// The rank.
        rank: usize,
    },
    /// A result cannot be written, read or compared.
    #[error(transparent)]
    View(#[from] ViewError),
    /// A directory that was to be compared holds no result.
    #[error("{} is not a run directory: it has no readable result.json ({why})", directory.display())]
    NoResult {
        /// The directory.
        directory: PathBuf,
        /// What is wrong with it.
        why: String,
    },
    /// A run that was to be compared has no table.
    #[error("the run in {} wrote no table; add `Table(path: \"patches.csv\")` to its `Save` and run it again", directory.display())]
    NoTable {
        /// The directory.
        directory: PathBuf,
    },
    /// View factors cannot be computed.
    #[error(transparent)]
    ViewFactors(#[from] ViewFactorsError),
}

impl From<SolveError> for Error {
    fn from(error: SolveError) -> Self {
        Self::Run(error.into())
    }
}

impl Error {
    /// Says that a directory cannot be made.
    pub fn directory(path: &Path) -> impl FnOnce(io::Error) -> Self {
        move |source| Self::Directory { path: path.to_owned(), source }
    }

    /// Returns the kind of failure.
    #[must_use]
    pub fn kind(&self) -> ErrorKind {
        match self {
            Self::Pipeline(_)
            | Self::ReadPipeline { .. }
            | Self::NotText { .. }
            | Self::LongPipeline { .. }
            | Self::Exists { .. }
            | Self::ExistsInterrupted { .. }
            | Self::CannotResume { .. } => ErrorKind::Usage,
            Self::Interrupted { .. }
            | Self::InterruptedSaving { .. }
            | Self::InterruptedMeasuring { .. }
            | Self::Run(RunError::Interrupted { .. }) => ErrorKind::Interrupted,
            Self::Elsewhere { kind, .. } => *kind,
            Self::ViewFactors(error) => error.kind(),
            _ => ErrorKind::Failed,
        }
    }

    /// The message, followed by its causes as far as they say something new.
    #[must_use]
    pub fn chain(&self) -> String {
        chain(self)
    }
}

/// The message of an error, followed by those of its causes as far as they say something new.
#[must_use]
pub fn chain(error: &dyn std::error::Error) -> String {
    let mut text = error.to_string();
    let mut cause = error.source();
    while let Some(error) = cause {
        let more = error.to_string();
        if !text.contains(&more) {
            text = format!("{text}: {more}");
        }
        cause = error.source();
    }
    // Names of files and of what is in them may play tricks on a terminal.
    text.replace(|c: char| c.is_control() && c != '\n', "\u{fffd}")
}
