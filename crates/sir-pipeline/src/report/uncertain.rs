//! A number with its standard error.

use std::fmt;

/// A number with its standard error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Uncertain {
    pub(crate) value: f64,
    pub(crate) error: f64,
}

impl Uncertain {
    /// Returns the ratio to another number with which this one has a covariance; zero if the other is not positive. The
    /// error is that of the ratio to first order: `σ² = (σ_a² + r² σ_b² − 2 r cov)/b²`.
    pub(crate) fn over(self, other: Self, covariance: f64) -> Self {
        if other.value <= 0.0 {
            return Self { value: 0.0, error: 0.0 };
        }
        let ratio = self.value / other.value;
        let (a, b) = (self.error, ratio * other.error);
        let square = a * a + b * b - 2.0 * ratio * covariance;
        // Rounding may bring it below zero.
        Self { value: ratio, error: libm::sqrt(square.max(0.0)) / other.value }
    }
}

/// Shows the number with two digits of its standard error, or with up to four digits if it has none.
impl fmt::Display for Uncertain {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { value, error } = *self;
        if error > 0.0 {
            let decimals = decimals(error);
            write!(f, "{value:.decimals$} ± {error:.decimals$}")
        } else {
            f.write_str(&significant(value))
        }
    }
}

/// Returns the number of decimals that shows two digits of an error.
fn decimals(error: f64) -> usize {
    (1.0 - error.log10().floor()).clamp(0.0, 9.0) as usize
}

/// Formats a number with at most four significant digits.
pub(crate) fn significant(x: f64) -> String {
    let before = if x == 0.0 { 0.0 } else { x.abs().log10().floor() };
    let text = format!("{x:.0$}", (3.0 - before).clamp(0.0, 9.0) as usize);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').into() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_shown_with_two_digits_of_their_errors() {
        let shown = |value, error| Uncertain { value, error }.to_string();
        assert_eq!(shown(501.237, 0.314), "501.24 ± 0.31");
        assert_eq!(shown(501.237, 31.4), "501 ± 31");
        assert_eq!(shown(0.5, 0.0), "0.5");
        assert_eq!([1234.5, 0.061_234_5, 100.0, 0.0].map(significant), ["1234", "0.06123", "100", "0"]);
    }
}
