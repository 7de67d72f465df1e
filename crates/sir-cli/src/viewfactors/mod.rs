//! `sir viewfactors`: view factors between the materials or named parts of a scene.

pub(crate) mod options;
mod text;

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use sir_parallel::Communicator;
use sir_pipeline::view_factors::view_factors;

use crate::error::CliError;
use crate::progress::Stderr;
use options::ViewFactorsArgs;

/// Executes the command together with the other ranks, until it is done or `stop` becomes true: computes, writes the
/// files, and returns the text for the first rank to print.
pub(crate) fn command(
    args: &ViewFactorsArgs,
    comm: &dyn Communicator,
    stop: &Arc<AtomicBool>,
) -> Result<String, CliError> {
    let done = view_factors(&args.options(), comm, &Stderr::unless(args.quiet), stop)?;
    Ok(match (comm.is_first(), args.json) {
        (false, _) => String::new(),
        (true, true) => done.report.to_json(),
        (true, false) => text::text(&done.report, &done.files),
    })
}
