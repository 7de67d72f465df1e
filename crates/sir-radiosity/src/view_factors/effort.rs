//! How many lines leave which group.
//!
//! Lines come in rounds, each of a quarter of all lines before it, and each round is shared so that all groups come equally close
//! to their target. The rounds depend on what was counted, never on who counted it.

/// Lines of a group in the first round.
const FIRST: u64 = 1024;

/// Fewest lines per group that make sense.
const FEWEST: u64 = 16;

/// Most lines: their streams of random numbers do not overlap up to here.
const MOST: u64 = 1 << 50;

/// How good view factors are to be: for every share of every row, the standard error is at most
/// `max(error, relative · share)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accuracy {
    /// Absolute standard error, above 0.
    pub error: f64,
    /// Relative standard error that is good enough where it is the larger one; 0 if none is.
    pub relative: f64,
}

/// How view factors are estimated. The result depends on nothing else.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewFactorSettings {
    /// When to stop. Without it, lines are shared as for some absolute error, and all are traced.
    pub accuracy: Option<Accuracy>,
    /// Most lines of all groups together.
    pub lines: u64,
    /// Seed of the random numbers.
    pub seed: u64,
}

impl ViewFactorSettings {
    /// As many lines as are needed so that no standard error is above `error`.
    #[must_use]
    pub fn to_error(error: f64, seed: u64) -> Self {
        Self { accuracy: Some(Accuracy { error, relative: 0.0 }), lines: MOST, seed }
    }

    /// This number of lines.
    #[must_use]
    pub fn of_lines(lines: u64, seed: u64) -> Self {
        Self { accuracy: None, lines, seed }
    }

    /// Most lines, as far as there are streams for them.
    fn most(&self) -> u64 {
        self.lines.min(MOST)
    }

    /// Fewest lines for this number of groups.
    pub(super) fn fewest(groups: usize) -> u64 {
        FEWEST * groups as u64
    }

    /// How many lines a group needs, of which `counts` arrived at each receiver: in proportion to that where there is no target.
    fn needed(&self, counts: &[u64], lines: u64) -> f64 {
        let Accuracy { error, relative } = self.accuracy.unwrap_or(Accuracy { error: 1.0, relative: 0.0 });
        let needed = counts.iter().map(|&count| {
            let share = count as f64 / lines.max(1) as f64;
            let tolerance = error.max(relative * share);
            variance(count, lines) / (tolerance * tolerance)
        });
        needed.fold(0.0, f64::max)
    }

    /// What comes next, when each of some groups has had so many lines and so many have arrived at each receiver.
    pub(super) fn next(&self, lines: &[u64], counts: &[u64]) -> Next {
        let done: u64 = lines.iter().sum();
        if done == 0 {
            let end = self.most().min(FIRST * lines.len() as u64);
            return Next { weights: vec![1.0; lines.len()], end, expected: end, finished: false };
        }
        let rows = counts.chunks(counts.len() / lines.len());
        let needed: Vec<f64> = lines.iter().zip(rows).map(|(&n, row)| self.needed(row, n)).collect();
        let met =
            self.accuracy.is_some() && lines.iter().zip(&needed).all(|(&n, &needed)| n as f64 >= needed);
        let end = self.most().min(done + (done / 4).max(1));
        let total: f64 = needed.iter().sum();
        let fair = |needed: f64| end as f64 * (needed / total);
        // None is nothing, so that rounding cannot leave all with nothing.
        let weights =
            lines.iter().zip(&needed).map(|(&n, &needed)| (fair(needed) - n as f64).max(needed / total));
        let expected = if self.accuracy.is_some() { total as u64 } else { MOST };
        Next {
            weights: weights.collect(),
            end,
            expected: expected.max(end).min(self.most()),
            finished: met || done >= self.most(),
        }
    }
}

/// The next round.
#[derive(Clone, Debug)]
pub(super) struct Next {
    /// In proportion to these, the lines are shared among the groups.
    pub(super) weights: Vec<f64>,
    /// All lines, once the round is done.
    pub(super) end: u64,
    /// All lines that will be needed, as far as can be told.
    pub(super) expected: u64,
    /// Whether there is no need of it.
    pub(super) finished: bool,
}

/// The variance `p (1 − p)` of one line, where `count` of `lines` arrived, with Laplace's `p`.
pub(super) fn variance(count: u64, lines: u64) -> f64 {
    let p = (count as f64 + 1.0) / (lines as f64 + 2.0);
    p * (1.0 - p)
}
