//! The measurement: all runs of a plan, one after the other.

use crate::error::StudyError;
use crate::scaling::same;
use crate::scaling::study::Study;
use crate::scaling::study::Timing;
use crate::scaling::workers::{Plan, Workers};
use sir_pipeline::Progress;
use sir_pipeline::format::duration;
use sir_pipeline::report::Report;
use sir_pipeline::stopwatch::Stopwatch;

/// Makes the runs of a plan by calling `run`, one at a time and interleaved, and evaluates their times. `name` is the
/// name of the pipeline, `cores` the number of cores of the machine.
///
/// # Errors
///
/// Those of `run`, or [`ScalingError::DifferentResults`](crate::scaling::error::ScalingError::DifferentResults) if the
/// result of a run differs from that of the first one.
pub fn measure(
    name: &str,
    cores: usize,
    plan: &Plan,
    progress: &dyn Progress,
    run: &mut dyn FnMut(Workers) -> Result<Report, StudyError>,
) -> Result<Study, StudyError> {
    let total = plan.workers.len() * plan.repeats.get();
    let mut timings = vec![Vec::new(); plan.workers.len()];
    let mut seconds = Vec::with_capacity(total);
    let mut first = None;
    for (repeat, index) in plan.runs() {
        let (workers, repeat) = (plan.workers[index], repeat + 1);
        progress.message(&format!("{workers}, repeat {repeat} of {}", plan.repeats));
        let watch = Stopwatch::start();
        let report = run(workers)?;
        seconds.push(watch.seconds());
        let left = match remaining(&seconds, plan.workers.len(), total) {
            Some(left) if left < 120.0 => format!(", about {:.0} s left", left.ceil()),
            Some(left) => format!(", about {} left", duration(left)),
            None => String::new(),
        };
        progress.message(&format!("  {}{left}", duration(watch.seconds())));
        timings[index].push(Timing::of(&report));
        match &first {
            None => first = Some(((workers, repeat), report)),
            Some((which, first)) => same::check((*which, first), ((workers, repeat), &report))?,
        }
    }
    Ok(Study::new(name, cores, plan, &timings))
}

/// Estimates the remaining time \[s\], assuming that every run takes as long as in the last round. Returns `None` in
/// the first round, where it is unknown, and at the end.
fn remaining(seconds: &[f64], round: usize, total: usize) -> Option<f64> {
    let last = seconds.len().checked_sub(round).map(|start| &seconds[start..])?;
    let left = total.saturating_sub(seconds.len());
    // The oldest of the last `round` runs had the combination that comes next.
    (left > 0).then(|| last.iter().cycle().take(left).sum())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_remaining_time_is_that_of_the_runs_to_come() {
        assert_eq!(remaining(&[4.0], 2, 6), None);
        assert_eq!(remaining(&[4.0, 2.0], 2, 6), Some(12.0));
        assert_eq!(remaining(&[4.0, 2.0, 5.0], 2, 6), Some(2.0 + 5.0 + 2.0));
        assert_eq!(remaining(&[4.0, 2.0, 5.0, 2.0, 5.0, 2.0], 2, 6), None);
        assert_eq!(remaining(&[], 0, 0), None);
    }
}
