//! Measurements at probes in independent repeats.

use sir_geom::{Rgb, luminance};

use crate::probes::measurement::{ProbeMeasurement, QUANTITIES, Values};
use crate::repeats::MIN_REPEATS;
use crate::sensors::Spread;
use crate::visitor::{Visitor, visit_counts, visit_slice};

/// Number of bands of all quantities.
const NUMBERS: usize = 3 * QUANTITIES;

/// Number of words of the sums of a probe.
const WORDS: usize = 4 * NUMBERS + 4;

/// Measurements at the same probes in all repeats so far.
#[derive(Clone, Debug)]
pub struct RepeatedProbes {
    count: u64,
    probes: Vec<Sums>,
    /// Mean of the luminance-weighted irradiance over all directions and probes.
    mean: Spread,
}

/// Sums over repeats of one probe. The numbers are those of the bands of all quantities.
#[derive(Clone, Copy, Debug)]
struct Sums {
    spreads: [Spread; NUMBERS],
    /// Sums of squared sampling and inherited errors.
    sampling: [f64; NUMBERS],
    inherited: [f64; NUMBERS],
    direct: Rgb,
    rays: u64,
}

impl Default for Sums {
    fn default() -> Self {
        let (sampling, inherited) = ([0.0; NUMBERS], [0.0; NUMBERS]);
        Self { spreads: [Spread::default(); NUMBERS], sampling, inherited, direct: Rgb::ZERO, rays: 0 }
    }
}

fn numbers(values: &Values) -> [f64; NUMBERS] {
    std::array::from_fn(|i| values[i / 3].to_array()[i % 3])
}

fn values(numbers: [f64; NUMBERS]) -> Values {
    std::array::from_fn(|i| Rgb::new(numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]))
}

impl RepeatedProbes {
    /// Memory of a probe in a run \[bytes\]: its sums, the measurement of a repeat, and the means.
    pub const BYTES_PER_PROBE: usize = size_of::<Sums>() + 4 * size_of::<ProbeMeasurement>();

    /// Returns the sums over no repeats.
    #[must_use]
    pub fn new(probes: usize) -> Self {
        Self { count: 0, probes: vec![Sums::default(); probes], mean: Spread::default() }
    }

    /// Adds the measurements of one more repeat, in the order of the probes.
    pub fn add(&mut self, measured: &[ProbeMeasurement]) {
        self.count += 1;
        let mut sum = 0.0;
        for (sums, measurement) in self.probes.iter_mut().zip(measured) {
            let ProbeMeasurement { values, sampling, inherited, direct, rays } = measurement;
            let spreads = sums.spreads.iter_mut().zip(numbers(values));
            spreads.for_each(|(spread, value)| spread.add(value, self.count));
            for (squares, errors) in [(&mut sums.sampling, sampling), (&mut sums.inherited, inherited)] {
                let errors = squares.iter_mut().zip(numbers(errors));
                errors.for_each(|(square, error)| *square += error * error);
            }
            sums.direct += *direct;
            sums.rays += rays;
            sum += luminance(measurement.mean().irradiance);
        }
        self.mean.add(sum / measured.len().max(1) as f64, self.count);
    }

    /// Returns the means of all repeats. Their errors come from the spread of each quantity over the repeats, if there
    /// are at least [`MIN_REPEATS`]: these include all correlations between the sensors of a probe. Otherwise they come
    /// from the errors that the repeats state. An error by spread is a sampling error.
    #[must_use]
    pub fn means(&self) -> Vec<ProbeMeasurement> {
        let (count, n) = (self.count, self.count.max(1) as f64);
        let of = |sums: &Sums| {
            let stated = |squares: [f64; NUMBERS]| values(squares.map(|sum| sum.sqrt() / n));
            let differ = sums.spreads.iter().any(|spread| spread.squares > 0.0);
            // As for sensors: repeats that do not differ have all missed the same light.
            let (sampling, inherited) = match (count >= MIN_REPEATS, differ) {
                (false, _) => (stated(sums.sampling), stated(sums.inherited)),
                (true, true) => (values(sums.spreads.map(|spread| spread.error(count))), Values::default()),
                (true, false) => (stated(sums.sampling).map(|error| error / n.sqrt()), Values::default()),
            };
            ProbeMeasurement {
                values: values(sums.spreads.map(|spread| spread.mean)),
                sampling,
                inherited,
                direct: sums.direct / n,
                rays: sums.rays,
            }
        };
        self.probes.iter().map(of).collect()
    }

