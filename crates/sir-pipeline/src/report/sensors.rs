//! Summary of the measurements of sensors.

use serde::{Deserialize, Serialize};
use sir_radiosity::{Measurement, SpreadOfMean};

use crate::plan::{Require, Sensors};
use crate::report::glare::GlareReport;
use crate::report::requirements::RequirementReport;
use crate::report::uncertain::Uncertain;
use crate::units::Units;

/// Summary of the measurements of sensors. All irradiances are weighted for luminance; those of probes are means over
/// all directions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SensorsReport {
    /// Name of the sensors.
    pub name: String,
    /// Adjective before *irradiance*, such as `cylindrical`; `None` for that of planes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kind: Option<String>,
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
    /// Smallest irradiance \[W/m²\]. The smallest of several noisy numbers is on average below the smallest true number.
    pub minimum: f64,
    /// Standard error of the irradiance at the sensor with the smallest one \[W/m²\].
    #[serde(default)]
    pub minimum_error: f64,
    /// Largest irradiance \[W/m²\]; on average above the largest true number.
    pub maximum: f64,
    /// Standard error of the irradiance at the sensor with the largest one \[W/m²\].
    #[serde(default)]
    pub maximum_error: f64,
    /// Ratio of smallest to mean irradiance, the *uniformity* U₀ of EN 12464-1; zero in the dark.
    pub uniformity: f64,
    /// Standard error of `uniformity`.
    #[serde(default)]
    pub uniformity_error: f64,
    /// Ratio of smallest to largest irradiance, the *diversity* U_d of EN 12665; zero in the dark.
    #[serde(default)]
    pub diversity: f64,
    /// Standard error of `diversity`.
    #[serde(default)]
    pub diversity_error: f64,
    /// Daylight factors, if the sensors have them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub daylight: Option<DaylightReport>,
    /// Glare, if it was measured.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub glare: Option<GlareReport>,
    /// Electric power of all luminaires over the area of the room \[W/m²\], if both are known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub power_density: Option<f64>,
    /// Requirements, with what was measured.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub requirements: Vec<RequirementReport>,
}

/// Summary of daylight factors: irradiances in per cent of that of an unobstructed horizontal surface under the same sky.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct DaylightReport {
    /// Irradiance of the unobstructed horizontal surface \[W/m²\], without an error.
    pub outdoor: f64,
    /// Mean \[%\].
    pub mean: f64,
    /// Standard error of the mean \[%\].
    pub mean_error: f64,
    /// Smallest daylight factor \[%\].
    pub minimum: f64,
    /// Standard error of the smallest daylight factor \[%\].
    pub minimum_error: f64,
    /// Largest daylight factor \[%\].
    pub maximum: f64,
    /// Standard error of the largest daylight factor \[%\].
    pub maximum_error: f64,
}

impl SensorsReport {
    /// Creates the report of a stage `Sensors`. `spread` has the errors of the mean, if they are known from the spread of
    /// repeats, `outdoor` the irradiance to which daylight factors refer \[W/m²\], and `ratings` the glare, if it was measured.
    pub(crate) fn of(
        sensors: &Sensors,
        measured: &[Measurement],
        spread: Option<&SpreadOfMean>,
        outdoor: Option<f64>,
        ratings: Option<&[Option<Uncertain>]>,
    ) -> Self {
        let kind = sensors.measure.adjective().map(String::from);
        let report = Self { kind, ..Self::new(&sensors.name, measured, spread) };
        let daylight = outdoor.filter(|_| sensors.daylight_factor).map(|outdoor| report.daylight(outdoor));
        let report = Self { daylight, glare: ratings.map(GlareReport::of), ..report };
        let requirements = sensors.require.as_ref().map(|require| report.compare(require));
        Self { requirements: requirements.unwrap_or_default(), ..report }
    }

