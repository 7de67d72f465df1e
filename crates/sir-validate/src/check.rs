//! Comparison of computed with exact answers, and verdicts.

use serde::Serialize;

use crate::effort::Effort;
use crate::estimate::Estimate;
use crate::trial::Quantity;

/// Largest deviation that passes, in standard deviations of a normal variable. One of 16,000 correct answers exceeds it
/// by chance.
pub const LIMIT: f64 = 4.0;

/// Comparison of a computed with an exact answer.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Check {
    /// Name of the quantity.
    pub quantity: String,
    /// Name of a group of similar quantities, which are shown in one row of a table.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub group: Option<String>,
    /// Exact answer.
    pub exact: f64,
    /// Mean of our runs.
    pub ours: f64,
    /// Standard error of the mean.
    pub sigma: f64,
    /// Difference, converted to standard deviations of a normal variable. It is a little less than the difference in
    /// standard errors, because runs are few. Infinite (`null` in JSON) if an exact zero was missed.
    pub z: f64,
    /// Value published by others.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub published: Option<f64>,
    /// Number of runs.
    pub runs: usize,
    /// Verdict on the answer.
    pub verdict: Verdict,
}

/// Verdict on an answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// Equal to the exact answer within noise.
    Passed,
    /// The noise is too large to decide.
    TooNoisy,
    /// Different from the exact answer.
    Wrong,
}

impl Verdict {
    /// Returns a word for a table.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Passed => "ok",
            Self::TooNoisy => "TOO NOISY",
            Self::Wrong => "WRONG",
        }
    }
}

impl Check {
    pub(crate) fn new(quantity: &Quantity, estimate: Estimate, effort: Effort) -> Self {
        let z = estimate.z(quantity.exact);
        let verdict = if z.is_nan() || z.abs() > LIMIT {
            Verdict::Wrong
        } else if estimate.sigma <= effort.precision() * quantity.exact.abs() {
            Verdict::Passed
        } else {
            Verdict::TooNoisy
        };
        Self {
            quantity: quantity.name.clone(),
            group: quantity.group.clone(),
            exact: quantity.exact,
            ours: estimate.mean,
            sigma: estimate.sigma,
            z,
            published: quantity.published,
            runs: estimate.runs,
            verdict,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn verdict(exact: f64, mean: f64, sigma: f64) -> Verdict {
        Check::new(&Quantity::new("", exact), Estimate { mean, sigma, runs: 1000 }, Effort::Full).verdict
    }

    #[test]
    fn answers_are_judged_by_their_noise() {
        assert_eq!(verdict(100.0, 100.3, 0.08), Verdict::Passed);
        assert_eq!(verdict(100.0, 100.5, 0.08), Verdict::Wrong);
        assert_eq!(verdict(100.0, 100.3, 0.2), Verdict::TooNoisy);
        assert_eq!(verdict(100.0, f64::NAN, 0.08), Verdict::Wrong);
        assert_eq!(verdict(0.0, 0.0, 0.0), Verdict::Passed);
        assert_eq!(verdict(0.0, 1e-20, 0.0), Verdict::Wrong);
    }
}
