//! Allocation of lines to sources.

/// Allocation of the lines `0 … N − 1` to sources in proportion to their weights, in consecutive runs.
///
/// This is systematic sampling: with the cumulative shares `c_k` of the weights, source `k` gets the lines from `⌊N
/// c_{k−1} + u⌋` to `⌊N c_k + u⌋`, for one uniform `u` in `[0, 1)`. The counts add up to exactly `N`. Each differs from
/// its expectation by less than one, and is unbiased over `u`: a source too weak for one line gets one with the right
/// probability.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Allocation {
    /// End of the run of lines of each source.
    ends: Vec<u64>,
}

impl Allocation {
    /// Allocates `lines` (below 2⁵³) to sources with these weights, which must be finite and nonnegative. `offset` is
    /// `u`. If all weights are zero, no source gets a line.
    #[must_use]
    pub fn new(weights: &[f64], lines: u64, offset: f64) -> Self {
        let total: f64 = weights.iter().sum();
        let last_source = weights.iter().rposition(|&w| w > 0.0);
        let mut sum = 0.0;
        let ends = weights
            .iter()
            .enumerate()
            .map(|(k, w)| {
                sum += w;
                match last_source {
                    // Rounding must neither lose the last line nor give it to a source without power.
                    Some(last) if k >= last => lines,
                    Some(_) => ((lines as f64 * (sum / total) + offset).floor() as u64).min(lines),
                    None => 0,
                }
            })
            .collect();
        Self { ends }
    }

    /// Returns the source of line `index`, which must be below the number of lines.
    #[inline]
    #[must_use]
    pub fn owner(&self, index: u64) -> usize {
        self.ends.partition_point(|&end| end <= index)
    }

    /// Returns the sources of line `first` and of all lines after it.
    pub fn owners(&self, first: u64) -> impl Iterator<Item = usize> {
        let start = self.owner(first);
        (start..self.ends.len()).flat_map(move |k| {
            let before = if k == start { first } else { self.ends[k - 1] };
            std::iter::repeat_n(k, (self.ends[k] - before) as usize)
        })
    }

    /// Returns the number of lines of source `k`.
    #[must_use]
    pub fn count(&self, k: usize) -> u64 {
        self.ends[k] - if k == 0 { 0 } else { self.ends[k - 1] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn every_line_has_one_owner(
            weights in prop::collection::vec(0.0..10.0f64, 1..50), lines in 0..10_000u64, offset in 0.0..1.0f64,
        ) {
            prop_assume!(weights.iter().sum::<f64>() > 0.0);
            let a = Allocation::new(&weights, lines, offset);
            let mut counted = vec![0; weights.len()];
            for i in 0..lines {
                counted[a.owner(i)] += 1;
            }
            for first in [0, lines / 3, lines] {
                prop_assert!(a.owners(first).eq((first..lines).map(|i| a.owner(i))));
            }
            let total: f64 = weights.iter().sum();
            for (k, w) in weights.iter().enumerate() {
                prop_assert_eq!(counted[k], a.count(k));
                prop_assert!((counted[k] as f64 - lines as f64 * w / total).abs() < 1.0 + 1e-6);
            }
        }
    }

    #[test]
    fn weak_sources_get_their_fair_share_on_average() {
        let weights = [1.0, 0.1, 0.0, 2.0, 0.05];
        let lines = 10;
        let draws = 10_000;
        let mut counted = [0; 5];
        for d in 0..draws {
            let a = Allocation::new(&weights, lines, (f64::from(d) + 0.5) / f64::from(draws));
            for (k, c) in counted.iter_mut().enumerate() {
                *c += a.count(k);
            }
        }
        for (k, w) in weights.iter().enumerate() {
            let mean = counted[k] as f64 / f64::from(draws);
            assert!((mean - 10.0 * w / 3.15).abs() < 1e-3, "source {k}: {mean}");
        }
        assert_eq!(counted[2], 0);
    }

    #[test]
    fn no_power_has_no_lines() {
        let a = Allocation::new(&[0.0, 0.0], 5, 0.5);
        assert_eq!((a.count(0), a.count(1)), (0, 0));
    }
}
