//! Portable sine and cosine of fractions of a turn.

/// Coefficients of the power series of `sin(x)/x` in `x²`.
const SIN: [f64; 8] = [
    1.0,
    -1.0 / 6.0,
    1.0 / 120.0,
    -1.0 / 5_040.0,
    1.0 / 362_880.0,
    -1.0 / 39_916_800.0,
    1.0 / 6_227_020_800.0,
    -1.0 / 1_307_674_368_000.0,
];

/// Coefficients of the power series of `cos(x)` in `x²`.
const COS: [f64; 8] = [
    1.0,
    -1.0 / 2.0,
    1.0 / 24.0,
    -1.0 / 720.0,
    1.0 / 40_320.0,
    -1.0 / 3_628_800.0,
    1.0 / 479_001_600.0,
    -1.0 / 87_178_291_200.0,
];

/// Returns the sine and cosine of an angle of `turn` turns, in `[0, 1]`, with an error below 2·10⁻¹⁵.
///
/// Unlike the functions of the system, it uses only operations that every machine rounds identically. It has no
/// branches.
#[inline]
pub(crate) fn sin_cos_of_turn(turn: f64) -> (f64, f64) {
    // The nearest multiple of a quarter turn, and the angle from there, at most π/4.
    let quarter = (4.0 * turn + 0.5) as i64;
    let x = (turn - 0.25 * quarter as f64) * std::f64::consts::TAU;
    let (sin, cos) = (x * series(SIN, x * x), series(COS, x * x));
    let (a, b) = if quarter & 1 == 0 { (sin, cos) } else { (cos, sin) };
    let sign = |negative: bool| if negative { -1.0 } else { 1.0 };
    (a * sign(quarter & 2 != 0), b * sign((quarter + 1) & 2 != 0))
}

/// Evaluates a polynomial of degree seven by Estrin's scheme (1960), which has shorter dependency chains than Horner's.
#[inline]
fn series([a, b, c, d, e, f, g, h]: [f64; 8], x: f64) -> f64 {
    let (x2, pair) = (x * x, |a: f64, b: f64| a + b * x);
    let four = |a, b, c, d| pair(a, b) + pair(c, d) * x2;
    four(a, b, c, d) + four(e, f, g, h) * (x2 * x2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sines_and_cosines_are_those_of_the_standard_library() {
        for i in 0..=100_000 {
            let turn = f64::from(i) / 100_000.0;
            let ((sin, cos), (s, c)) = (sin_cos_of_turn(turn), (turn * std::f64::consts::TAU).sin_cos());
            assert!((sin - s).abs() < 2e-15 && (cos - c).abs() < 2e-15, "{turn}: {sin} {s}, {cos} {c}");
        }
    }
}
