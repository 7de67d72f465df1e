//! `sir light`: from a scene file to its light, with a pipeline that the program chooses.

mod options;
mod text;

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use serde_json::json;
use sir_parallel::Communicator;
use sir_pipeline::RunOptions;
use sir_pipeline::draft::{Draft, DraftOptions, PIPELINE_FILE, draft};
use sir_pipeline::run::{absolute, run_pipeline};

use crate::error::CliError;
use crate::output::print_note;
use crate::summary::summary;

pub use options::LightArgs;

/// Executes the command: drafts the pipeline, writes it, and runs it unless that is not wanted. Returns the text to print.
pub(crate) fn command(
    args: &LightArgs,
    comm: &dyn Communicator,
    stop: Arc<AtomicBool>,
) -> Result<String, CliError> {
    if comm.size() > 1 {
        return Err(CliError::LightOnRanks);
    }
    let LightArgs { scene, out, force, dry_run, how, .. } = args;
    if !how.quiet {
        print_note(format!("Inspect: {}", scene.display()));
    }
    let options = DraftOptions {
        out: out.clone(),
        results: RunOptions::default().results,
        force: *force,
        goal: args.goal(),
        command: args.command(),
    };
    let drafted = draft(scene, &options)?;
    let path = drafted.directory.join(PIPELINE_FILE);
    if *dry_run {
        return Ok(if how.json { to_json(&drafted) } else { text::drafted(&drafted, *force) });
    }
    if !how.quiet {
        print_note(format!("Pipeline: {}", path.display()));
    }
    let options =
        RunOptions { out: Some(drafted.directory.clone()), force: *force, ..how.options(stop, comm)? };
    let result = run_pipeline(&drafted.pipeline, &options)?;
    if how.json && !drafted.choices.is_empty() {
        print_note(text::doubts(&drafted).trim());
    }
    Ok(if how.json { result.report.to_json() } else { summary(&result) + &text::finished(&drafted, &result) })
}

fn to_json(drafted: &Draft) -> String {
    let path = absolute(&drafted.directory.join(PIPELINE_FILE));
    format!("{:#}\n", json!({ "pipeline": path, "doubts": drafted.choices }))
}
