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
//! [`main`] is the program `sir`; [`run::run`], [`check::check`] and [`compare::compare`] are its commands for callers
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
mod decode_outputs;
pub mod diagnostic;
mod directory;
mod error;
mod fields;
mod order;
pub mod pipeline;
pub mod prepare;
pub mod progress;
pub mod report;
mod ron_tree;
pub mod run;
mod save;
pub mod summary;

use std::io::Write as _;
use std::process::ExitCode;

use clap::Parser as _;

use args::{Args, Command, RunArgs};
pub use error::Error;
use pipeline::Pipeline;
use progress::Progress;
use run::RunOptions;

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
        Err(error) => {
            match &error {
                Error::Pipeline(problems) => eprint!("{problems}"),
                other => eprintln!("error: {}", other.chain()),
            }
            ExitCode::from(error.exit_code())
        }
    }
}

/// Executes a command; returns what it has to say on standard output.
fn execute(command: Command) -> Result<String, Error> {
    match command {
        Command::Run(args) => run_command(args),
        Command::Check { pipeline } => {
            let pipeline = Pipeline::read(&pipeline)?;
            Ok(check::check(&pipeline, Progress::Quiet)?.to_string())
        }
        Command::Compare { a, b, json } => {
            let comparison = compare::compare(&a, &b)?;
            Ok(if json {
                format!("{:#}\n", compare::to_json(&comparison))
            } else {
                compare::text(&comparison)
            })
        }
    }
}

fn run_command(args: RunArgs) -> Result<String, Error> {
    let pipeline = Pipeline::read(&args.pipeline)?;
    let options = RunOptions {
        out: args.out,
        force: args.force,
        seed: args.seed,
        threads: args.threads,
        progress: if args.quiet { Progress::Quiet } else { Progress::for_stderr() },
        ..RunOptions::default()
    };
    let result = run::run(&pipeline, &options)?;
    Ok(if args.json { result.report.to_json() } else { summary::summary(&result) })
}
