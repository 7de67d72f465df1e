//! Summary of the measurements of sensors.

use serde::{Deserialize, Serialize};
use sir_radiosity::Measurement;

use crate::units::Units;

/// Summary of the measurements of sensors. All irradiances are weighted for luminance; those of probes are means over
/// all directions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SensorsReport {
    /// Name of the sensors.
    pub name: String,
    /// Number of sensors, or of valid probes.
    pub points: usize,
    /// Number of invalid probes; `None` for sensors.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub invalid: Option<usize>,
    /// Number of rays over the hemispheres of all sensors. The same number was aimed at emitting surfaces, if there are
    /// any.
    pub rays: u64,
    /// Mean irradiance \[W/m²\].
    pub mean: f64,
    /// Standard error of the mean \[W/m²\], from the spread of repeats; otherwise it combines the sampling errors, which
    /// are independent between sensors, and the errors of patches, which are assumed to be the same for all sensors.
    pub mean_error: f64,
    /// Smallest irradiance \[W/m²\].
    pub minimum: f64,
    /// Largest irradiance \[W/m²\].
    pub maximum: f64,
    /// Ratio of smallest to mean irradiance, the *uniformity* of EN 12464-1; zero in the dark.
    pub uniformity: f64,
}

impl SensorsReport {
    /// Creates the report. `mean_error` is the error of the mean, if it is known from the spread of repeats.
    pub(crate) fn new(name: &str, measured: &[Measurement], mean_error: Option<f64>) -> Self {
        let n = measured.len().max(1) as f64;
        let values = || measured.iter().map(Measurement::luminance);
        let mean = values().sum::<f64>() / n;
        let squares = measured.iter().map(|m| m.sampling_error() * m.sampling_error()).sum::<f64>();
        let inherited = measured.iter().map(Measurement::inherited_error).sum::<f64>() / n;
        let minimum = values().fold(f64::INFINITY, f64::min);
        Self {
            name: name.into(),
            points: measured.len(),
            invalid: None,
            rays: measured.iter().map(|m| m.rays).sum(),
            mean,
            mean_error: mean_error.unwrap_or_else(|| (squares / (n * n) + inherited * inherited).sqrt()),
            minimum,
            maximum: values().fold(f64::NEG_INFINITY, f64::max),
            uniformity: if mean > 0.0 { minimum / mean } else { 0.0 },
        }
    }

    /// Returns the numbers in one line.
    #[must_use]
    pub fn in_short(&self, units: Units) -> String {
        let Self { mean, mean_error, minimum, maximum, uniformity, .. } = *self;
        let decimals = decimals(mean_error);
        let mut text = format!(
            "mean {mean:.decimals$} ± {mean_error:.decimals$} {}, minimum {}, maximum {}",
            units.irradiance(),
            significant(minimum),
            significant(maximum),
        );
        // Standards define uniformity on a plane, not for probes.
        if self.invalid.is_none() {
            // They state two decimals; a small value would round to zero.
            text += &if uniformity < 0.1 {
                format!(", U0 = {uniformity:.1e}")
            } else {
                format!(", U0 = {uniformity:.2}")
            };
        }
        text
    }
}

/// Returns the number of decimals that shows two digits of an error.
fn decimals(error: f64) -> usize {
    if error > 0.0 { (1.0 - error.log10().floor()).clamp(0.0, 9.0) as usize } else { 3 }
}

/// Formats a number with four significant digits.
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
        let report = SensorsReport::new("desk", &measured, None);
        assert!((report.mean - 2.0).abs() < 1e-12 && (report.uniformity - 0.5).abs() < 1e-12);
        assert!((report.mean_error - (0.09f64 / 2.0 + 0.16).sqrt()).abs() < 1e-12);
        assert_eq!((report.points, report.rays), (2, 128));
    }
}
