//! The result of a measurement at a sensor.

use sir_geom::{Rgb, luminance};

use crate::sensors::replication::{Gathered, Replication};
use crate::sensors::unmet::Squares;
use crate::solution::in_quadrature;

/// The irradiance at a sensor.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Measurement {
    /// Irradiance per band \[W/m²\].
    pub irradiance: Rgb,
    /// Part of `irradiance` directly from lights, emitting surfaces and the sky \[W/m²\].
    pub direct: Rgb,
    /// Sampling error: standard error of `irradiance` per band \[W/m²\] due to the choice of rays, from the spread of
    /// the replications. Without a spread, it is the light of bright surfaces that no ray may have met.
    pub sampling: Rgb,
    /// Inherited error: standard error of `irradiance` per band \[W/m²\] due to the errors of the patches whose light
    /// is gathered. These are assumed to be independent of each other. Sensors that see the same patches have this
    /// error in common.
    pub inherited: Rgb,
    /// Sampling and inherited standard error of the luminance-weighted irradiance \[W/m²\].
    pub luminance_errors: [f64; 2],
    /// Number of rays over the hemispheres.
    pub rays: u64,
}

impl Measurement {
    /// Returns the measurement from the replications, the squared errors by light that no ray has met, which count if the
    /// replications are equal, and the irradiance by lights without a surface.
    pub(super) fn of(replications: &[Replication], unmet: Squares, lights: Rgb) -> Self {
        let n = replications.len() as f64;
        let mean = |value: &dyn Fn(&Replication) -> Rgb| {
            replications.iter().fold(Rgb::ZERO, |sum, replication| sum + value(replication)) / n
        };
        let all = |replication: &Replication| {
            let (direct, reflected) = replication.means();
            direct + reflected
        };
        let (direct, reflected) = (mean(&|r| r.means().0), mean(&|r| r.means().1));
        let total = direct + reflected;
        let squares = mean(&|r| (all(r) - total) * (all(r) - total));
        let square = replications.iter().map(|r| luminance(all(r) - total)).map(|y| y * y).sum::<f64>() / n;
        // Without a spread, nothing is known but what the rays have missed.
        let Squares { bands, luminance } = match square > 0.0 {
            true => Squares { bands: squares / (n - 1.0), luminance: square / (n - 1.0) },
            false => unmet,
        };
        Self {
            irradiance: total + lights,
            direct: direct + lights,
            sampling: bands.map(f64::sqrt),
            luminance_errors: [luminance.sqrt(), 0.0],
            ..Self::default()
        }
    }

    /// Adds the errors of patches, gathered by `rays` rays of each facet. The errors of all bands of a patch are assumed to have the
    /// same sign, because the same lines have brought their light.
    pub(super) fn inherit(&mut self, gathered: &[Gathered], rays: u64) {
        let (mut squares, mut square) = (Rgb::ZERO, 0.0);
        for &(weight, error) in gathered {
            let part = error * (weight / rays as f64);
            squares += part * part;
            square += luminance(part) * luminance(part);
        }
        self.inherited = squares.map(f64::sqrt);
        self.luminance_errors[1] = square.sqrt();
    }

    /// Adds an independent measurement at the same sensor, with its light times a factor per band. Variances add. The
    /// error of the luminance is dimmed as if the errors of all bands had the same sign.
    pub fn add_dimmed(&mut self, other: &Self, factor: Rgb) {
        let of_luminance = |errors: Rgb| match luminance(errors) {
            sum if sum > 0.0 => luminance(factor * errors) / sum,
            _ => luminance(factor) / luminance(Rgb::ONE),
        };
        let errors = [other.sampling, other.inherited];
        for ((sum, more), errors) in self.luminance_errors.iter_mut().zip(other.luminance_errors).zip(errors)
        {
            let more = more * of_luminance(errors);
            *sum = (*sum * *sum + more * more).sqrt();
        }
        self.irradiance += factor * other.irradiance;
        self.direct += factor * other.direct;
        self.sampling = in_quadrature(self.sampling, factor * other.sampling);
        self.inherited = in_quadrature(self.inherited, factor * other.inherited);
        self.rays += other.rays;
    }

    /// Returns the standard error of the irradiance per band \[W/m²\].
    #[must_use]
    pub fn error(&self) -> Rgb {
        (self.sampling * self.sampling + self.inherited * self.inherited).map(f64::sqrt)
    }

    /// Returns the luminance-weighted irradiance, `0.2126 R + 0.7152 G + 0.0722 B` \[W/m²\].
    #[must_use]
    pub fn luminance(&self) -> f64 {
        luminance(self.irradiance)
    }

    /// Returns the sampling error of [`luminance`](Self::luminance) \[W/m²\].
    #[must_use]
    pub fn sampling_error(&self) -> f64 {
        self.luminance_errors[0]
    }

    /// Returns the inherited error of [`luminance`](Self::luminance) \[W/m²\].
    #[must_use]
    pub fn inherited_error(&self) -> f64 {
        self.luminance_errors[1]
    }

    /// Returns the standard error of [`luminance`](Self::luminance) \[W/m²\].
    #[must_use]
    pub fn luminance_error(&self) -> f64 {
        let [sampling, inherited] = self.luminance_errors;
        (sampling * sampling + inherited * inherited).sqrt()
    }

    /// Returns all numbers as bit patterns, which are zero for the default value.
    #[must_use]
    pub fn to_bits(&self) -> [u64; 15] {
        let [a, b, c] = self.irradiance.to_array();
        let [d, e, f] = self.direct.to_array();
        let [g, h, i] = self.sampling.to_array();
        let [k, l, m] = self.inherited.to_array();
        let [n, o] = self.luminance_errors;
        let mut bits = [a, b, c, d, e, f, g, h, i, k, l, m, n, o, 0.0].map(f64::to_bits);
        bits[14] = self.rays;
        bits
    }

    /// Returns the measurement from the bit patterns of [`to_bits`](Self::to_bits).
    #[must_use]
    pub fn from_bits(bits: [u64; 15]) -> Self {
        let [a, b, c, d, e, f, g, h, i, k, l, m, n, o, _] = bits.map(f64::from_bits);
        Self {
            irradiance: Rgb::new(a, b, c),
            direct: Rgb::new(d, e, f),
            sampling: Rgb::new(g, h, i),
            inherited: Rgb::new(k, l, m),
            luminance_errors: [n, o],
            rays: bits[14],
        }
    }
}
