//! 16-bit codes of the logarithms of numbers.

/// Logarithmic scale of 16-bit codes: code 0 is zero, and code `c` is `exp(low + (c − 1) step)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LogScale {
    /// Logarithm of the smallest number above zero.
    pub low: f64,
    /// Difference of the logarithms of consecutive codes.
    pub step: f64,
}

impl LogScale {
    /// Step for numbers that are shown with three digits.
    pub const FINE: f64 = 5e-4;

    /// Step for numbers that are shown with two digits.
    pub const COARSE: f64 = 4e-3;

    /// Returns the scale with this step that ends at the largest number.
    #[must_use]
    pub fn up_to(largest: f64, step: f64) -> Self {
        let high = if largest > 0.0 && largest.is_finite() { largest.ln() } else { 0.0 };
        Self { low: high - f64::from(u16::MAX - 1) * step, step }
    }

    /// Returns the code of a number. Numbers below half of the smallest one and infinite ones become zero, and numbers above
    /// the largest become that.
    #[must_use]
    pub fn code(self, number: f64) -> u16 {
        if !number.is_finite() || number <= 0.0 {
            return 0;
        }
        let steps = ((number.ln() - self.low) / self.step).round();
        if steps < 0.0 { 0 } else { (steps + 1.0).min(f64::from(u16::MAX)) as u16 }
    }

    /// Returns the number with a code.
    #[must_use]
    pub fn number(self, code: u16) -> f64 {
        if code == 0 { 0.0 } else { (self.low + f64::from(code - 1) * self.step).exp() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_keep_three_digits_over_fourteen_decades() {
        let scale = LogScale::up_to(2e5, LogScale::FINE);
        for i in 0..1400 {
            let number = 2e5 * 10f64.powf(-f64::from(i) / 100.0);
            let back = scale.number(scale.code(number));
            assert!((back / number - 1.0).abs() < 2.6e-4, "{number} {back}");
        }
        assert_eq!([0.0, -1.0, f64::NAN, f64::INFINITY, 1e-30].map(|x| scale.code(x)), [0; 5]);
        assert_eq!(scale.code(1e9), u16::MAX);
        assert_eq!(LogScale::up_to(0.0, LogScale::FINE).code(0.0), 0);
    }
}
