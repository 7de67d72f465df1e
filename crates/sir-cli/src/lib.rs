//! The command-line program `sir`: arguments, progress bars, signals, printed texts and exit codes. The crates below do
//! the work: [`sir_pipeline`] runs pipelines, [`sir_study`] makes studies, and [`sir_validate`] compares with known
//! answers.
//!
//! Results go to files and standard output, everything else to standard error (`output`). [`main`] is the whole program;
//! [`main_from`] is the same with given arguments (`examples/own_command.rs`). The functions that format the printed
//! texts are public, so that other programs can use them.
//!
//! # Example
//!
//! ```no_run
//! fn main() -> std::process::ExitCode {
//!     sir_cli::main()
//! }
//! ```

#![warn(clippy::print_stderr)]

pub mod args;
pub mod compare;
mod error;
mod exit;
pub mod experiment;
pub mod how;
pub mod info;
mod interrupt;
pub mod light;
mod numbers;
mod output;
pub mod progress;
pub mod scaling;
pub mod summary;
pub mod validate;
mod viewfactors;
mod watch;

use std::ffi::OsString;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use clap::{CommandFactory as _, Parser as _};
use sir_parallel::{Communicator, SingleProcess, connect};
use sir_pipeline::check::estimate;
use sir_pipeline::plan::{Pipeline, schema};
use sir_pipeline::run::{resume_together, run_together};
use sir_pipeline::{ErrorKind, MixOptions, RunOptions, RunResult, mix, report};

use args::{Args, Command, MixArgs, RunArgs};
pub use error::CliError;
use how::HowArgs;
use progress::Stderr;

/// Runs the program on the arguments of the process.
#[must_use]
pub fn main() -> ExitCode {
    main_from(std::env::args_os())
}

/// Runs the program on the given arguments; the first one is the program's name.
///
/// The commands `scaling` and `experiment` start the current executable again with other arguments. They need an
/// executable that passes its arguments on to [`main`].
#[must_use]
pub fn main_from(args: impl IntoIterator<Item = impl Into<OsString> + Clone>) -> ExitCode {
    let args = match Args::try_parse_from(args) {
        Ok(args) => args,
        Err(error) => {
            let printed = error.print();
            // The parser returns help and version as errors, too.
            return if error.use_stderr() {
                exit::code(ErrorKind::Usage)
            } else {
                output::exit_code(printed)
            };
        }
    };
    match execute(args.command) {
        Ok(text) => output::print_text(&text),
        Err(code) => code,
    }
}

/// Executes a command and returns its text for standard output. If it fails, prints the error and returns the exit
/// code.
fn execute(command: Command) -> Result<String, ExitCode> {
    match command {
        Command::Light(_)
        | Command::Run(_)
        | Command::Resume { .. }
        | Command::Mix(_)
        | Command::ViewFactors(_) => {
            // Before anything that takes time: the handlers must be installed when a signal arrives.
            let stop = interrupt::flag();
            let comm = connect().map_err(|error| show(&error.into()))?;
            work(command, &*comm, stop).map_err(|error| show(&error))
        }
        other => work(other, &SingleProcess, Arc::default()).map_err(|error| show(&error)),
    }
}

/// Prints an error to standard error and returns its exit code.
fn show(error: &CliError) -> ExitCode {
    let message = exit::message(error);
    if !message.is_empty() {
        output::print_note(message.trim_end_matches('\n'));
    }
    exit::code(error.kind())
}

/// Executes a command together with the other ranks, until it is done or `stop` becomes true.
fn work(command: Command, comm: &dyn Communicator, stop: Arc<AtomicBool>) -> Result<String, CliError> {
    match command {
        Command::Light(args) => light::command(&args, comm, stop),
        Command::Run(RunArgs { pipeline, out, seed, force, how }) => {
            let options = RunOptions { out, seed, force, ..how.options(stop, comm)? };
            run_together(Pipeline::read(&pipeline), &options, comm)
                .map(|result| result_text(&result, &how, comm))
                .map_err(CliError::from)
        }
        Command::Resume { directory, how } => resume_together(&directory, &how.options(stop, comm)?, comm)
            .map(|result| result_text(&result, &how, comm))
            .map_err(CliError::from),
        // The work of one rank.
        Command::Mix(_) if !comm.is_first() => Ok(String::new()),
        Command::Mix(MixArgs { directory, set, out, force, threads, quiet, json }) => {
            let progress = Arc::new(Stderr::unless(quiet));
            let options = MixOptions { factors: set, out, force, threads, stop, progress };
            let result = mix(&directory, &options)?;
            Ok(if json { result.report.to_json() } else { summary::summary(&result) })
        }
        Command::Check { pipeline } => {
            let pipeline = Pipeline::read(&pipeline)?;
            Ok(estimate(&pipeline, &Stderr::Quiet)?.to_string())
        }
        Command::Info(args) => info::command(&args),
        Command::Compare { a, b, json } => {
            let comparison = report::compare(&a, &b)?;
            Ok(if json {
                format!("{:#}\n", compare::to_json(&comparison))
            } else {
                compare::text(&comparison)
            })
        }
        Command::Scaling(args) => scaling::command(&args),
        Command::Experiment(args) => experiment::command(&args),
        Command::ViewFactors(args) => viewfactors::command(&args, comm, &stop),
        Command::Validate(args) => validate::command(&args),
        Command::Schema => Ok(format!("{:#}\n", serde_json::json!(schema()))),
        Command::Completions { shell } => Ok(completions(shell)),
    }
}

/// Returns the script for a shell.
fn completions(shell: clap_complete::Shell) -> String {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Args::command(), "sir", &mut script);
    String::from_utf8_lossy(&script).into_owned()
}

/// Returns the text to print after a run; it is empty on all ranks except the first.
fn result_text(result: &RunResult, how: &HowArgs, comm: &dyn Communicator) -> String {
    match (comm.is_first(), how.json) {
        (false, _) => String::new(),
        (true, true) => result.report.to_json(),
        (true, false) => summary::summary(result),
    }
}
