//! Why a measurement fails.

use std::io;
use std::path::PathBuf;

use sir_pipeline::ErrorKind;
use thiserror::Error;

use crate::scaling::workers::Workers;

/// Why speed-ups cannot be measured.
#[derive(Debug, Error)]
pub enum ScalingError {
    /// Ranks were asked for, but the program cannot talk to them.
    #[error(
        "this program was built without MPI and runs on 1 rank only; build it with \
         `cargo build --release --features mpi`, or measure 1 rank only"
    )]
    NoMpi,
    /// The command that starts the ranks cannot be started.
    #[error(
        "cannot start `{command}` ({source}); install an MPI (Debian: `apt-get install openmpi-bin \
         libopenmpi-dev libclang-dev`), or name another program that starts the processes of a run"
    )]
    Mpirun {
        /// The program that was tried.
        command: String,
        /// What the operating system says.
        source: io::Error,
    },
    /// The program cannot start itself.
    #[error("cannot start this program again")]
    Program(#[source] io::Error),
    /// A run failed.
    #[error("the run on {workers} failed ({status}):\n{stderr}")]
    Run {
        /// Its workers.
        workers: Workers,
        /// How it ended.
        status: String,
        /// Kind of its failure.
        kind: ErrorKind,
        /// What it said.
        stderr: String,
    },
    /// A run ended well, but what it printed is no report.
    #[error(
        "the run on {workers} printed no report ({why}); does the program that starts its processes pass on \
         their standard output?"
    )]
    NoReport {
        /// Its workers.
        workers: Workers,
        /// What is wrong with what it printed.
        why: String,
    },
    /// Two runs of one pipeline have different results.
    #[error(
        "{} (repeat {}) gave another result than {} (repeat {}): {what}; a result must not depend on who \
         computes it: this is a bug of SIR, please report it with the pipeline",
        this.0, this.1, first.0, first.1
    )]
    DifferentResults {
        /// Workers and repeat of the run that differs.
        this: (Workers, usize),
        /// Those of the first run.
        first: (Workers, usize),
        /// What differs, and in which stage.
        what: String,
    },
    /// Somebody edits what is measured.
    #[error("the pipeline, its scene or the program was changed during the measurement; start it again")]
    Changed,
    /// The directory that was asked for has a measurement already.
    #[error("{} holds another scaling study; choose another directory", directory.display())]
    Exists {
        /// The directory.
        directory: PathBuf,
    },
    /// Ctrl-C or SIGTERM.
    #[error("interrupted; nothing was written")]
    Interrupted,
}

impl ScalingError {
    /// Returns the kind of failure.
    #[must_use]
    pub fn kind(&self) -> ErrorKind {
        match self {
            Self::NoMpi | Self::Exists { .. } => ErrorKind::Usage,
            Self::Interrupted => ErrorKind::Interrupted,
            Self::Run { kind, .. } => *kind,
            _ => ErrorKind::Failed,
        }
    }
}
