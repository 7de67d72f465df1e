//! The options of the experiment.

use std::num::NonZeroUsize;
use std::path::PathBuf;

use serde::Serialize;

use crate::scaling::workers::Plan;

/// Options of the experiment.
#[derive(Clone, Debug)]
pub struct ExperimentOptions {
    /// Pipeline files; if empty, those of the museum stairs and of the airplane cabin, in `scenes` in the current
    /// folder.
    pub pipelines: Vec<PathBuf>,
    /// Output directory; `None` for a new directory `results/experiment`. In the directory of an earlier experiment,
    /// finished runs are not repeated.
    pub out: Option<PathBuf>,
    /// Factor on all numbers of lines, above 0 and at most 1. The patches stay the same.
    pub scale: f64,
    /// Numbers of threads to measure speed-ups with; if empty, 1 up to the number of cores.
    pub threads: Vec<NonZeroUsize>,
    /// Numbers of processes of one thread each to measure speed-ups with; if empty, 1 up to the number of cores, if
    /// built with MPI.
    pub ranks: Vec<NonZeroUsize>,
    /// Command that starts several processes, as in [`ScalingOptions`](crate::scaling::ScalingOptions).
    pub mpirun: String,
    /// Lines of the reference run, with which results are compared, as a multiple of the pipeline's.
    pub reference: f64,
    /// Parts to do; if empty, all parts.
    pub parts: Vec<Part>,
}

/// Part of the experiment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Part {
    /// Times, speed-ups and efficiencies of threads and ranks.
    Scaling,
    /// Error against a run with many more lines.
    Error,
    /// Best share of local lines.
    Mix,
    /// Share of global lines that miss the scene.
    Domains,
    /// Spread of the cost of lines.
    Spread,
    /// Light that the mean of independent replicas loses.
    Farm,
    /// Images of the pipeline.
    Pictures,
}

impl Part {
    /// All parts, in their order.
    pub const ALL: [Self; 7] =
        [Self::Scaling, Self::Error, Self::Mix, Self::Domains, Self::Spread, Self::Farm, Self::Pictures];
}

impl ExperimentOptions {
    /// Returns the parts to do, in their order, each once.
    #[must_use]
    pub fn parts(&self) -> Vec<Part> {
        let is_wanted = |part: &Part| self.parts.is_empty() || self.parts.contains(part);
        Part::ALL.into_iter().filter(is_wanted).collect()
    }

    /// Returns the plan for measuring the speed-up on a machine with `cores` cores. `mpi` is true if the program was
    /// built with MPI.
    #[must_use]
    pub fn plan(&self, cores: NonZeroUsize, mpi: bool) -> Plan {
        let all: Vec<NonZeroUsize> = (1..=cores.get()).filter_map(NonZeroUsize::new).collect();
        let or = |given: &[NonZeroUsize], default: &[NonZeroUsize]| -> Vec<NonZeroUsize> {
            if given.is_empty() { default } else { given }.to_vec()
        };
        let ranks = or(&self.ranks, if mpi { &all } else { &[NonZeroUsize::MIN] });
        Plan::each(&ranks, &or(&self.threads, &all), NonZeroUsize::MIN)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn options(parts: &[Part], threads: &[usize], ranks: &[usize]) -> ExperimentOptions {
        let numbers = |numbers: &[usize]| numbers.iter().filter_map(|&n| NonZeroUsize::new(n)).collect();
        ExperimentOptions {
            pipelines: Vec::new(),
            out: None,
            scale: 1.0,
            threads: numbers(threads),
            ranks: numbers(ranks),
            mpirun: String::new(),
            reference: 20.0,
            parts: parts.into(),
        }
    }

    #[test]
    fn parts_are_done_in_their_order_each_once() {
        let parts = options(&[Part::Mix, Part::Error, Part::Mix], &[], &[]).parts();
        assert_eq!(parts, [Part::Error, Part::Mix]);
        assert_eq!(options(&[], &[], &[]).parts(), Part::ALL);
    }

    #[test]
    fn by_default_every_number_of_cores_is_tried() {
        let count = |threads: &[usize], ranks: &[usize], mpi| -> Vec<usize> {
            let plan = options(&[], threads, ranks).plan(NonZeroUsize::new(3).unwrap(), mpi);
            plan.workers.iter().map(|w| w.count()).collect()
        };
        assert_eq!(count(&[], &[], false), [1, 2, 3]);
        assert_eq!(count(&[], &[], true), [1, 2, 2, 3, 3]);
        assert_eq!(count(&[2], &[4], true), [1, 2, 4]);
    }
}
