//! The numbers of a measurement.

use serde::Serialize;

use crate::scaling::statistics::{Overhead, Part, Spread};
use crate::scaling::workers::counted;
use crate::scaling::workers::{Plan, Workers};
use sir_pipeline::report::Report;

/// Version of the layout of `scaling.json`.
pub const VERSION: u32 = 1;

/// Times of the parts of one run \[s\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Timing {
    /// The first shot, if the pipeline has one.
    pub first_shot: Option<f64>,
    /// Multipath, if the pipeline has it.
    pub multipath: Option<f64>,
    /// The whole run, from reading the scene to writing the files.
    pub whole: f64,
    /// Time of both stages together in which no lines were traced.
    pub sequential: f64,
    /// Time of both stages together for exchanging numbers with other ranks, and for waiting for them.
    pub communication: f64,
}

impl Timing {
    /// Takes the times from a report.
    #[must_use]
    pub fn of(report: &Report) -> Self {
        let all = report.stages.iter().flat_map(|stage| std::iter::once(stage).chain(&stage.stages));
        let stage = |name| all.clone().find(|s| s.name == name).map(|s| s.time.seconds);
        let times = || report.stages.iter().map(|s| s.time);
        Self {
            first_shot: stage("FirstShot"),
            multipath: stage("Multipath"),
            whole: report.time.seconds,
            sequential: times().filter_map(|t| t.sequential).sum(),
            communication: times().filter_map(|t| t.communication).sum(),
        }
    }
}

/// Measurements of one combination.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Row {
    /// Number of workers `p`.
    pub p: usize,
    /// Ranks and threads.
    #[serde(flatten)]
    pub workers: Workers,
    /// True if there are more workers than the machine has cores.
    pub more_than_cores: bool,
    /// The first shot, if the pipeline has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub first_shot: Option<Part>,
    /// Multipath, if the pipeline has it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub multipath: Option<Part>,
    /// The whole run.
    pub whole: Part,
    /// See [`Timing::sequential`].
    pub sequential: Overhead,
    /// See [`Timing::communication`].
    pub communication: Overhead,
}

/// Result of `sir scaling`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Study {
    /// Version of this layout: [`VERSION`].
    pub version: u32,
    /// Name of the pipeline.
    pub name: String,
    /// Number of cores of the machine.
    pub cores: usize,
    /// Number of runs of each combination.
    pub repeats: usize,
    /// Workers whose times are `T(1)`.
    pub baseline: Workers,
    /// True if the baseline was added although it was not requested.
    pub baseline_added: bool,
    /// Measurements of all combinations, fewest workers first.
    pub rows: Vec<Row>,
}

impl Study {
    /// Evaluates the times of all runs. `timings` has those of each combination, in the order of the plan.
    #[must_use]
    pub fn new(name: &str, cores: usize, plan: &Plan, timings: &[Vec<Timing>]) -> Self {
        // The first combination of the plan is the baseline.
        let one = timings.first().map_or(&[][..], Vec::as_slice);
        let rows = plan.workers.iter().zip(timings);
        Self {
            version: VERSION,
            name: name.into(),
            cores,
            repeats: plan.repeats.get(),
            baseline: Workers::BASELINE,
            baseline_added: plan.baseline_added,
            rows: rows.filter_map(|(&workers, timings)| row(workers, cores, one, timings)).collect(),
        }
    }

    /// Returns notes that explain the numbers, a sentence or two each.
    #[must_use]
    pub fn notes(&self) -> Vec<String> {
        let times = match self.repeats {
            1 => "time of one run".into(),
            n => format!("median of {n} runs"),
        };
        let added = if self.baseline_added { ", which was added for this" } else { "" };
        vec![
            format!("T: {times}. S = T(1)/T(p), E = S/p, where T(1) is that of {}{added}.", self.baseline),
            "Sequential and communication: seconds of the stages with lines, and their share of the whole \
             run."
                .into(),
            format!("The results of all runs ({}) are the same.", self.repeats * self.rows.len()),
            format!("This machine has {}.", counted(self.cores, "core")),
        ]
    }

    /// Returns the meaning of the mark at rows with more workers than cores, if there are such rows.
    #[must_use]
    pub fn mark(&self) -> Option<&'static str> {
        let marked = self.rows.iter().any(|row| row.more_than_cores);
        marked
            .then_some("more workers than cores: E is limited by the cores, unless other machines took part.")
    }
}

/// Mark of rows with more workers than cores.
pub(super) const MARK: &str = "*";

/// Summarizes one of the times of some runs; returns `None` if no run has it.
fn spread(timings: &[Timing], time: fn(&Timing) -> Option<f64>) -> Option<Spread> {
    Spread::of(timings.iter().filter_map(time))
}

fn row(workers: Workers, cores: usize, one: &[Timing], these: &[Timing]) -> Option<Row> {
    let p = workers.count();
    let part = |time: fn(&Timing) -> Option<f64>| -> Option<Part> {
        Some(Part::new(spread(one, time)?, spread(these, time)?, p))
    };
    let whole = part(|t| Some(t.whole))?;
    let overhead = |time: fn(&Timing) -> Option<f64>| -> Option<Overhead> {
        Some(Overhead::new(spread(these, time)?, whole.seconds))
    };
    Some(Row {
        p,
        workers,
        more_than_cores: p > cores,
        first_shot: part(|t| t.first_shot),
        multipath: part(|t| t.multipath),
        whole,
        sequential: overhead(|t| Some(t.sequential))?,
        communication: overhead(|t| Some(t.communication))?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::num::NonZeroUsize;

    #[test]
    fn rows_are_marked_beyond_the_cores_and_lack_what_the_runs_lack() {
        let timing = |whole| Timing {
            first_shot: Some(whole / 2.0),
            multipath: None,
            whole,
            sequential: whole / 4.0,
            communication: 0.0,
        };
        let numbers = [1, 2, 4].map(|n| NonZeroUsize::new(n).unwrap());
        let plan = Plan::new(&numbers[..1], &numbers, NonZeroUsize::MIN);
        let study = Study::new("x", 2, &plan, &[8.0, 4.0, 4.0].map(|t| vec![timing(t)]));
        let marks: Vec<_> = study.rows.iter().map(|row| (row.p, row.more_than_cores)).collect();
        assert_eq!(marks, [(1, false), (2, false), (4, true)]);
        assert!(study.mark().is_some());
        let last = study.rows[2];
        assert_eq!((last.multipath, last.whole.efficiency, last.sequential.share), (None, 0.5, 0.25));
        assert_eq!(last.first_shot.map(|part| part.speed_up), Some(2.0));
    }
}
