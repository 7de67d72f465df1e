//! The result of a measurement at a probe.

use std::f64::consts::PI;

use sir_geom::{Rgb, luminance};

use crate::probes::harmonics::HARMONICS;
use crate::sensors::Measurement;
use crate::solution::in_quadrature;

/// Number of quantities that a probe measures: the coefficients, and the irradiances along the axes.
pub(super) const QUANTITIES: usize = HARMONICS + 6;

/// Number of words of a measurement.
pub(super) const WORDS: usize = 9 * QUANTITIES + 4;

/// Values of all quantities of a probe.
pub(super) type Values = [Rgb; QUANTITIES];

/// The irradiance at a probe as a function of the normal of the receiver. All values are \[W/m²\] per band.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ProbeMeasurement {
    /// Coefficients and irradiances along the axes.
    pub(super) values: Values,
    /// Sampling errors of `values`: standard errors due to the choice of rays, from the spread of the replications or
    /// repeats.
    pub(super) sampling: Values,
    /// Inherited errors of `values`, due to the errors of the patches whose light is gathered, which are assumed to be
    /// independent.
    pub(super) inherited: Values,
    /// Part of the mean irradiance over all directions that comes directly from lights, emitting surfaces and the sky.
    pub direct: Rgb,
    /// Number of rays over the hemispheres of the six sensors.
    pub rays: u64,
}

impl ProbeMeasurement {
    /// Number of words of [`to_words`](Self::to_words).
    pub const WORDS: usize = WORDS;

    /// Returns the coefficients of the irradiance in [`harmonics`](crate::harmonics): `E(n) = Σ c_i Y_i(n)`.
    #[must_use]
    pub fn coefficients(&self) -> [Rgb; HARMONICS] {
        std::array::from_fn(|i| self.values[i])
    }

    /// Returns the standard errors of the coefficients. Errors of different coefficients may be correlated.
    #[must_use]
    pub fn coefficient_errors(&self) -> [Rgb; HARMONICS] {
        std::array::from_fn(|i| self.error(i))
    }

    /// Returns the irradiances of surfaces with the normals +x, −x, +y, −y, +z and −z: an ambient cube. These contain
    /// all degrees of harmonics.
    #[must_use]
    pub fn axes(&self) -> [Rgb; 6] {
        std::array::from_fn(|k| self.values[HARMONICS + k])
    }

    /// Returns the standard errors of the irradiances along the axes.
    #[must_use]
    pub fn axis_errors(&self) -> [Rgb; 6] {
        std::array::from_fn(|k| self.error(HARMONICS + k))
    }

    fn error(&self, quantity: usize) -> Rgb {
        let [sampling, inherited] = [self.sampling[quantity], self.inherited[quantity]];
        (sampling * sampling + inherited * inherited).map(f64::sqrt)
    }

    /// Returns the mean irradiance over all directions. Its luminance errors are the sums of the errors of the bands, an
    /// upper bound.
    #[must_use]
    pub fn mean(&self) -> Measurement {
        // The mean of a sum of harmonics is its first coefficient times Y_0.
        let of = |values: &Values| values[0] / (4.0 * PI).sqrt();
        let [irradiance, sampling, inherited] = [&self.values, &self.sampling, &self.inherited].map(of);
        Measurement {
            irradiance,
            direct: self.direct,
            sampling,
            inherited,
            luminance_errors: [luminance(sampling), luminance(inherited)],
            rays: self.rays,
        }
    }

    /// Returns the root mean square, over all directions, of the sampling error of the irradiance: the harmonics are
    /// orthonormal, so the squared errors of the coefficients add up to `4π` times its square. The errors of the bands
    /// are added, which gives an upper bound.
    pub(super) fn sampling_error(&self) -> f64 {
        let squares = self.sampling[..HARMONICS].iter().map(|error| luminance(*error) * luminance(*error));
        (squares.sum::<f64>() / (4.0 * PI)).sqrt()
    }

    /// Adds an independent measurement at the same probe, with its light times a factor per band. Variances add.
    pub fn add_dimmed(&mut self, other: &Self, factor: Rgb) {
        for i in 0..QUANTITIES {
            self.values[i] += factor * other.values[i];
            self.sampling[i] = in_quadrature(self.sampling[i], factor * other.sampling[i]);
            self.inherited[i] = in_quadrature(self.inherited[i], factor * other.inherited[i]);
        }
        self.direct += factor * other.direct;
        self.rays += other.rays;
    }

    /// Returns all numbers as bit patterns, which are zero for the default value.
    #[must_use]
    pub fn to_words(self) -> [u64; Self::WORDS] {
        let Self { values, sampling, inherited, direct, rays } = self;
        let all = [values, sampling, inherited];
        let floats = all.as_flattened().iter().chain([&direct]).flat_map(|value| value.to_array());
        let mut words = [0; WORDS];
        words.iter_mut().zip(floats).for_each(|(word, float)| *word = float.to_bits());
        words[WORDS - 1] = rays;
        words
    }

    /// Returns the measurement from the words of [`to_words`](Self::to_words).
    #[must_use]
    pub fn from_words(words: &[u64; Self::WORDS]) -> Self {
        let value = |i: usize| Rgb::from_array([0, 1, 2].map(|band| f64::from_bits(words[3 * i + band])));
        let values = |first: usize| std::array::from_fn(|i| value(first + i));
        Self {
            values: values(0),
            sampling: values(QUANTITIES),
            inherited: values(2 * QUANTITIES),
            direct: value(3 * QUANTITIES),
            rays: words[WORDS - 1],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn measurements_survive_as_words() {
        let value = |i: usize| Rgb::new(i as f64, 0.5 * i as f64, -(i as f64));
        let measurement = ProbeMeasurement {
            values: std::array::from_fn(value),
            sampling: std::array::from_fn(|i| value(100 + i)),
            inherited: std::array::from_fn(|i| value(200 + i)),
            direct: value(300),
            rays: 7,
        };
        assert_eq!(ProbeMeasurement::from_words(&measurement.to_words()), measurement);
        assert_eq!(ProbeMeasurement::default().to_words(), [0; WORDS]);
    }
}
