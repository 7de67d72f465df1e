//! Measurements at sensors in independent repeats.

use sir_geom::Rgb;

use crate::repeats::MIN_REPEATS;
use crate::sensors::measurement::Measurement;
use crate::visitor::{Visitor, visit_counts, visit_slice};

/// Measurements at the same sensors in all repeats so far.
#[derive(Clone, Debug)]
pub struct RepeatedMeasurements {
    count: u64,
    sensors: Vec<Sums>,
    /// Mean luminance-weighted irradiance over all sensors.
    mean: Spread,
}

/// Mean and squared deviations of a number.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Spread {
    pub(crate) mean: f64,
    pub(crate) squares: f64,
}

impl Spread {
    /// Adds the value with the number `count`, from 1 (Welford 1962).
    pub(crate) fn add(&mut self, value: f64, count: u64) {
        let deviation = value - self.mean;
        self.mean += deviation / count as f64;
        self.squares += deviation * (value - self.mean);
    }

    /// Returns the standard error of the mean of `count` values.
    pub(crate) fn error(self, count: u64) -> f64 {
        (self.squares / (count * (count - 1)).max(1) as f64).sqrt()
    }
}

/// Number of words of the sums of a sensor.
const WORDS: usize = 21;

/// Sums over repeats of one sensor.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    bands: [Spread; 3],
    luminance: Spread,
    /// Sum over repeats of the products of the deviations of `luminance` and of the mean over all sensors.
    with_mean: f64,
    direct: Rgb,
    /// Sums of squared sampling and inherited errors, per band and of the luminance.
    sampling: [f64; 4],
    inherited: [f64; 4],
    rays: u64,
}

/// Errors of the mean luminance-weighted irradiance over all sensors, from the spread of repeats.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SpreadOfMean {
    /// Standard error of the mean \[W/m²\].
    pub error: f64,
    /// Covariance of the irradiance at each sensor with the mean \[W²/m⁴\]; empty if it is not known.
    pub covariances: Vec<f64>,
}

impl RepeatedMeasurements {
    /// Memory of a sensor in a run \[bytes\]: its sums, the measurement of a repeat, and the means.
    pub const BYTES_PER_SENSOR: usize = size_of::<Sums>() + 4 * size_of::<Measurement>();

    /// Returns the sums over no repeats.
    #[must_use]
    pub fn new(sensors: usize) -> Self {
        Self { count: 0, sensors: vec![Sums::default(); sensors], mean: Spread::default() }
    }

    /// Adds the measurements of one more repeat, in the order of the sensors.
    pub fn add(&mut self, measured: &[Measurement]) {
        self.count += 1;
        let sum = measured.iter().fold(0.0, |sum, measurement| sum + measurement.luminance());
        let mean = sum / measured.len().max(1) as f64;
        self.mean.add(mean, self.count);
        for (sums, measurement) in self.sensors.iter_mut().zip(measured) {
            let bands = measurement.irradiance.to_array();
            sums.bands.iter_mut().zip(bands).for_each(|(band, value)| band.add(value, self.count));
            // The product of the deviations from the means before and after this repeat, as in a sum of squares.
            sums.with_mean += (measurement.luminance() - sums.luminance.mean) * (mean - self.mean.mean);
            sums.luminance.add(measurement.luminance(), self.count);
            sums.direct += measurement.direct;
            sums.rays += measurement.rays;
            let [sampling, inherited] = measurement.luminance_errors;
            let with = |bands: Rgb, luminance: f64| [bands.x, bands.y, bands.z, luminance];
            let squares = [with(measurement.sampling, sampling), with(measurement.inherited, inherited)];
            for (sums, errors) in [&mut sums.sampling, &mut sums.inherited].into_iter().zip(squares) {
                sums.iter_mut().zip(errors).for_each(|(sum, error)| *sum += error * error);
            }
        }
    }

    /// Returns the means of all repeats. Their errors come from the spread of the repeats, if there are at least
    /// [`MIN_REPEATS`]; otherwise from the errors that the repeats state. An error by spread is a sampling error.
    #[must_use]
    pub fn means(&self) -> Vec<Measurement> {
        let (count, n) = (self.count, self.count.max(1) as f64);
        let has_spread = count >= MIN_REPEATS;
        let of = |sums: &Sums| {
            let irradiance = Rgb::from_array(sums.bands.map(|band| band.mean));
            let stated = |squares: [f64; 4]| squares.map(|sum| sum.sqrt() / n);
            let spread =
                [sums.bands[0], sums.bands[1], sums.bands[2], sums.luminance].map(|s| s.error(count));
            // Repeats that do not differ have all missed the same light: together they have n times the rays, and the
            // error falls with the number of rays.
            let (sampling, inherited) = match (has_spread, sums.luminance.squares > 0.0) {
                (false, _) => (stated(sums.sampling), stated(sums.inherited)),
                (true, true) => (spread, [0.0; 4]),
                (true, false) => (stated(sums.sampling).map(|error| error / n.sqrt()), [0.0; 4]),
            };
            let bands = |[r, g, b, _]: [f64; 4]| Rgb::new(r, g, b);
            Measurement {
                irradiance,
                direct: sums.direct / n,
                sampling: bands(sampling),
                inherited: bands(inherited),
                luminance_errors: [sampling[3], inherited[3]],
                rays: sums.rays,
            }
        };
        self.sensors.iter().map(of).collect()
    }