    /// Creates the report of measurements of irradiance.
    fn new(name: &str, measured: &[Measurement], spread: Option<&SpreadOfMean>) -> Self {
        let n = measured.len().max(1) as f64;
        let values = || measured.iter().map(Measurement::luminance).enumerate();
        let mean = values().map(|(_, value)| value).sum::<f64>() / n;
        let squares = measured.iter().map(|m| m.sampling_error() * m.sampling_error()).sum::<f64>();
        let inherited = measured.iter().map(Measurement::inherited_error).sum::<f64>() / n;
        let stated = || libm::sqrt(squares / (n * n) + inherited * inherited);
        let mean_error = spread.map_or_else(stated, |spread| spread.error);
        let (lowest, minimum) = values().min_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or_default();
        let (highest, maximum) = values().max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or_default();
        let error = |sensor: usize| measured.get(sensor).map_or(0.0, Measurement::luminance_error);
        let inherited_error = |sensor: usize| measured.get(sensor).map_or(0.0, Measurement::inherited_error);
        let sampling = measured.get(lowest).map_or(0.0, Measurement::sampling_error);
        // The sensor makes a part of the mean, and has errors of patches in common with it.
        let stated = sampling * sampling / n + inherited_error(lowest) * inherited;
        let with_mean = spread.and_then(|s| s.covariances.get(lowest).copied()).unwrap_or(stated);
        let with_maximum = if lowest == highest {
            error(lowest) * error(lowest)
        } else {
            inherited_error(lowest) * inherited_error(highest)
        };
        let minimum = Uncertain { value: minimum, error: error(lowest) };
        let maximum = Uncertain { value: maximum, error: error(highest) };
        let uniformity = minimum.over(Uncertain { value: mean, error: mean_error }, with_mean);
        let diversity = minimum.over(maximum, with_maximum);
        // The ratios of a single sensor have no error; rounding would leave some.
        let exact =
            |ratio: Uncertain| if measured.len() == 1 { Uncertain { error: 0.0, ..ratio } } else { ratio };
        let [uniformity, diversity] = [uniformity, diversity].map(exact);
        Self {
            name: name.into(),
            kind: None,
            points: measured.len(),
            invalid: None,
            rays: measured.iter().map(|m| m.rays).sum(),
            mean,
            mean_error,
            minimum: minimum.value,
            minimum_error: minimum.error,
            maximum: maximum.value,
            maximum_error: maximum.error,
            uniformity: uniformity.value,
            uniformity_error: uniformity.error,
            diversity: diversity.value,
            diversity_error: diversity.error,
            daylight: None,
            glare: None,
            power_density: None,
            requirements: Vec::new(),
        }
    }

    fn daylight(&self, outdoor: f64) -> DaylightReport {
        let percent = 100.0 / outdoor;
        DaylightReport {
            outdoor,
            mean: percent * self.mean,
            mean_error: percent * self.mean_error,
            minimum: percent * self.minimum,
            minimum_error: percent * self.minimum_error,
            maximum: percent * self.maximum,
            maximum_error: percent * self.maximum_error,
        }
    }

    fn compare(&self, require: &Require) -> Vec<RequirementReport> {
        let measured = [
            (self.mean, self.mean_error),
            (self.minimum, self.minimum_error),
            (self.uniformity, self.uniformity_error),
            (self.diversity, self.diversity_error),
            self.daylight.map_or((0.0, 0.0), |daylight| (daylight.mean, daylight.mean_error)),
            self.glare.map_or((0.0, 0.0), |glare| (glare.worst().value, glare.worst().error)),
        ];
        RequirementReport::all(require, measured.map(|(value, error)| Uncertain { value, error }))
    }

    /// Returns the name of what is measured, such as `cylindrical illuminance`.
    #[must_use]
    pub fn quantity(&self, units: Units) -> String {
        let kind = self.kind.as_ref().map_or(String::new(), |kind| format!("{kind} "));
        kind + units.irradiance_name()
    }

