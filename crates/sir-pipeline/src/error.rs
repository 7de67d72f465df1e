//! Errors of this crate.

use std::io;
use std::path::{Path, PathBuf};

use sir_geom::LoadError;
use sir_lightmap::LightmapError;
use sir_parallel::{ConnectError, RunError};
use sir_radiosity::{ModelError, SolveError};
use sir_view::ViewError;
use thiserror::Error;

use crate::error_kind::ErrorKind;
use crate::text::diagnostic::Diagnostics;
use crate::view_factors::error::ViewFactorsError;

/// Error of a run. Every message ends with what to do, unless that is obvious.
#[derive(Debug, Error)]
pub enum Error {
    /// The pipeline file has problems.
    #[error(transparent)]
    Pipeline(#[from] Diagnostics),
    /// The scene cannot be divided into patches, or its acceleration structure cannot be built.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// The pipeline file cannot be read.
    #[error("cannot read the pipeline {}", path.display())]
    ReadPipeline {
        /// The file.
        path: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },
    /// The pipeline file is not text.
    #[error("{} is not a text file in UTF-8 or UTF-16; a pipeline is a text file in RON, best saved as UTF-8", path.display())]
    NotText {
        /// The file.
        path: PathBuf,
    },
    /// The pipeline file is too long.
    #[error("{} has more than {most} bytes; a pipeline is a short text file", path.display())]
    LongPipeline {
        /// The file.
        path: PathBuf,
        /// Largest accepted size \[bytes\].
        most: u64,
    },
    /// A pipeline was given in place of a scene.
    #[error("{} is a pipeline, not a scene", path.display())]
    IsPipeline {
        /// The file.
        path: PathBuf,
    },
    /// A run directory has a pipeline that differs from the drafted one.
    #[error("{} exists, and differs from the pipeline for this scene and these options", path.display())]
    OtherPipeline {
        /// The file.
        path: PathBuf,
    },
    /// The run does not fit the memory of this machine.
    #[error(
        "the run needs {needed} of memory in addition to its scene, but only {available} are available (of the machine, or \
         within the limits of a container, batch job or `ulimit`); make fewer patches or smaller pictures, end other \
         programs, raise the limit, or use a machine with more memory"
    )]
    Memory {
        /// Memory needed in addition to the scene, as `sir check` counts it.
        needed: String,
        /// Memory that the operating system can provide.
        available: String,
    },
    /// The requested run directory already holds a result.
    #[error("{} already holds a result; choose another run directory, or allow it to be replaced", directory.display())]
    Exists {
        /// The directory.
        directory: PathBuf,
    },
    /// An output would replace a file that no run has written.
    #[error("{} exists, and no run has written it; choose another run directory, or allow it to be replaced", path.display())]
    OutputExists {
        /// The file.
        path: PathBuf,
    },
    /// An output would replace an input.
    #[error("the output {} would replace a file that the pipeline reads; choose another run directory or file name", path.display())]
    OutputIsInput {
        /// The file.
        path: PathBuf,
    },
    /// The requested run directory holds an interrupted run.
    #[error(
        "{} holds an interrupted run; resume it, choose another run directory, or allow it to be replaced",
        directory.display()
    )]
    ExistsInterrupted {
        /// The directory.
        directory: PathBuf,
    },
    /// Another run uses the directory.
    #[error("{} is in use by another run; wait until that run ends, or choose another directory", directory.display())]
    InUse {
        /// The directory.
        directory: PathBuf,
    },
    /// The run directory exists, but no file can be written to it.
    #[error("cannot write to the directory {}; allow it, or choose another directory", path.display())]
    NotWritable {
        /// The directory.
        path: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },
    /// The run directory cannot be created.
    #[error("cannot create the directory {}; choose another", path.display())]
    Directory {
        /// The directory.
        path: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },
    /// The scene cannot be read.
    #[error(transparent)]
    Load(#[from] LoadError),
    /// The light cannot be computed.
    #[error(transparent)]
    Run(#[from] RunError),
    /// The run was interrupted, and can be resumed.
    #[error("interrupted after {done} of {total} lines; resume the run in {} to continue", directory.display())]
    Interrupted {
        /// Lines traced in this stage.
        done: u64,
        /// All lines of the stage.
        total: u64,
        /// The run directory.
        directory: PathBuf,
    },
    /// The run was interrupted while it wrote its files, and can be resumed.
    #[error("interrupted while writing files; resume the run in {} to continue from its last checkpoint", directory.display())]
    InterruptedSaving {
        /// The run directory.
        directory: PathBuf,
    },
    /// The run was interrupted while it measured at sensors, and can be resumed.
    #[error("interrupted while measuring at sensors; resume the run in {} to continue from its last checkpoint", directory.display())]
    InterruptedMeasuring {
        /// The run directory.
        directory: PathBuf,
    },
    /// A file of a run cannot be written, for example because the disk is full.
    #[error(
        "the run in {} is not complete; free some space or fix the problem below, then resume the run from its last checkpoint",
        directory.display()
    )]
    NotWritten {
        /// The run directory.
        directory: PathBuf,
        /// The file, and the error of the operating system.
        source: ViewError,
    },
    /// A run cannot be resumed.
    #[error("the run in {} cannot be resumed: {why}", directory.display())]
    CannotResume {
        /// The run directory.
        directory: PathBuf,
        /// The reason, and what to do.
        why: String,
    },
    /// The ranks of a run cannot communicate.
    #[error(transparent)]
    Connect(#[from] ConnectError),
    /// Another rank has failed, and reports the reason.
    #[error("rank {rank} failed")]
    Elsewhere {
        /// The rank.
        rank: usize,
        /// Kind of its error.
        kind: ErrorKind,
    },
    /// A rank has read other input than rank 0.
    #[error(
        "rank {rank} has read another pipeline or scene than rank 0, or runs another version of the program; give all machines \
         the same files and program"
    )]
    OtherInput {
        /// The rank.
        rank: usize,
    },
    /// A result cannot be written, read or compared.
    #[error(transparent)]
    View(#[from] ViewError),
    /// A lightmap cannot be made.
    #[error(transparent)]
    Lightmap(Box<LightmapError>),
    /// The light of a run is not divided into light groups.
    #[error(
        "the run in {} has no light groups; give lights of its pipeline a `group`, and run it again",
        directory.display()
    )]
    NoLightGroups {
        /// The directory.
        directory: PathBuf,
    },
    /// A result was mixed from that of a run, and has no light groups of its own.
    #[error("the result in {} was mixed from that in {run}; mix that one", directory.display())]
    MixOfMix {
        /// The directory.
        directory: PathBuf,
        /// Directory of the run.
        run: String,
    },
    /// The files of a mix would replace those of its run.
    #[error("{} is the directory of the run itself; choose another directory", directory.display())]
    MixOfItself {
        /// The directory.
        directory: PathBuf,
    },
    /// The work on a mix was interrupted.
    #[error("interrupted while writing files to {}; mix the result again", directory.display())]
    InterruptedMix {
        /// The directory of the files.
        directory: PathBuf,
    },
    /// The factor of a light group is impossible.
    #[error("light group `{name}`: {why}")]
    Factor {
        /// Name of the group.
        name: String,
        /// The reason, and what to do.
        why: String,
    },
    /// Another program has computed the light of a run.
    #[error(
        "{program} has computed the light in {}, but this is {this}; use that version, or run the pipeline again",
        directory.display()
    )]
    OtherProgram {
        /// The directory.
        directory: PathBuf,
        /// Name and version of the program.
        program: String,
        /// Name and version of this program.
        this: &'static str,
    },
    /// The file of a light group cannot be used.
    #[error("the light group in {} cannot be used: {why}; run its pipeline again", path.display())]
    GroupFile {
        /// The file.
        path: PathBuf,
        /// The reason.
        why: String,
    },
    /// A directory to be compared holds no result.
    #[error("{} is not a run directory: it has no readable result.json ({why})", directory.display())]
    NoResult {
        /// The directory.
        directory: PathBuf,
        /// The reason.
        why: String,
    },
    /// A run to be compared has no table.
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

