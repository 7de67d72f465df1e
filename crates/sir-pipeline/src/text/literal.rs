//! Number literals of RON.

/// Returns the value of a literal if it is a whole number that is not negative. `1_000_000` and `1e6` are equal.
#[must_use]
pub fn whole_number(literal: &str) -> Option<u64> {
    ron::from_str(literal).ok().or_else(|| {
        // Up to 2⁵³, floats represent whole numbers exactly.
        float(literal).filter(|x| x.fract() == 0.0 && (0.0..9.0e15).contains(x)).map(|x| x as u64)
    })
}

/// Returns the value of a literal if it is a finite number.
pub(crate) fn float(literal: &str) -> Option<f64> {
    let int = ron::from_str::<i64>(literal).ok().map(|i| i as f64);
    int.or_else(|| ron::from_str(literal).ok()).filter(|x: &f64| x.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_may_be_written_in_several_ways() {
        for (literal, value) in [
            ("1000000", Some(1_000_000)),
            ("1_000_000", Some(1_000_000)),
            ("1e6", Some(1_000_000)),
            ("1.5e3", Some(1_500)),
            ("0x10", Some(16)),
            ("+7", Some(7)),
            ("18446744073709551615", Some(u64::MAX)),
            ("1.5", None),
            ("-1", None),
            ("1e300", None),
            ("NaN", None),
            ("inf", None),
        ] {
            assert_eq!(whole_number(literal), value, "{literal}");
        }
    }

    #[test]
    fn numbers_are_finite() {
        assert_eq!(
            ["1_000", "-2.5", "1e-3", ".5", "NaN", "inf", "1e999"].map(float),
            [Some(1000.0), Some(-2.5), Some(1e-3), Some(0.5), None, None, None]
        );
    }
}
