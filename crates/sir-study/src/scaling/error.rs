//! The error type of a measurement of speed-ups.

use std::io;
use std::path::PathBuf;

use sir_pipeline::ErrorKind;
use thiserror::Error;

use crate::scaling::workers::Workers;

/// Failure of a measurement of speed-ups.
#[derive(Debug, Error)]
pub enum ScalingError {
    /// Several ranks were requested, but the program was built without MPI.
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
        /// Program that was tried.
        command: String,
        /// Error of the operating system.
        source: io::Error,
    },
    /// The program cannot start itself.
    #[error("cannot start this program again")]
    Program(#[source] io::Error),
    /// A run failed.
    #[error("the run on {workers} failed ({status}):\n{stderr}")]
    Run {
        /// Workers of the run.
        workers: Workers,
        /// Exit status of the run.
        status: String,
        /// Kind of failure.
        kind: ErrorKind,
        /// Text that the run printed on standard error.
        stderr: String,
    },
    /// A run succeeded, but its output is not a report.
    #[error(
        "the run on {workers} printed no report ({why}); check that the program that starts its processes passes \
         on their standard output"
    )]
    NoReport {
        /// Workers of the run.
        workers: Workers,
        /// Reason why the output is not a report.
        why: String,
    },
    /// Two runs of the same pipeline have different results.
    #[error(
        "{} (repeat {}) gave a different result from {} (repeat {}): {what}; results must not depend on the \
         workers: this is a bug of SIR, please report it with the pipeline",
        this.0, this.1, first.0, first.1
    )]
    DifferentResults {
        /// Workers and repeat of the run that differs.
        this: (Workers, usize),
        /// Workers and repeat of the first run.
        first: (Workers, usize),
        /// Difference, and the stage that has it.
        what: String,
    },
    /// The input was edited during the measurement.
    #[error("the pipeline, its scene or the program was changed during the measurement; start it again")]
    Changed,
    /// The requested directory already holds a measurement.
    #[error("{} holds another scaling study; choose another directory", directory.display())]
    Exists {
        /// The directory.
        directory: PathBuf,
    },
    /// Interrupted by Ctrl-C or SIGTERM.
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
