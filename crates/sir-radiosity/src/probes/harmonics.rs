//! Real spherical harmonics up to degree 2, and what a cosine-weighted hemisphere makes of them.
//!
//! A function of the direction `n` is a sum `Σ c_i Y_i(n)` of nine orthonormal functions, in the order of degree and
//! order `(0,0), (1,−1), (1,0), (1,1), (2,−2), …, (2,2)`, without the Condon–Shortley phase: degree 1 is proportional to
//! `y, z, x`.
//!
//! Irradiance is radiance, convolved with a clamped cosine. In harmonics that is a product: a coefficient of degree `l`
//! is multiplied by `A_l` = π, 2π/3, π/4. Degree 3 vanishes, and `A_4 = −π/24`, so that nine coefficients represent
//! irradiance well (Ramamoorthi and Hanrahan 2001, *An efficient representation for irradiance environment maps*). The
//! worst case is light from a single direction: the error is then at most 9.4 % of the largest irradiance, for
//! receivers that the light just grazes.

use std::f64::consts::PI;

use glam::DVec3;
use sir_geom::Rgb;

/// Number of spherical harmonics up to degree 2.
pub const HARMONICS: usize = 9;

/// Factor from each coefficient of radiance to that of irradiance: `A_l` of its degree.
pub const COSINE_FACTORS: [f64; HARMONICS] = {
    let [a, b, c] = [PI, 2.0 * PI / 3.0, PI / 4.0];
    [a, b, b, b, c, c, c, c, c]
};

/// Largest absolute value of the harmonics of each degree, `√((2l + 1)/4π)`, for every harmonic.
pub(super) const BOUNDS: [f64; HARMONICS] = {
    let [a, b, c] = [0.282_094_791_773_878_14, 0.488_602_511_902_919_9, 0.630_783_130_505_04];
    [a, b, b, b, c, c, c, c, c]
};

/// Returns the values of the harmonics in a direction, a unit vector.
#[inline]
#[must_use]
pub fn harmonics(direction: DVec3) -> [f64; HARMONICS] {
    /// `√(1/4π)`, `√(3/4π)`, `√(15/4π)`, `√(5/16π)`, `√(15/16π)`.
    const FACTORS: [f64; 5] = [
        0.282_094_791_773_878_14,
        0.488_602_511_902_919_9,
        1.092_548_430_592_079_2,
        0.315_391_565_252_52,
        0.546_274_215_296_039_6,
    ];
    let [a, b, c, d, e] = FACTORS;
    let DVec3 { x, y, z } = direction;
    [a, b * y, b * z, b * x, c * x * y, c * y * z, d * (3.0 * z * z - 1.0), c * x * z, e * (x * x - y * y)]
}

/// Returns the value of a sum of harmonics in a direction, a unit vector: for the coefficients of an irradiance, the
/// irradiance of a surface with this normal. It may be slightly below zero where light comes from the other side.
#[must_use]
pub fn sum_of_harmonics(coefficients: &[Rgb; HARMONICS], direction: DVec3) -> Rgb {
    let terms =
        coefficients.iter().zip(harmonics(direction)).map(|(coefficient, value)| *coefficient * value);
    terms.fold(Rgb::ZERO, |sum, term| sum + term)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns points of the sphere that are uniform in height and in azimuth, and a function to sum over them.
    fn integral(function: impl Fn(DVec3) -> f64) -> f64 {
        let (rings, segments) = (2_000u32, 64u32);
        let ring = |i: u32| {
            let z = 2.0 * (f64::from(i) + 0.5) / f64::from(rings) - 1.0;
            let rho = (1.0 - z * z).sqrt();
            let point = |k: u32| {
                let (sin, cos) = libm::sincos(2.0 * PI * f64::from(k) / f64::from(segments));
                function(DVec3::new(rho * cos, rho * sin, z))
            };
            (0..segments).map(point).sum::<f64>()
        };
        (0..rings).map(ring).sum::<f64>() * 4.0 * PI / f64::from(rings * segments)
    }

    #[test]
    fn harmonics_are_orthonormal() {
        for i in 0..HARMONICS {
            for j in i..HARMONICS {
                let product = integral(|d| harmonics(d)[i] * harmonics(d)[j]);
                assert!((product - f64::from(u8::from(i == j))).abs() < 1e-5, "{i} {j}: {product}");
            }
        }
    }

    /// The convolution of each harmonic with a clamped cosine, in a direction along no axis.
    #[test]
    fn a_clamped_cosine_multiplies_by_the_factors() {
        let n = DVec3::new(0.6, -0.3, 0.7).normalize();
        for i in 0..HARMONICS {
            let convolved = integral(|d| harmonics(d)[i] * d.dot(n).max(0.0));
            let expected = COSINE_FACTORS[i] * harmonics(n)[i];
            assert!((convolved - expected).abs() < 1e-3, "{i}: {convolved}, {expected}");
            assert!(harmonics(n)[i].abs() <= BOUNDS[i]);
        }
    }

    #[test]
    fn light_from_one_direction_is_represented_within_ten_per_cent() {
        let light = DVec3::new(1.0, 2.0, -2.0) / 3.0;
        let coefficients = std::array::from_fn(|i| Rgb::splat(COSINE_FACTORS[i] * harmonics(light)[i]));
        let error = |n: DVec3| (sum_of_harmonics(&coefficients, n).x - n.dot(light).max(0.0)).abs();
        let across = light.any_orthonormal_vector();
        let angles = (0..=180).map(|degrees| libm::sincos(f64::from(degrees).to_radians()));
        let largest = angles.map(|(sin, cos)| error(cos * light + sin * across)).fold(0.0, f64::max);
        assert!((0.09..0.1).contains(&largest), "{largest}");
    }
}
