//! Independent repeats of the same stages: their mean, and standard errors from their spread.
//!
//! A run of few lines is unbiased, so the mean of `k` runs with independent random numbers is, too. Its variance can be
//! estimated without any assumption about a single run: `Σ(x − mean)²/(k (k − 1))`. It includes what the errors of a
//! single run leave out, such as noise that a patch inherits from its neighbors.
//!
//! The spread of few runs is itself uncertain. For `k` runs, the deviation from the truth over the standard error
//! follows Student's t distribution with `k − 1` degrees of freedom. With fewer than [`MIN_REPEATS`], the variance is
//! therefore the mean of the variances that the runs state, over `k`.

use std::ops::AddAssign;

use crate::power::Quanta;
use crate::received::Received;
use crate::totals::{Balance, Counts};
use crate::visitor::Visitor;
use crate::visitor::{from_word, to_word, visit_counts, visit_slice};

/// Smallest number of repeats for which errors are computed from their spread.
pub const MIN_REPEATS: u64 = 8;

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

/// Power received by the sides of patches in all repeats so far.
#[derive(Clone, Debug)]
pub struct Repeats {
    count: u64,
    sides: Vec<Sums>,
}

/// Sums over repeats of one side.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    power: QuantaSum,
    /// Sum of the squared deviations from the mean \[quanta²\].
    squares: [f64; 3],
    /// Sum of the variances that the repeats state \[quanta²\].
    stated: [f32; 3],
}

impl Repeats {
    /// Memory per side \[bytes\].
    pub const BYTES_PER_SIDE: usize = size_of::<Sums>();

    /// Returns the sums over no repeats, for runs with this number of sides.
    #[must_use]
    pub fn new(sides: usize) -> Self {
        Self { count: 0, sides: vec![Sums::default(); sides] }
    }

    /// Returns the number of repeats so far.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.count
    }

    /// True if the errors are computed from the spread of the repeats, and not from the errors that each of them
    /// states.
    #[must_use]
    pub fn have_spread(&self) -> bool {
        self.count >= MIN_REPEATS
    }

    /// Adds a repeat. Repeats must be added in the order of their numbers: sums of power are the same in any order, but
    /// squared deviations are rounded.
    pub fn add(&mut self, received: &Received) {
        let n = self.count;
        for (sums, (power, variance)) in
            self.sides.iter_mut().zip(received.power.iter().zip(&received.variance))
        {
            if n > 0 {
                // Welford (1962). The deviation from the previous mean is computed in integers, so there is no
                // cancellation.
                let weight = n as f64 / (n + 1) as f64;
                for ((square, sum), power) in sums.squares.iter_mut().zip(sums.power.0).zip(power.0) {
                    let deviation = (i128::from(power) * i128::from(n) - sum) as f64 / n as f64;
                    *square += deviation * deviation * weight;
                }
            }
            sums.power += *power;
            sums.stated.iter_mut().zip(variance).for_each(|(sum, variance)| *sum += variance);
        }
        self.count += 1;
    }

    /// Returns the mean of all repeats, to the nearest quantum, with the variance of the mean. The mean of a single
    /// repeat is that repeat.
    #[must_use]
    pub fn mean(&self) -> Received {
        let k = self.count.max(1);
        let (pairs, squared) = ((k * (k - 1)) as f64, (k * k) as f64);
        let variance = |sums: &Sums| match self.have_spread() {
            true => sums.squares.map(|sum| (sum / pairs) as f32),
            false => sums.stated.map(|sum| (f64::from(sum) / squared) as f32),
        };
        Received {
            power: self.sides.iter().map(|sums| sums.power.mean(k)).collect(),
            variance: self.sides.iter().map(variance).collect(),
        }
    }

    /// Visits the sums.
    pub fn visit(&mut self, visitor: &mut dyn Visitor) {
        visit_counts([&mut self.count], visitor);
        visit_slice(
            &mut self.sides,
            visitor,
            |sums| {
                let [a, b, c, d, e, f] = sums.power.words();
                let [g, h, i] = sums.squares.map(|square| square.to_bits() as i64);
                let [j, k, l] = sums.stated.map(to_word);
                [a, b, c, d, e, f, g, h, i, j, k, l]
            },
            |[a, b, c, d, e, f, g, h, i, j, k, l]| Sums {
                power: QuantaSum::of_words([a, b, c, d, e, f]),
                squares: [g, h, i].map(|square| f64::from_bits(square as u64)),
                stated: [j, k, l].map(from_word),
            },
        );
    }
}