    /// Returns the errors of the mean over all sensors, from the spread of the repeats; `None` if they are too few.
    #[must_use]
    pub fn spread_of_mean(&self) -> Option<SpreadOfMean> {
        let per_pair = 1.0 / (self.count * (self.count.max(1) - 1)).max(1) as f64;
        (self.count >= MIN_REPEATS).then(|| SpreadOfMean {
            error: self.mean.error(self.count),
            covariances: self.sensors.iter().map(|sums| sums.with_mean * per_pair).collect(),
        })
    }

    /// Visits the sums.
    pub fn visit(&mut self, visitor: &mut dyn Visitor) {
        visit_counts([&mut self.count], visitor);
        let mean = std::slice::from_mut(&mut self.mean);
        visit_slice(
            mean,
            visitor,
            |s| [s.mean, s.squares].map(word),
            |[a, b]| Spread { mean: float(a), squares: float(b) },
        );
        visit_slice(&mut self.sensors, visitor, |sums| sums.to_words(), Sums::of_words);
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
        let Self { bands: [r, g, b], luminance: y, with_mean, direct, sampling, inherited, rays } = self;
        let spreads = [r, g, b, y].map(|s| [s.mean, s.squares]);
        let floats = spreads.as_flattened().iter().copied().chain(direct.to_array());
        let floats = floats.chain(sampling).chain(inherited).chain([with_mean]);
        let mut words = [0; WORDS];
        words.iter_mut().zip(floats).for_each(|(place, x)| *place = word(x));
        words[WORDS - 1] = rays as i64;
        words
    }

    fn of_words(words: [i64; WORDS]) -> Self {
        let x = |i: usize| float(words[i]);
        let spread = |i: usize| Spread { mean: x(i), squares: x(i + 1) };
        Self {
            bands: [0, 2, 4].map(spread),
            luminance: spread(6),
            direct: Rgb::new(x(8), x(9), x(10)),
            sampling: [11, 12, 13, 14].map(x),
            inherited: [15, 16, 17, 18].map(x),
            with_mean: x(19),
            rays: words[WORDS - 1] as u64,
        }
    }
}

#[cfg(test)]
mod tests {
    use sir_geom::luminance;

    use super::*;

    fn measurement(green: f64, error: f64) -> Measurement {
        let irradiance = Rgb::new(0.0, green, 0.0);
        Measurement {
            irradiance,
            sampling: Rgb::splat(error),
            luminance_errors: [error, 2.0 * error],
            rays: 10,
            ..Measurement::default()
        }
    }

    #[test]
    fn errors_come_from_the_spread_of_enough_repeats() {
        let values = [3.0, 1.0, 4.0, 1.0, 5.0, 9.0, 2.0, 6.0];
        let mut repeated = RepeatedMeasurements::new(1);
        for value in values {
            repeated.add(&[measurement(value, 0.5)]);
        }
        let mean = values.iter().sum::<f64>() / 8.0;
        let error = (values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / 56.0).sqrt();
        let [all] = repeated.means()[..] else { panic!() };
        assert!((all.irradiance.y - mean).abs() < 1e-12 && (all.error().y - error).abs() < 1e-12);
        assert!((all.luminance_error() / luminance(Rgb::new(0.0, error, 0.0)) - 1.0).abs() < 1e-9);
        let spread = repeated.spread_of_mean().unwrap();
        assert_eq!((all.rays, spread.error), (80, all.luminance_error()));
        // A single sensor is the mean.
        assert!((spread.covariances[0].sqrt() / spread.error - 1.0).abs() < 1e-12);
    }

    #[test]
    fn covariances_are_those_with_the_mean_over_all_sensors() {
        let all =
            [[3.0, 1.0], [1.0, 5.0], [4.0, 9.0], [1.0, 2.0], [5.0, 6.0], [9.0, 5.0], [2.0, 3.0], [6.0, 5.0]];
        let mut repeated = RepeatedMeasurements::new(2);
        all.iter().for_each(|values| repeated.add(&values.map(|value| measurement(value / 0.7152, 0.5))));
        let means: Vec<f64> = all.iter().map(|[a, b]| 0.5 * (a + b)).collect();
        let mean = |values: &[f64]| values.iter().sum::<f64>() / 8.0;
        for (sensor, covariance) in repeated.spread_of_mean().unwrap().covariances.into_iter().enumerate() {
            let values: Vec<f64> = all.iter().map(|values| values[sensor]).collect();
            let products = values.iter().zip(&means).map(|(x, y)| (x - mean(&values)) * (y - mean(&means)));
            assert!((covariance - products.sum::<f64>() / 56.0).abs() < 1e-12, "{sensor}: {covariance}");
        }
    }

    #[test]
    fn errors_of_few_repeats_are_those_that_they_state() {
        let mut repeated = RepeatedMeasurements::new(1);
        (0..4).for_each(|_| repeated.add(&[measurement(2.0, 0.5)]));
        let [all] = repeated.means()[..] else { panic!() };
        assert!((all.sampling.y - 0.25).abs() < 1e-12 && (all.inherited_error() - 0.5).abs() < 1e-12);
        assert_eq!(repeated.spread_of_mean(), None);
    }

    #[test]
    fn repeats_that_miss_everything_have_the_error_of_all_rays() {
        let mut repeated = RepeatedMeasurements::new(1);
        (0..16).for_each(|_| repeated.add(&[measurement(0.0, 0.16)]));
        assert!((repeated.means()[0].sampling_error() - 0.01).abs() < 1e-12);
    }

    #[test]
    fn sums_survive_as_words() {
        let mut repeated = RepeatedMeasurements::new(1);
        (0..5).for_each(|i| repeated.add(&[measurement(f64::from(i), 0.1)]));
        let [sums] = repeated.sensors[..] else { panic!() };
        assert_eq!(Sums::of_words(sums.to_words()).to_words(), sums.to_words());
    }
}
