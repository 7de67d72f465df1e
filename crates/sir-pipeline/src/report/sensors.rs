//! What sensors have measured, in short.

use serde::{Deserialize, Serialize};
use sir_radiosity::Measurement;

use crate::units::Units;

/// What sensors have measured, in short.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SensorsReport {
    /// What they are called.
    pub name: String,
    /// How many there are.
    pub points: usize,
    /// Rays over the hemispheres of all of them. As many have been aimed at emitting surfaces, if there are any.
    pub rays: u64,
    /// Mean irradiance, weighted for luminance as all numbers here \[W/m²\].
    pub mean: f64,
    /// Standard error of the mean \[W/m²\]: by the choice of rays, independent from sensor to sensor, and by the errors of patches, which
    /// are taken to be the same for all.
    pub mean_error: f64,
    /// The smallest irradiance \[W/m²\].
    pub minimum: f64,
    /// The largest irradiance \[W/m²\].
    pub maximum: f64,
    /// Smallest over mean irradiance, the *uniformity* of EN 12464-1; zero in the dark.
    pub uniformity: f64,
}

impl SensorsReport {
    pub(crate) fn new(name: &str, measured: &[Measurement]) -> Self {
        let n = measured.len().max(1) as f64;
        let values = || measured.iter().map(Measurement::luminance);
        let mean = values().sum::<f64>() / n;
        let squares = measured.iter().map(|m| m.sampling_error() * m.sampling_error()).sum::<f64>();
        let inherited = measured.iter().map(Measurement::inherited_error).sum::<f64>() / n;
        let minimum = values().fold(f64::INFINITY, f64::min);
        Self {
            name: name.into(),
            points: measured.len(),
            rays: measured.iter().map(|m| m.rays).sum(),
            mean,
            mean_error: (squares / (n * n) + inherited * inherited).sqrt(),
            minimum,
            maximum: values().fold(f64::NEG_INFINITY, f64::max),
            uniformity: if mean > 0.0 { minimum / mean } else { 0.0 },
        }
    }

    /// The numbers in a line.
    #[must_use]
    pub fn in_short(&self, units: Units) -> String {
        let Self { mean, mean_error, minimum, maximum, uniformity, .. } = *self;
        let decimals = decimals(mean_error);
        format!(
            "mean {mean:.decimals$} ± {mean_error:.decimals$} {}, minimum {}, maximum {}, U0 = {}",
            units.irradiance(),
            significant(minimum),
            significant(maximum),
            // Standards have two decimals; a small one is not nothing.
            if uniformity < 0.1 { format!("{uniformity:.1e}") } else { format!("{uniformity:.2}") },
        )
    }
}

/// Decimals that show two digits of an error.
fn decimals(error: f64) -> usize {
    if error > 0.0 { (1.0 - error.log10().floor()).clamp(0.0, 9.0) as usize } else { 3 }
}

/// A number with four digits.
fn significant(x: f64) -> String {
    let before = if x == 0.0 { 0.0 } else { x.abs().log10().floor() };
    format!("{x:.0$}", (3.0 - before).clamp(0.0, 9.0) as usize)
}

#[cfg(test)]
mod tests {
    use super::*;
    use sir_geom::Rgb;

    #[test]
    fn a_report_sums_up() {
        let measured = [1.0, 3.0].map(|e| Measurement {
            irradiance: Rgb::splat(e),
            luminance_errors: [0.3, 0.4],
            rays: 64,
            ..Measurement::default()
        });
        let report = SensorsReport::new("desk", &measured);
        assert!((report.mean - 2.0).abs() < 1e-12 && (report.uniformity - 0.5).abs() < 1e-12);
        assert!((report.mean_error - (0.09f64 / 2.0 + 0.16).sqrt()).abs() < 1e-12);
        assert_eq!((report.points, report.rays), (2, 128));
    }
}
