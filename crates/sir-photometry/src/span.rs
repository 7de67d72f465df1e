//! Intensity between two polar angles of a plane: its integral, and the inverse of that.

use std::f64::consts::PI;

/// Returns the share `s` of the unit interval before which the integral of the line from `a` to `b` is `integral`.
pub(crate) fn share_of_line([a, b]: [f64; 2], integral: f64) -> f64 {
    // s a + s² (b − a)/2 = integral, without cancellation where a and b are about equal.
    let root = (a * a + 2.0 * (b - a) * integral).max(0.0).sqrt();
    let s = 2.0 * integral / (a + root);
    if s.is_finite() { s.clamp(0.0, 1.0) } else { 0.0 }
}

/// Intensity between two polar angles, linear in the angle.
pub(crate) struct Span {
    /// First angle \[rad\].
    start: f64,
    /// Its sine and cosine.
    turn: (f64, f64),
    /// Intensity there.
    value: f64,
    /// Its increase per radian.
    slope: f64,
}

impl Span {
    pub(crate) fn of(angles: &[f64], values: &[f64]) -> Self {
        let slope = (values[1] - values[0]) / (angles[1] - angles[0]);
        Self { start: angles[0], turn: libm::sincos(angles[0]), value: values[0], slope }
    }

    /// Returns the integral of the intensity times the sine of the polar angle, from the start up to an angle, and that product
    /// at the angle.
    pub(crate) fn up_to(&self, angle: f64) -> [f64; 2] {
        let Self { start, turn: (sin_start, cos_start), value, slope } = *self;
        let turn = angle - start;
        let (sin_half, cos_half) = libm::sincos(0.5 * turn);
        let rotated =
            |(sin, cos): (f64, f64)| (sin * cos_half + cos * sin_half, cos * cos_half - sin * sin_half);
        let middle = rotated((sin_start, cos_start));
        let (sin, cos) = rotated(middle);
        // A difference of cosines would cancel.
        let of_one = 2.0 * sin_half * middle.0;
        let of_turn = if turn < NARROW {
            let square = turn * turn;
            let series = |factors: [f64; 6]| factors.into_iter().rev().fold(0.0, |sum, f| sum * square + f);
            // ∫ t cos t dt and ∫ t sin t dt.
            square * (sin_start * series(T_COS) + cos_start * turn * series(T_SIN))
        } else {
            // ∫ (t − start) sin t dt = sin(angle) − sin(start) − turn cos(angle)
            2.0 * sin_half * middle.1 - turn * cos
        };
        [value * of_one + slope * of_turn, (value + slope * turn) * sin]
    }

    /// Returns the angle up to which the integral is `wanted`, at most `end`.
    pub(crate) fn inverse(&self, wanted: f64, end: f64) -> f64 {
        let Self { start, turn: (sin_start, _), value, slope } = *self;
        let (mut low, mut high, width) = (start, end, end - start);
        // As if the product with the sine were linear.
        let last = (value + slope * width) * libm::sin(end);
        let mut angle = start + width * share_of_line([value * sin_start, last], wanted / width);
        for _ in 0..MAX_STEPS {
            let [integral, density] = self.up_to(angle);
            let excess = integral - wanted;
            if excess > 0.0 {
                high = angle;
            } else {
                low = angle;
            }
            let next = angle - excess / density;
            // The error after a step is about its square over the distance to the next zero of the density.
            let enough = (CONVERGED * (angle - start).min(end - angle)).max(2.0 * PI * f64::EPSILON);
            if (next - angle).abs() <= enough {
                return next.clamp(start, end);
            }
            // A step out of the interval, or none, is replaced by half of the interval.
            angle = if next > low && next < high { next } else { low.midpoint(high) };
        }
        angle
    }
}

/// Angle \[rad\] below which integrals are sums of a series, because their terms would cancel.
const NARROW: f64 = 0.25;

/// Coefficients of `∫₀ˣ t cos t dt / x²` in powers of `x²`.
const T_COS: [f64; 6] =
    [1.0 / 2.0, -1.0 / 8.0, 1.0 / 144.0, -1.0 / 5760.0, 1.0 / 403_200.0, -1.0 / 43_545_600.0];

/// Coefficients of `∫₀ˣ t sin t dt / x³` in powers of `x²`.
const T_SIN: [f64; 6] =
    [1.0 / 3.0, -1.0 / 30.0, 1.0 / 840.0, -1.0 / 45_360.0, 1.0 / 3_991_680.0, -1.0 / 518_918_400.0];

/// Relative size of the last step of Newton's method, which converges quadratically: the root of the smallest error.
const CONVERGED: f64 = 1e-8;

/// Largest number of steps of Newton's method, which bisects the interval where it fails.
const MAX_STEPS: u32 = 60;

#[cfg(test)]
mod tests {
    use super::*;

    /// The inverse finds the angle again, as exactly as the integral determines it, and the integral is that of a sum over
    /// many parts.
    #[test]
    fn the_inverse_is_exact() {
        let radians = f64::to_radians;
        for [from, to] in [
            [0.0, 180.0],
            [0.0, 0.5],
            [30.0, 35.0],
            [89.0, 90.0],
            [175.0, 180.0],
            [0.0, 14.3],
            [0.0, 14.4],
            [0.0, 1e-3],
        ] {
            let angles = [from, to].map(radians);
            for values in [[1.0, 1.0], [0.0, 1.0], [1.0, 0.0], [1e6, 1.0], [1.0, 1e6]] {
                let span = Span::of(&angles, &values);
                let all = span.up_to(angles[1])[0];
                // Of the last digits of the angle.
                let rounding = 1e-14 + 8e-16 * angles[1] / (angles[1] - angles[0]);
                let parts = 20_000;
                let at =
                    |i: i32| angles[0] + (f64::from(i) + 0.5) / f64::from(parts) * (angles[1] - angles[0]);
                let sum: f64 = (0..parts).map(|i| span.up_to(at(i))[1]).sum();
                let sum = sum * (angles[1] - angles[0]) / f64::from(parts);
                assert!((sum / all - 1.0).abs() < 1e-7, "{from}° to {to}°, {values:?}: {all}, {sum}");
                for share in [0.0, 1e-9, 0.01, 0.3, 0.5, 0.77, 0.999, 1.0] {
                    let angle = span.inverse(share * all, angles[1]);
                    assert!((angles[0]..=angles[1]).contains(&angle));
                    let off = (span.up_to(angle)[0] - share * all).abs() / all;
                    assert!(off < rounding, "{from}° to {to}°, {values:?}, {share}: {off:e}");
                }
            }
        }
    }
}
