//! Low-discrepancy points of the unit square.

/// First two powers of the inverse of the plastic number, the real root of `x³ = x + 1`.
const STEPS: [f64; 2] = [0.754_877_666_246_692_7, 0.569_840_290_998_053_2];

/// Randomized low-discrepancy sequence in the unit square: the additive recurrence R2 (Roberts 2018, *The unreasonable
/// effectiveness of quasirandom sequences*) with a random shift (Cranley and Patterson 1976). The sequence is infinite,
/// and any prefix of it fills the square evenly.
///
/// Each single point is uniform, so a mean over the points is unbiased. It converges faster than with independent
/// points. Its error can be estimated only from independent replications, that is, sequences with different shifts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct R2Sequence {
    shift: [f64; 2],
}

impl R2Sequence {
    /// Returns the sequence with this shift, a random point of the unit square.
    #[must_use]
    pub fn new(shift: [f64; 2]) -> Self {
        Self { shift }
    }

    /// Returns the point with this number, which must be below 2³². Both coordinates are in `[0, 1)`.
    #[inline]
    #[must_use]
    pub fn at(&self, number: u64) -> [f64; 2] {
        std::array::from_fn(|k| {
            let sum = self.shift[k] + number as f64 * STEPS[k];
            sum - sum.floor()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stream::{Purpose, Streams};

    /// Means of a smooth and of a discontinuous function are unbiased and have much smaller errors than with
    /// independent points.
    #[test]
    fn means_are_right_and_converge_fast() {
        type Function = fn([f64; 2]) -> f64;
        let functions: [(Function, f64, f64); 2] =
            [(|[x, y]| x * y, 0.25, 7.0 / 144.0), (|[x, y]| f64::from(u8::from(x + y < 0.7)), 0.245, 0.185)];
        let streams = Streams::new(3, Purpose::SENSORS);
        let (repeats, n) = (400, 1000);
        for (function, exact, variance) in functions {
            let errors: Vec<f64> = (0..repeats)
                .map(|k| {
                    let points = R2Sequence::new(streams.line(k).point());
                    (0..n).map(|i| function(points.at(i))).sum::<f64>() / n as f64 - exact
                })
                .collect();
            let mean = errors.iter().sum::<f64>() / repeats as f64;
            let square = errors.iter().map(|e| e * e).sum::<f64>() / repeats as f64;
            assert!(mean.abs() < 4.0 * (square / repeats as f64).sqrt(), "{mean} {square}");
            assert!(square < 0.1 * variance / n as f64, "{square}, {} if independent", variance / n as f64);
        }
    }
}
