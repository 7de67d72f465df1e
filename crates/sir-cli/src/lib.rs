//! Pipelines: a text file says what to do with a scene, and this crate does it.
//!
//! # Design
//!
//! A pipeline file is RON: a list of stages, each of which turns what earlier ones made into something new. The stages
//! are thin; the work lies in the crates below. What this crate adds is the dialogue with people:
//!
//! * *All mistakes of a file at once, each at its place.* serde stops at the first error, so the file is parsed to a
//!   tree whose nodes know their place, and decoded by hand with a list of problems ([`diagnostic`]). A
//!   [`Pipeline`] is valid by construction: the order of its stages, its numbers and its paths
//!   have been checked, and nothing is written before its scene has been read.
//! * *Results to files and standard output, everything else to the standard error stream.* A run directory is complete if
//!   and only if it holds a `result.json` ([`report`]), which is written last; files appear whole or not at all.
//! * *The same pipeline gives the same bytes,* except for the times in `result.json`.
//!
//! [`main`] is the program `sir`; [`run::run`], [`run::resume_together`], [`check::check`] and [`compare::compare`] are its commands for callers
//! in Rust.
//!
//! # Example
//!
//! ```
//! use std::path::Path;
//! use sir_cli::pipeline::Pipeline;
//!
//! let text = r#"Pipeline(stages: [FirstShot(line: 1_000_000)])"#;
//! let problems = Pipeline::parse(text, Path::new("room.ron")).unwrap_err();
//! assert!(problems.to_string().contains("room.ron:1:29: error: unknown field `line` in `FirstShot`"));
//! assert!(problems.to_string().contains("help: did you mean `lines`?"));
//! ```

pub mod args;
pub mod check;
pub mod compare;
mod decode;
mod decode_focus;
mod decode_lights;
mod decode_outputs;
mod decode_repeat;
pub mod diagnostic;
mod directory;
mod error;
pub mod experiment;
mod fields;
mod fingerprint;
pub mod info;
mod interrupt;
mod lighting;
pub mod lights;
mod memory;
mod order;
pub mod pipeline;
pub mod prepare;
pub mod progress;
mod ranks;
mod repeat;
pub mod report;
mod resume;
mod ron_tree;
pub mod run;
mod save;
pub mod scaling;
pub mod sensors;
mod stages;
pub mod summary;
pub mod units;
pub mod validate;
pub mod viewfactors;

use std::io::Write as _;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use clap::Parser as _;

use args::{Args, Command, HowArgs, RunArgs};
pub use error::Error;
use pipeline::Pipeline;
use progress::Progress;
use run::{RunOptions, RunResult};
use sir_parallel::{Alone, Communicator, connect};

/// Runs the program on the arguments of the process.
#[must_use]
pub fn main() -> ExitCode {
    let args = Args::parse();
    match execute(args.command) {
        Ok(text) => match std::io::stdout().write_all(text.as_bytes()) {
            Ok(()) => ExitCode::SUCCESS,
            // Whoever reads the output has seen enough, or cannot take it: there is nobody left to tell.
            Err(_) => ExitCode::FAILURE,
        },
        Err(code) => code,
    }
}

/// Executes a command; returns what it has to say on standard output. Errors have been shown.
fn execute(command: Command) -> Result<String, ExitCode> {
    match command {
        Command::Run(_) | Command::Resume { .. } | Command::ViewFactors(_) => {
            // Before anything that takes time: a signal must never find the program unprepared.
            let stop = interrupt::flag();
            let comm = connect().map_err(|error| show(&error.into()))?;
            work(command, &*comm, stop).map_err(|error| show(&error))
        }
        alone => work(alone, &Alone, Arc::default()).map_err(|error| show(&error)),
    }
}

/// Shows an error; returns the exit code.
fn show(error: &Error) -> ExitCode {
    match error {
        Error::Pipeline(problems) => eprint!("{problems}"),
        // The rank that failed says why.
        Error::Elsewhere { .. } => {}
        other => eprintln!("error: {}", other.chain()),
    }
    ExitCode::from(error.exit_code())
}

/// Executes a command, together with the other ranks, until it is done or `stop` becomes true.
fn work(command: Command, comm: &dyn Communicator, stop: Arc<AtomicBool>) -> Result<String, Error> {
    match command {
        Command::Run(RunArgs { pipeline, out, seed, force, how }) => {
            let options = RunOptions { out, seed, force, ..options(&how, stop) };
            run::run_together(Pipeline::read(&pipeline), &options, comm)
                .map(|result| told(&result, &how, comm))
        }
        Command::Resume { directory, how } => run::resume_together(&directory, &options(&how, stop), comm)
            .map(|result| told(&result, &how, comm)),
        Command::Check { pipeline } => {
            let pipeline = Pipeline::read(&pipeline)?;
            Ok(check::check(&pipeline, Progress::Quiet)?.to_string())
        }
        Command::Info(args) => info::command(&args),
        Command::Compare { a, b, json } => {
            let comparison = compare::compare(&a, &b)?;
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
    }
}

/// Options of a run that can be stopped.
fn options(how: &HowArgs, stop: Arc<AtomicBool>) -> RunOptions {
    RunOptions {
        threads: how.threads,
        checkpoint_every: how.checkpoint_every,
        stop,
        progress: if how.quiet { Progress::Quiet } else { Progress::for_stderr() },
        ..RunOptions::default()
    }
}

/// What is printed when a run is done: by the first rank.
fn told(result: &RunResult, how: &HowArgs, comm: &dyn Communicator) -> String {
    match (comm.is_first(), how.json) {
        (false, _) => String::new(),
        (true, true) => result.report.to_json(),
        (true, false) => summary::summary(result),
    }
}
