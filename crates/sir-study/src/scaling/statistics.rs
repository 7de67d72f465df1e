//! Statistics of measured times: medians, speed-ups and efficiencies.

use serde::Serialize;

/// Summary of several measurements of the same quantity.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Spread {
    /// Median: the middle value, or the mean of the two middle values.
    pub median: f64,
    /// Smallest value.
    pub min: f64,
    /// Largest value.
    pub max: f64,
}

impl Spread {
    /// Summarizes values; returns `None` if there are none.
    #[must_use]
    pub fn of(values: impl IntoIterator<Item = f64>) -> Option<Self> {
        let mut values: Vec<f64> = values.into_iter().collect();
        values.sort_by(f64::total_cmp);
        let (min, max) = (*values.first()?, *values.last()?);
        let median = (values[(values.len() - 1) / 2] + values[values.len() / 2]) / 2.0;
        Some(Self { median, min, max })
    }
}

/// Time, speed-up and efficiency of a part of the run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Part {
    /// Time `T(p)` \[s\].
    pub seconds: Spread,
    /// Speed-up `S(p) = T(1) / T(p)`, from medians.
    pub speed_up: f64,
    /// Efficiency `E(p) = S(p) / p`.
    pub efficiency: f64,
}

impl Part {
    /// Computes speed-up and efficiency of `p` workers from the time `one` of one worker.
    #[must_use]
    pub fn new(one: Spread, seconds: Spread, p: usize) -> Self {
        // Times are at least a nanosecond, the resolution of clocks, so that a time of zero gives no infinite speed-up.
        let speed_up = one.median.max(1e-9) / seconds.median.max(1e-9);
        Self { seconds, speed_up, efficiency: speed_up / p.max(1) as f64 }
    }
}

/// Time that is not spent on lines.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Overhead {
    /// Time \[s\].
    pub seconds: Spread,
    /// Share of the time in the whole run, from medians.
    pub share: f64,
}

impl Overhead {
    /// Computes the share of a time in the time of the whole run.
    #[must_use]
    pub fn new(seconds: Spread, whole: Spread) -> Self {
        Self { seconds, share: seconds.median / whole.median.max(1e-9) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all_equal(value: f64) -> Spread {
        Spread { median: value, min: value, max: value }
    }

    #[test]
    fn medians_of_odd_and_even_counts() {
        assert_eq!(Spread::of([]), None);
        assert_eq!(Spread::of([4.0]), Some(all_equal(4.0)));
        assert_eq!(Spread::of([9.0, 1.0, 2.0]), Some(Spread { median: 2.0, min: 1.0, max: 9.0 }));
        assert_eq!(Spread::of([9.0, 1.0, 4.0, 2.0]), Some(Spread { median: 3.0, min: 1.0, max: 9.0 }));
    }

    #[test]
    fn speed_up_and_efficiency_are_those_of_medians() {
        let part = Part::new(all_equal(12.0), Spread { median: 4.0, min: 1.0, max: 99.0 }, 4);
        assert_eq!((part.speed_up, part.efficiency), (3.0, 0.75));
        let nothing = Part::new(all_equal(0.0), all_equal(0.0), 1);
        assert_eq!((nothing.speed_up, nothing.efficiency), (1.0, 1.0));
    }
}
