//! Crossings of global lines, counted in this process by one thread.

use std::ops::Range;

use sir_lines::{Domain, Purpose, Streams};
use sir_radiosity::Model;

use crate::error::StudyError;
use crate::experiment::runs::Runs;

/// Number of lines that are traced together.
const BLOCK: u64 = 1 << 12;

/// Traces a range of the probe lines of a scene. Calls `visit` with the number of crossings of each line, in order.
pub(crate) fn count(
    runs: &Runs,
    model: &Model,
    domain: &Domain,
    lines: Range<u64>,
    mut visit: impl FnMut(u32),
) -> Result<(), StudyError> {
    let streams = Streams::new(0, Purpose::PROBE);
    let mut tracer = model.accel.tracer();
    let mut first = lines.start;
    while first < lines.end {
        runs.launcher.check_stop()?;
        let end = lines.end.min(first + BLOCK);
        let block: Vec<_> = (first..end).map(|i| domain.line(streams.line(i).point())).collect();
        tracer.all_hits_each(&block, |hits| hits.lines().for_each(|range| visit(range.len() as u32)));
        first = end;
    }
    Ok(())
}

/// Returns a number of lines times the scale, but at least `least`.
pub(crate) fn scaled(lines: u64, scale: f64, least: u64) -> u64 {
    ((lines as f64 * scale).round() as u64).max(least)
}
