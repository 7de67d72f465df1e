//! The number of lines of each group.
//!
//! Lines are traced in rounds, each a quarter of all lines before it. Each round is allocated such that all groups come
//! equally close to their target. The rounds depend on the counts only, not on the workers that made them.

/// Lines per group in the first round.
const FIRST: u64 = 1024;

/// Smallest number of lines per group.
const MIN_LINES_PER_GROUP: u64 = 16;

/// Largest number of lines. Up to here, their streams of random numbers do not overlap.
const MAX_LINES: u64 = 1 << 50;

/// Required accuracy: the standard error of every share of every row is at most `max(error, relative · share)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accuracy {
    /// Absolute standard error, above 0.
    pub error: f64,
    /// Relative standard error that suffices where it is larger than the absolute one; 0 for none.
    pub relative: f64,
}

/// Settings of a view factor computation. The result depends on nothing else.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewFactorSettings {
    /// Stopping criterion. Without it, lines are allocated as for some absolute error, and all are traced.
    pub accuracy: Option<Accuracy>,
    /// Largest number of lines of all groups together.
    pub lines: u64,
    /// Seed of the random numbers.
    pub seed: u64,
}

impl ViewFactorSettings {
    /// Returns settings with as many lines as are needed for no standard error to exceed `error`.
    #[must_use]
    pub fn to_error(error: f64, seed: u64) -> Self {
        Self { accuracy: Some(Accuracy { error, relative: 0.0 }), lines: MAX_LINES, seed }
    }

    /// Returns settings with this number of lines.
    #[must_use]
    pub fn of_lines(lines: u64, seed: u64) -> Self {
        Self { accuracy: None, lines, seed }
    }

    /// Returns the largest number of lines, limited by the number of streams.
    fn max_lines(&self) -> u64 {
        self.lines.min(MAX_LINES)
    }

    /// Returns the smallest number of lines for this number of groups.
    pub(super) fn min_lines(groups: usize) -> u64 {
        MIN_LINES_PER_GROUP * groups as u64
    }

    /// Returns the demand of a group, from the `counts` that arrived at each receiver: the largest variance of a line.
    /// A variance is reduced if its share may have a larger error than the absolute one.
    ///
    /// For the absolute error `error`, the group needs `demand/error²` lines. The factor `1/error²` is left out, so that
    /// a run that is given only the number of lines allocates them in the same way, to the last bit.
    fn demand(&self, counts: &[u64], lines: u64) -> f64 {
        let loosened = |share: f64| match self.accuracy {
            Some(Accuracy { error, relative }) => (relative * share / error).max(1.0),
            None => 1.0,
        };
        let demands = counts.iter().map(|&count| {
            let slack = loosened(count as f64 / lines.max(1) as f64);
            variance(count, lines) / (slack * slack)
        });
        demands.fold(0.0, f64::max)
    }

    /// Returns the next round, given the number of lines of each group so far and their counts at each receiver.
    pub(super) fn next(&self, lines: &[u64], counts: &[u64]) -> Next {
        let done: u64 = lines.iter().sum();
        if done == 0 {
            let end = self.max_lines().min(FIRST * lines.len() as u64);
            let expected = if self.accuracy.is_some() { end } else { self.max_lines() };
            return Next { weights: vec![1.0; lines.len()], end, expected, finished: false };
        }
        let rows = counts.chunks(counts.len() / lines.len());
        let demands: Vec<f64> = lines.iter().zip(rows).map(|(&n, row)| self.demand(row, n)).collect();
        let total: f64 = demands.iter().sum();
        let end = self.max_lines().min(done + (done / 4).max(1));
        // Every weight is positive, so that rounding cannot make all of them zero.
        let weights = lines.iter().zip(&demands).map(|(&n, &demand)| {
            let share = demand / total;
            (end as f64 * share - n as f64).max(share)
        });
        let (reached, needed) = match self.accuracy {
            Some(Accuracy { error, .. }) => {
                let needed = |demand: f64| demand / (error * error);
                let reached = lines.iter().zip(&demands).all(|(&n, &demand)| n as f64 >= needed(demand));
                (reached, needed(total) as u64)
            }
            None => (false, MAX_LINES),
        };
        Next {
            weights: weights.collect(),
            end,
            expected: needed.max(end).min(self.max_lines()),
            finished: reached || done >= self.max_lines(),
        }
    }
}

/// The next round.
#[derive(Clone, Debug)]
pub(super) struct Next {
    /// Weights in proportion to which the lines are allocated to the groups.
    pub(super) weights: Vec<f64>,
    /// Total number of lines after the round.
    pub(super) end: u64,
    /// Estimated total number of lines that will be needed.
    pub(super) expected: u64,
    /// True if this round is not needed.
    pub(super) finished: bool,
}

/// Returns the variance `p (1 − p)` of one line, where `count` of `lines` arrived, with Laplace's `p`.
pub(super) fn variance(count: u64, lines: u64) -> f64 {
    let p = (count as f64 + 1.0) / (lines as f64 + 2.0);
    p * (1.0 - p)
}
