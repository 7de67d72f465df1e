//! Numbers of ranks and threads, and the combinations that are measured.

use std::fmt;
use std::num::NonZeroUsize;

use serde::Serialize;

/// Number of ranks, and of threads of each rank.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Workers {
    /// Number of processes that communicate by MPI; 1 without MPI.
    pub ranks: NonZeroUsize,
    /// Number of threads of each process.
    pub threads: NonZeroUsize,
}

impl Workers {
    /// One rank with one thread, with which all others are compared.
    pub const BASELINE: Self = Self { ranks: NonZeroUsize::MIN, threads: NonZeroUsize::MIN };

    /// Returns the number of workers `p`: all threads of all ranks.
    #[must_use]
    pub fn count(self) -> usize {
        self.ranks.get().saturating_mul(self.threads.get())
    }
}

impl fmt::Display for Workers {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (ranks, threads) = (counted(self.ranks.get(), "rank"), counted(self.threads.get(), "thread"));
        write!(f, "{ranks} × {threads}")
    }
}

/// Formats a number of things, such as `1 thread` or `2 threads`.
pub(crate) fn counted(n: usize, thing: &str) -> String {
    format!("{n} {thing}{}", if n == 1 { "" } else { "s" })
}

/// Combinations of ranks and threads to measure, and the number of repeats.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Plan {
    /// Unique combinations, fewest workers first. The first one is [`Workers::BASELINE`].
    pub workers: Vec<Workers>,
    /// True if the baseline was added although it was not requested.
    pub baseline_added: bool,
    /// Number of runs of each combination.
    pub repeats: NonZeroUsize,
}

impl Plan {
    /// Combines every number of ranks with every number of threads, and adds the baseline.
    #[must_use]
    pub fn new(ranks: &[NonZeroUsize], threads: &[NonZeroUsize], repeats: NonZeroUsize) -> Self {
        let pairs = ranks.iter().flat_map(|&ranks| threads.iter().map(move |&threads| (ranks, threads)));
        Self::of(pairs.map(|(ranks, threads)| Workers { ranks, threads }).collect(), repeats)
    }

    /// Combines every number of threads with one rank and every number of ranks with one thread, and adds the baseline.
    #[must_use]
    pub fn each(ranks: &[NonZeroUsize], threads: &[NonZeroUsize], repeats: NonZeroUsize) -> Self {
        let one = NonZeroUsize::MIN;
        let threads = threads.iter().map(|&threads| Workers { ranks: one, threads });
        let ranks = ranks.iter().map(|&ranks| Workers { ranks, threads: one });
        Self::of(threads.chain(ranks).collect(), repeats)
    }

    fn of(mut workers: Vec<Workers>, repeats: NonZeroUsize) -> Self {
        let baseline_added = !workers.contains(&Workers::BASELINE);
        if baseline_added {
            workers.push(Workers::BASELINE);
        }
        workers.sort_by_key(|w| (w.count(), w.ranks));
        workers.dedup();
        Self { workers, baseline_added, repeats }
    }

    /// Returns the largest number of ranks.
    #[must_use]
    pub fn most_ranks(&self) -> usize {
        self.workers.iter().map(|w| w.ranks.get()).max().unwrap_or(1)
    }

    /// Returns all runs as pairs of repeat and index of the combination. They are interleaved, every combination once
    /// per repeat, so that a machine that becomes slower during the measurement slows down all combinations.
    pub fn runs(&self) -> impl Iterator<Item = (usize, usize)> {
        let combinations = self.workers.len();
        (0..self.repeats.get()).flat_map(move |repeat| (0..combinations).map(move |index| (repeat, index)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbers<const N: usize>(numbers: [usize; N]) -> [NonZeroUsize; N] {
        numbers.map(|n| NonZeroUsize::new(n).unwrap())
    }

    #[test]
    fn combinations_are_in_order_and_unique() {
        let plan = Plan::new(&numbers([2, 1, 2]), &numbers([1, 4, 2]), NonZeroUsize::MIN);
        let found: Vec<_> = plan.workers.iter().map(|w| (w.ranks.get(), w.threads.get())).collect();
        assert_eq!(found, [(1, 1), (1, 2), (2, 1), (1, 4), (2, 2), (2, 4)]);
        assert!(!plan.baseline_added);
        assert_eq!(plan.most_ranks(), 2);
    }

    #[test]
    fn threads_and_ranks_may_be_tried_by_themselves() {
        let plan = Plan::each(&numbers([2, 1]), &numbers([1, 2]), NonZeroUsize::MIN);
        let found: Vec<_> = plan.workers.iter().map(|w| (w.ranks.get(), w.threads.get())).collect();
        assert_eq!(found, [(1, 1), (1, 2), (2, 1)]);
    }

    #[test]
    fn the_baseline_is_always_there() {
        let [two] = numbers([2]);
        let plan = Plan::new(&[two], &[two], two);
        assert_eq!(plan.workers, [Workers::BASELINE, Workers { ranks: two, threads: two }]);
        assert!(plan.baseline_added);
        assert_eq!(plan.runs().collect::<Vec<_>>(), [(0, 0), (0, 1), (1, 0), (1, 1)]);
    }

    #[test]
    fn names_count_properly() {
        let [one, two] = numbers([1, 2]);
        assert_eq!(Workers { ranks: two, threads: one }.to_string(), "2 ranks × 1 thread");
        assert_eq!(Workers { ranks: one, threads: two }.to_string(), "1 rank × 2 threads");
    }
}
