//! Counts and energy balances of a stage, summed over repeats.

use std::ops::AddAssign;

use crate::power::Quanta;
use crate::totals::{Balance, Counts};
use crate::transported::Walked;
use crate::visitor::{Visitor, visit_counts, visit_slice};

/// Counts and energy balance of one stage, summed over all repeats so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RepeatedTotals {
    counts: Counts,
    /// Emitted, absorbed, blocked, escaped, unshot.
    balance: [QuantaSum; 5],
    walks: u64,
    walked: QuantaSum,
}

impl RepeatedTotals {
    /// Adds the totals of one more repeat.
    pub fn add(&mut self, balance: &Balance, counts: Counts, walked: Walked) {
        let Balance { emitted, absorbed, blocked, escaped, unshot } = *balance;
        let powers = [emitted, absorbed, blocked, escaped, unshot];
        self.balance.iter_mut().zip(powers).for_each(|(sum, power)| *sum += power);
        self.counts += counts;
        self.walks += walked.walks;
        self.walked += walked.power;
    }

    /// Returns the counts of all lines.
    #[must_use]
    pub fn counts(&self) -> Counts {
        self.counts
    }

    /// Returns the mean balance of `count` repeats, to the nearest quantum, except for the unshot power. That is the
    /// remainder, so that the mean closes if the balances of all repeats do.
    #[must_use]
    pub fn mean_balance(&self, count: u64) -> Balance {
        let closes = |k: usize| {
            let [emitted, parts @ ..] = self.balance.map(|sum| sum.0[k]);
            emitted == parts.iter().sum()
        };
        let [emitted, absorbed, blocked, escaped, mut unshot] = self.balance.map(|sum| sum.mean(count));
        let rest = emitted - absorbed - blocked - escaped;
        for k in (0..3).filter(|&k| closes(k)) {
            unshot.0[k] = rest.0[k];
        }
        Balance { emitted, absorbed, blocked, escaped, unshot }
    }

    /// Returns the number of random walks of all repeats, and the mean of their power in `count` repeats.
    #[must_use]
    pub fn mean_walked(&self, count: u64) -> Walked {
        Walked { walks: self.walks, power: self.walked.mean(count) }
    }

    /// Visits the sums.
    pub fn visit(&mut self, visitor: &mut dyn Visitor) {
        let Counts { lines, empty, odd, crossings } = &mut self.counts;
        visit_counts([lines, empty, odd, crossings, &mut self.walks], visitor);
        visit_slice(&mut self.balance, visitor, |sum| sum.words(), QuantaSum::of_words);
        visit_slice(std::slice::from_mut(&mut self.walked), visitor, |sum| sum.words(), QuantaSum::of_words);
    }
}

/// Sum of power over repeats. The sum may exceed the 64 bits of [`Quanta`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct QuantaSum([i128; 3]);

impl AddAssign<Quanta> for QuantaSum {
    fn add_assign(&mut self, power: Quanta) {
        self.0.iter_mut().zip(power.0).for_each(|(sum, power)| *sum += i128::from(power));
    }
}

impl QuantaSum {
    /// Returns the mean of `count` repeats to the nearest quantum, halves away from zero.
    fn mean(self, count: u64) -> Quanta {
        let count = i128::from(count.max(1));
        Quanta(self.0.map(|sum| ((2 * sum + sum.signum() * count) / (2 * count)) as i64))
    }

    /// Returns the sum as words of 64 bits, low words first.
    fn words(self) -> [i64; 6] {
        let [r, g, b] = self.0;
        [r as i64, (r >> 64) as i64, g as i64, (g >> 64) as i64, b as i64, (b >> 64) as i64]
    }

    fn of_words([a, b, c, d, e, f]: [i64; 6]) -> Self {
        let whole = |low: i64, high: i64| i128::from(high) << 64 | i128::from(low as u64);
        Self([whole(a, b), whole(c, d), whole(e, f)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mean_balances_close() {
        let mut totals = RepeatedTotals::default();
        for k in 0..7 {
            let q = |x: i64| Quanta([x; 3]);
            let (absorbed, blocked, escaped, unshot) = (q(k * k), q(1 + k), q(5), q(-k));
            let emitted = absorbed + blocked + escaped + unshot;
            let balance = Balance { emitted, absorbed, blocked, escaped, unshot };
            totals.add(&balance, Counts { lines: 10, ..Counts::default() }, Walked { walks: 2, power: q(k) });
        }
        let mean = totals.mean_balance(7);
        assert!(mean.closes(), "{mean:?}");
        assert_eq!((mean.absorbed.0[0], mean.escaped.0[0]), (13, 5));
        assert_eq!(
            (totals.counts().lines, totals.mean_walked(7)),
            (70, Walked { walks: 14, power: Quanta([3; 3]) })
        );
    }

    #[test]
    fn a_balance_that_does_not_close_is_not_closed_by_the_mean() {
        let mut totals = RepeatedTotals::default();
        let balance = Balance { emitted: Quanta([7; 3]), absorbed: Quanta([3; 3]), ..Balance::default() };
        totals.add(&balance, Counts::default(), Walked::default());
        assert!(!totals.mean_balance(1).closes());
    }

    #[test]
    fn sums_survive_as_words() {
        for sum in [0, -1, 1, i128::MAX, i128::MIN, -(1 << 64), (1 << 64) + 5, i128::from(i64::MIN)] {
            let sum = QuantaSum([sum, -7, 7]);
            assert_eq!(QuantaSum::of_words(sum.words()), sum);
        }
    }
}
