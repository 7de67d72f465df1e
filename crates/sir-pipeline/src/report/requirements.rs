//! Requirements on sensors, and whether measurements meet them.

use serde::{Deserialize, Serialize};

use crate::plan::Require;
use crate::report::uncertain::{Uncertain, significant};
use crate::units::Units;

/// Number of standard errors within which a requirement is undecided: a normal error is larger on one side in 2.3 % of
/// cases.
const UNDECIDED: f64 = 2.0;

/// Name of the quantity that must not be larger than required.
const UGR: &str = "UGR";

/// A requirement, with what was measured.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RequirementReport {
    /// Name of the quantity: `mean`, `minimum`, `uniformity`, `diversity`, `daylight factor` or `UGR`.
    pub quantity: String,
    /// Least value required, in W/m² unless it is a ratio; in per cent for the daylight factor. For `UGR`, the largest.
    pub required: f64,
    /// Measured value.
    pub measured: f64,
    /// Standard error of the measured value.
    pub error: f64,
    /// Distance of the measured value from the required one, on the good side, in standard errors; `None` if the error is
    /// zero.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub margin: Option<f64>,
    /// Whether the requirement is met.
    pub verdict: Verdict,
}

/// Whether a requirement is met.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// The measured value is on the good side of the required one, by at least two standard errors.
    Passes,
    /// It is on the other side, by at least two standard errors.
    Fails,
    /// The two differ by less than two standard errors.
    Undecided,
}

impl RequirementReport {
    /// Compares a measured number with the least one required, or the largest UGR.
    pub(crate) fn new(quantity: &str, required: f64, measured: Uncertain) -> Self {
        let Uncertain { value, error } = measured;
        let excess = if quantity == UGR { required - value } else { value - required };
        let margin = (error > 0.0).then(|| excess / error);
        let verdict = match margin {
            Some(margin) if margin.abs() < UNDECIDED => Verdict::Undecided,
            _ if excess >= 0.0 => Verdict::Passes,
            _ => Verdict::Fails,
        };
        Self { quantity: quantity.into(), required, measured: value, error, margin, verdict }
    }

    /// Compares all quantities with what is required of them. `measured` are mean, minimum, uniformity,
    /// diversity, mean daylight factor and UGR.
    pub(crate) fn all(require: &Require, measured: [Uncertain; 6]) -> Vec<Self> {
        let Require { mean, minimum, uniformity, diversity, daylight_factor, ugr } = *require;
        let required = [
            ("mean", mean),
            ("minimum", minimum),
            ("uniformity", uniformity),
            ("diversity", diversity),
            ("daylight factor", daylight_factor),
            (UGR, ugr),
        ];
        let pairs = required.into_iter().zip(measured);
        pairs
            .filter_map(|((name, required), measured)| required.map(|least| Self::new(name, least, measured)))
            .collect()
    }

    /// Returns the requirement and the verdict in one line, such as `mean 512.3 ± 1.2 lx, at least 500: passes by 10
    /// standard errors`.
    #[must_use]
    pub fn in_short(&self, units: Units) -> String {
        let unit = match self.quantity.as_str() {
            "mean" | "minimum" => format!(" {}", units.irradiance()),
            "daylight factor" => " %".into(),
            _ => String::new(),
        };
        let measured = Uncertain { value: self.measured, error: self.error };
        format!(
            "{} {measured}{unit}, at {} {}: {}",
            self.quantity,
            if self.quantity == UGR { "most" } else { "least" },
            significant(self.required),
            self.verdict_in_words()
        )
    }

    fn verdict_in_words(&self) -> String {
        let by = self.margin.map(|margin| format!("{:.1} standard errors", margin.abs()));
        match (self.verdict, by) {
            (Verdict::Passes, Some(by)) => format!("passes by {by}"),
            (Verdict::Fails, Some(by)) => format!("fails by {by}"),
            (Verdict::Passes, None) => "passes".into(),
            (Verdict::Fails, None) => "fails".into(),
            (Verdict::Undecided, by) => {
                let side = if self.measured < self.required { "below" } else { "above" };
                format!("undecided, {} {side}", by.unwrap_or_default())
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verdicts_follow_from_margins_in_standard_errors() {
        for (value, error, words) in [
            (512.3, 1.23, "mean 512.3 ± 1.2 lx, at least 500: passes by 10.0 standard errors"),
            (480.0, 5.0, "mean 480.0 ± 5.0 lx, at least 500: fails by 4.0 standard errors"),
            (501.0, 5.0, "mean 501.0 ± 5.0 lx, at least 500: undecided, 0.2 standard errors above"),
            (491.0, 5.0, "mean 491.0 ± 5.0 lx, at least 500: undecided, 1.8 standard errors below"),
            (500.0, 0.0, "mean 500 lx, at least 500: passes"),
            (499.0, 0.0, "mean 499 lx, at least 500: fails"),
        ] {
            let report = RequirementReport::new("mean", 500.0, Uncertain { value, error });
            assert_eq!(report.in_short(Units::Photometric), words);
        }
    }

    #[test]
    fn glare_must_not_be_large() {
        for (value, words) in [
            (18.0, "UGR 18.00 ± 0.10, at most 19: passes by 10.0 standard errors"),
            (20.0, "UGR 20.00 ± 0.10, at most 19: fails by 10.0 standard errors"),
        ] {
            let report = RequirementReport::new("UGR", 19.0, Uncertain { value, error: 0.1 });
            assert_eq!(report.in_short(Units::Photometric), words);
        }
    }

    #[test]
    fn ratios_have_no_unit() {
        let require = Require {
            mean: None,
            minimum: None,
            uniformity: Some(0.6),
            diversity: None,
            daylight_factor: None,
            ugr: None,
        };
        let measured = Uncertain { value: 0.65, error: 0.01 };
        let [report] = &RequirementReport::all(&require, [measured; 6])[..] else { panic!() };
        let words = "uniformity 0.650 ± 0.010, at least 0.6: passes by 5.0 standard errors";
        assert_eq!(report.in_short(Units::Photometric), words);
    }
}
