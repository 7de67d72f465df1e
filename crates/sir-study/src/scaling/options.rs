//! The options of a measurement of speed-ups.

use std::num::NonZeroUsize;
use std::path::PathBuf;

use crate::scaling::workers::Plan;

/// Command that starts several processes on one machine. Without these options, Open MPI refuses more ranks than cores,
/// and binds each rank, with all its threads, to one core.
pub const MPIRUN: &str = "mpirun --oversubscribe --bind-to none";

/// Options of a measurement of speed-ups.
#[derive(Clone, Debug)]
pub struct ScalingOptions {
    /// The pipeline file.
    pub pipeline: PathBuf,
    /// Numbers of threads of each process; if empty, powers of two up to the number of cores.
    pub threads: Vec<NonZeroUsize>,
    /// Numbers of processes. Every number of ranks is run with every number of threads.
    pub ranks: Vec<NonZeroUsize>,
    /// Number of runs of each combination.
    pub repeats: NonZeroUsize,
    /// Output directory; `None` for a new directory `results/NAME-scaling`.
    pub out: Option<PathBuf>,
    /// Command that starts several processes. It is split at spaces, and `-n RANKS sir run …` is appended.
    pub mpirun: String,
}

impl ScalingOptions {
    /// Returns the plan of the runs on a machine with `cores` cores.
    #[must_use]
    pub fn plan(&self, cores: NonZeroUsize) -> Plan {
        if self.threads.is_empty() {
            Plan::new(&self.ranks, &powers_of_two(cores), self.repeats)
        } else {
            Plan::new(&self.ranks, &self.threads, self.repeats)
        }
    }
}

/// Returns the powers of two below `last`, followed by `last`.
fn powers_of_two(last: NonZeroUsize) -> Vec<NonZeroUsize> {
    let powers = std::iter::successors(Some(NonZeroUsize::MIN), |n| {
        n.checked_mul(NonZeroUsize::MIN.saturating_add(1))
    });
    powers.take_while(|n| *n < last).chain([last]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn by_default_all_cores_are_tried_with_one_rank() {
        let one = NonZeroUsize::MIN;
        let options = ScalingOptions {
            pipeline: PathBuf::new(),
            threads: Vec::new(),
            ranks: vec![one],
            repeats: one,
            out: None,
            mpirun: MPIRUN.into(),
        };
        let counts = |cores| -> Vec<usize> {
            options.plan(NonZeroUsize::new(cores).unwrap()).workers.iter().map(|w| w.count()).collect()
        };
        assert_eq!(counts(1), [1]);
        assert_eq!(counts(4), [1, 2, 4]);
        assert_eq!(counts(6), [1, 2, 4, 6]);
    }
}