    /// Returns the standard error of the mean over all directions and probes of the luminance-weighted irradiance, from
    /// the spread of the repeats; `None` if they are too few.
    #[must_use]
    pub fn error_of_mean(&self) -> Option<f64> {
        (self.count >= MIN_REPEATS).then(|| self.mean.error(self.count))
    }

    /// Visits the sums.
    pub fn visit(&mut self, visitor: &mut dyn Visitor) {
        visit_counts([&mut self.count], visitor);
        let spread_words = |s: &Spread| [s.mean, s.squares].map(word);
        let mean = std::slice::from_mut(&mut self.mean);
        visit_slice(mean, visitor, spread_words, |[a, b]| Spread { mean: float(a), squares: float(b) });
        visit_slice(&mut self.probes, visitor, |sums| sums.to_words(), |words| Sums::of_words(&words));
    }
}

fn word(x: f64) -> i64 {
    x.to_bits() as i64
}

fn float(word: i64) -> f64 {
    f64::from_bits(word as u64)
}

impl Sums {
    fn to_words(self) -> [i64; WORDS] {
        let Self { spreads, sampling, inherited, direct, rays } = self;
        let spreads = spreads.iter().flat_map(|spread| [spread.mean, spread.squares]);
        let floats = spreads.chain(sampling).chain(inherited).chain(direct.to_array());
        let mut words = [0; WORDS];
        words.iter_mut().zip(floats).for_each(|(place, x)| *place = word(x));
        words[WORDS - 1] = rays as i64;
        words
    }

    fn of_words(words: &[i64; WORDS]) -> Self {
        let x = |i: usize| float(words[i]);
        Self {
            spreads: std::array::from_fn(|i| Spread { mean: x(2 * i), squares: x(2 * i + 1) }),
            sampling: std::array::from_fn(|i| x(2 * NUMBERS + i)),
            inherited: std::array::from_fn(|i| x(3 * NUMBERS + i)),
            direct: Rgb::from_array([0, 1, 2].map(|band| x(4 * NUMBERS + band))),
            rays: words[WORDS - 1] as u64,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn measurement(green: f64) -> ProbeMeasurement {
        ProbeMeasurement {
            values: [Rgb::new(0.0, green, 2.0 * green); QUANTITIES],
            sampling: [Rgb::splat(0.5); QUANTITIES],
            rays: 10,
            ..ProbeMeasurement::default()
        }
    }

    #[test]
    fn errors_come_from_the_spread_of_enough_repeats() {
        let values = [3.0, 1.0, 4.0, 1.0, 5.0, 9.0, 2.0, 6.0];
        let mut repeated = RepeatedProbes::new(1);
        values[..4].iter().for_each(|&value| repeated.add(&[measurement(value)]));
        let [few] = repeated.means()[..] else { panic!() };
        assert!((few.coefficient_errors()[3].y - 0.25).abs() < 1e-12 && repeated.error_of_mean().is_none());
        values[4..].iter().for_each(|&value| repeated.add(&[measurement(value)]));
        let mean = values.iter().sum::<f64>() / 8.0;
        let error = (values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / 56.0).sqrt();
        let [all] = repeated.means()[..] else { panic!() };
        for (value, sigma) in all.coefficients().into_iter().zip(all.coefficient_errors()) {
            assert!((value.y - mean).abs() < 1e-12 && (sigma.y - error).abs() < 1e-12);
            assert!(value.x == 0.0 && sigma.x == 0.0 && (sigma.z - 2.0 * error).abs() < 1e-12);
        }
        assert_eq!(all.rays, 80);
    }

    #[test]
    fn sums_survive_as_words() {
        let mut repeated = RepeatedProbes::new(1);
        (0..5).for_each(|i| repeated.add(&[measurement(f64::from(i))]));
        let [sums] = repeated.probes[..] else { panic!() };
        assert_eq!(Sums::of_words(&sums.to_words()).to_words(), sums.to_words());
    }
}