/// Counts and energy balance of one stage, summed over all repeats so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RepeatedTotals {
    counts: Counts,
    /// Emitted, absorbed, blocked, escaped, unshot.
    balance: [QuantaSum; 5],
    extrapolated: QuantaSum,
}

impl RepeatedTotals {
    /// Adds the totals of one more repeat.
    pub fn add(&mut self, balance: &Balance, counts: Counts, extrapolated: Quanta) {
        let Balance { emitted, absorbed, blocked, escaped, unshot } = *balance;
        let powers = [emitted, absorbed, blocked, escaped, unshot];
        self.balance.iter_mut().zip(powers).for_each(|(sum, power)| *sum += power);
        self.counts += counts;
        self.extrapolated += extrapolated;
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

    /// Returns the mean extrapolated power of `count` repeats.
    #[must_use]
    pub fn mean_extrapolated(&self, count: u64) -> Quanta {
        self.extrapolated.mean(count)
    }

    /// Visits the sums.
    pub fn visit(&mut self, visitor: &mut dyn Visitor) {
        let Counts { lines, empty, odd, crossings } = &mut self.counts;
        visit_counts([lines, empty, odd, crossings], visitor);
        visit_slice(&mut self.balance, visitor, |sum| sum.words(), QuantaSum::of_words);
        visit_slice(
            std::slice::from_mut(&mut self.extrapolated),
            visitor,
            |sum| sum.words(),
            QuantaSum::of_words,
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn received(power: i64, variance: f32) -> Received {
        Received { power: vec![Quanta([power, -power, 0])], variance: vec![[variance; 3]] }
    }

    #[test]
    fn the_mean_of_one_is_that_one() {
        let mut repeats = Repeats::new(1);
        let one = received(i64::MAX, 0.1);
        repeats.add(&one);
        assert_eq!(repeats.mean(), one);
    }

    #[test]
    fn means_are_rounded_to_the_nearest_and_sums_do_not_overflow() {
        let mut repeats = Repeats::new(1);
        for power in [i64::MAX, i64::MAX, i64::MAX - 2] {
            repeats.add(&received(power, 3.0));
        }
        let mean = repeats.mean();
        assert_eq!(mean.power[0], Quanta([i64::MAX - 1, 1 - i64::MAX, 0]));
        assert_eq!(mean.variance[0], [1.0; 3], "of three, the mean of what they state over three");
    }

    #[test]
    fn the_spread_is_that_of_the_textbook() {
        // Small deviations of large numbers, which must not cancel.
        let far = 1_i64 << 60;
        let deviations = [3, -1, 4, -1, 5, -9, 2, -6, 5, 3];
        let mut repeats = Repeats::new(1);
        deviations.iter().for_each(|d| repeats.add(&received(far + d, 1e9)));
        let n = deviations.len() as f64;
        let mean = deviations.iter().sum::<i64>() as f64 / n;
        let squares: f64 = deviations.iter().map(|&d| (d as f64 - mean) * (d as f64 - mean)).sum();
        let expected = squares / (n * (n - 1.0));
        let [r, g, b] = repeats.mean().variance[0].map(f64::from);
        assert!((r / expected - 1.0).abs() < 1e-6 && (g / expected - 1.0).abs() < 1e-6, "{r} {g} {expected}");
        assert_eq!(b, 0.0);
    }

    #[test]
    fn mean_balances_close() {
        let mut totals = RepeatedTotals::default();
        for k in 0..7 {
            let q = |x: i64| Quanta([x; 3]);
            let (absorbed, blocked, escaped, unshot) = (q(k * k), q(1 + k), q(5), q(-k));
            let emitted = absorbed + blocked + escaped + unshot;
            let balance = Balance { emitted, absorbed, blocked, escaped, unshot };
            totals.add(&balance, Counts { lines: 10, ..Counts::default() }, q(k));
        }
        let mean = totals.mean_balance(7);
        assert!(mean.closes(), "{mean:?}");
        assert_eq!((mean.absorbed.0[0], mean.escaped.0[0]), (13, 5));
        assert_eq!((totals.counts().lines, totals.mean_extrapolated(7)), (70, Quanta([3; 3])));
    }

    #[test]
    fn a_balance_that_does_not_close_is_not_closed_by_the_mean() {
        let mut totals = RepeatedTotals::default();
        let balance = Balance { emitted: Quanta([7; 3]), absorbed: Quanta([3; 3]), ..Balance::default() };
        totals.add(&balance, Counts::default(), Quanta::ZERO);
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
