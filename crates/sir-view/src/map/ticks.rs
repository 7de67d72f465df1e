//! Round numbers on scales.

/// Returns the smallest of 1, 2 and 5 times a power of ten that is at least `least`.
pub(super) fn step(least: f64) -> f64 {
    let power = 10f64.powf(least.max(f64::MIN_POSITIVE).log10().floor());
    [1.0, 2.0, 5.0]
        .map(|factor| factor * power)
        .into_iter()
        .find(|step| *step >= least)
        .unwrap_or(10.0 * power)
}

/// Returns the multiples of `step` from `first` to `last`.
pub(super) fn multiples(step: f64, first: f64, last: f64) -> impl Iterator<Item = f64> {
    let start = (first / step - 1e-9).ceil();
    (0..100).map(move |i| (start + f64::from(i)) * step).take_while(move |x| *x <= last + 1e-9 * step)
}

/// Formats a multiple of `step` with the number of decimals that it needs.
pub(super) fn number(x: f64, step: f64) -> String {
    let decimals = (-step.log10().floor()).clamp(0.0, 12.0) as usize;
    if x.abs() >= 1e7 || decimals > 6 { format!("{x:.1e}") } else { format!("{x:.decimals$}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_are_round_numbers() {
        assert_eq!([0.3, 1.0, 1.1, 47.0, 60.0].map(step), [0.5, 1.0, 2.0, 50.0, 100.0]);
        let labels: Vec<String> = multiples(0.5, 0.7, 2.0).map(|x| number(x, 0.5)).collect();
        assert_eq!(labels, ["1.0", "1.5", "2.0"]);
        assert_eq!(number(1500.0, 500.0), "1500");
    }
}