impl From<LightmapError> for Error {
    fn from(error: LightmapError) -> Self {
        Self::Lightmap(Box::new(error))
    }
}

impl Error {
    /// Returns a function that wraps the error of creating a directory.
    pub fn directory(path: &Path) -> impl FnOnce(io::Error) -> Self {
        move |source| Self::Directory { path: path.to_owned(), source }
    }

    /// Returns a function that wraps the error of writing to a directory.
    pub(crate) fn not_writable(path: &Path) -> impl FnOnce(io::Error) -> Self {
        move |source| Self::NotWritable { path: path.to_owned(), source }
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
            | Self::IsPipeline { .. }
            | Self::OtherPipeline { .. }
            | Self::ExistsInterrupted { .. }
            | Self::OutputExists { .. }
            | Self::OutputIsInput { .. }
            | Self::InUse { .. }
            | Self::CannotResume { .. }
            | Self::NoLightGroups { .. }
            | Self::MixOfMix { .. }
            | Self::MixOfItself { .. }
            | Self::Factor { .. } => ErrorKind::Usage,
            Self::Interrupted { .. }
            | Self::InterruptedSaving { .. }
            | Self::InterruptedMeasuring { .. }
            | Self::InterruptedMix { .. }
            | Self::Run(RunError::Interrupted { .. }) => ErrorKind::Interrupted,
            Self::Elsewhere { kind, .. } => *kind,
            Self::ViewFactors(error) => error.kind(),
            _ => ErrorKind::Failed,
        }
    }

    /// Returns the message, followed by those of its causes that add something.
    #[must_use]
    pub fn chain(&self) -> String {
        chain(self)
    }
}

/// Returns the message of an error, followed by those of its causes that it does not already contain. Replaces control
/// characters.
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
    // File names and file contents may hold terminal escape sequences.
    text.replace(|c: char| c.is_control() && c != '\n', "\u{fffd}")
}