    /// Returns the numbers in one line.
    #[must_use]
    pub fn in_short(&self, units: Units) -> String {
        let shown = |value, error| Uncertain { value, error };
        let mut text = match self.kind {
            Some(_) => format!("{}: ", self.quantity(units)),
            None => String::new(),
        };
        text += &format!(
            "mean {} {}, minimum {}, maximum {}",
            shown(self.mean, self.mean_error),
            units.irradiance(),
            shown(self.minimum, self.minimum_error),
            shown(self.maximum, self.maximum_error),
        );
        // Standards define uniformity on a plane, not for probes.
        if self.invalid.is_none() {
            text += &format!(", U0 = {}", shown(self.uniformity, self.uniformity_error));
            text += &format!(", Ud = {}", shown(self.diversity, self.diversity_error));
        }
        if let Some(daylight) = self.daylight {
            text += &format!(", daylight factor: {}", daylight.in_short());
        }
        if let Some(glare) = self.glare {
            text += &format!(", {}", glare.in_short());
        }
        if let Some(density) = self.power_density {
            text += &format!(", {density:.1} W/m² of installed electric power");
        }
        text
    }
}

impl DaylightReport {
    /// Returns the numbers in one line.
    #[must_use]
    pub fn in_short(&self) -> String {
        let shown = |value, error| Uncertain { value, error };
        format!(
            "mean {} %, minimum {}, maximum {}",
            shown(self.mean, self.mean_error),
            shown(self.minimum, self.minimum_error),
            shown(self.maximum, self.maximum_error),
        )
    }
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
        assert!((report.minimum_error - 0.5).abs() < 1e-12 && (report.maximum_error - 0.5).abs() < 1e-12);
        // Sampling errors are independent, inherited ones are the same for all: E_1/M and E_1/E_2.
        // To first order the ratio is E_1 (1 - 1/4)/2 - E_2/8, and the common error changes it by 0.4 (1 - 1/2)/2.
        let expected = (0.75 * 0.3 / 2.0f64).hypot(0.25 * 0.3 / 2.0).hypot(0.4 * 0.5 / 2.0);
        assert!((report.uniformity_error - expected).abs() < 1e-12, "{}", report.uniformity_error);
        let expected = (0.3 / 3.0f64).hypot(0.3 / 9.0).hypot(0.4 / 3.0 - 0.4 / 9.0);
        assert!((report.diversity - 1.0 / 3.0).abs() < 1e-12);
        assert!((report.diversity_error - expected).abs() < 1e-12, "{}", report.diversity_error);
    }

    #[test]
    fn a_single_sensor_is_uniform_without_an_error() {
        let measured = [Measurement {
            irradiance: Rgb::splat(2.0),
            luminance_errors: [0.3, 0.4],
            ..Measurement::default()
        }];
        let report = SensorsReport::new("point", &measured, None);
        assert!((report.uniformity - 1.0).abs() < 1e-12 && (report.diversity - 1.0).abs() < 1e-12);
        assert_eq!((report.uniformity_error, report.diversity_error), (0.0, 0.0));
        let dark = SensorsReport::new("dark", &[Measurement::default()], None);
        assert_eq!((dark.uniformity, dark.diversity, dark.uniformity_error), (0.0, 0.0, 0.0));
    }

    #[test]
    fn errors_common_to_all_sensors_do_not_count_in_ratios() {
        let measured = [1.0, 3.0].map(|e| Measurement {
            irradiance: Rgb::splat(e),
            luminance_errors: [0.1 * e, 0.0],
            ..Measurement::default()
        });
        // All repeats differ by a factor only: the covariance is 10 % of each value times 10 % of the mean.
        let spread = SpreadOfMean { error: 0.2, covariances: vec![0.02, 0.06] };
        let report = SensorsReport::new("desk", &measured, Some(&spread));
        assert!(report.mean_error == 0.2 && report.uniformity_error < 1e-8, "{report:?}");
    }
}
