//! The sky: light from all directions of a hemisphere, from infinitely far.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::DVec3;

use crate::color::Rgb;

/// Sky seen by lines that leave the scene: a dome above, and below it a ground of uniform radiance.
#[derive(Clone, Debug, PartialEq)]
pub struct Sky {
    up: DVec3,
    pattern: Pattern,
    /// Radiance of the dome divided by its pattern.
    scale: Rgb,
    ground: Rgb,
    integrals: Integrals,
}

/// Distribution of the radiance of a dome over directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SkyModel {
    /// Uniform: type 5 of the CIE general sky.
    Uniform,
    /// The traditional overcast sky of the CIE, three times as bright at the zenith as at the horizon:
    /// `L = L_z (1 + 2 sin γ) / 3` (Moon and Spencer 1942; type 16 of CIE S 011).
    Overcast,
    /// One of the fifteen types of the CIE general sky (CIE S 011/E:2003, ISO 15469:2004), without the disc of the sun.
    General {
        /// Type, from 1, a steep overcast sky, to 15, a white-blue turbid sky with a broad solar corona. 12 is a clear
        /// sky.
        kind: u8,
        /// Unit vector toward the sun, above the horizon.
        sun: DVec3,
    },
}

/// Relative radiance of a dome: coefficients of gradation and indicatrix.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Pattern {
    Overcast,
    General { coefficients: [f64; 5], sun: DVec3 },
}

/// Integrals of a pattern over its hemisphere.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Integrals {
    /// `∫ p(ω) |ω| dω` of the pattern `p`, by coordinates.
    across: DVec3,
    /// Upper bound of the pattern over all directions.
    bound: f64,
}

/// Coefficients `a` to `e` of the types 1 to 15 (CIE S 011/E:2003, table 1).
const TYPES: [[f64; 5]; 15] = [
    [4.0, -0.70, 0.0, -1.0, 0.0],
    [4.0, -0.70, 2.0, -1.5, 0.15],
    [1.1, -0.80, 0.0, -1.0, 0.0],
    [1.1, -0.80, 2.0, -1.5, 0.15],
    [0.0, -1.00, 0.0, -1.0, 0.0],
    [0.0, -1.00, 2.0, -1.5, 0.15],
    [0.0, -1.00, 5.0, -2.5, 0.30],
    [0.0, -1.00, 10.0, -3.0, 0.45],
    [-1.0, -0.55, 2.0, -1.5, 0.15],
    [-1.0, -0.55, 5.0, -2.5, 0.30],
    [-1.0, -0.55, 10.0, -3.0, 0.45],
    [-1.0, -0.32, 10.0, -3.0, 0.45],
    [-1.0, -0.32, 16.0, -3.0, 0.30],
    [-1.0, -0.15, 16.0, -3.0, 0.30],
    [-1.0, -0.15, 24.0, -2.8, 0.15],
];

/// Number of steps of the quadrature in height and in longitude.
const STEPS: [u32; 2] = [512, 512];

impl Pattern {
    /// Returns the radiance in a direction above the horizon, in a unit of its own, with the same bits on all machines.
    fn at(self, up: DVec3, direction: DVec3) -> f64 {
        let sine = direction.dot(up);
        match self {
            Self::Overcast => (1.0 + 2.0 * sine) / 3.0,
            Self::General { coefficients: [a, b, c, d, e], sun } => {
                let gradation = 1.0 + a * libm::exp(b / sine.max(1e-9));
                let cosine = direction.dot(sun).clamp(-1.0, 1.0);
                let corona = libm::exp(d * libm::acos(cosine)) - libm::exp(d * FRAC_PI_2);
                gradation * (1.0 + c * corona + e * cosine * cosine)
            }
        }
    }

    /// Returns an upper bound over all directions. The gradation is monotonic. The indicatrix is largest toward the
    /// sun: it falls to its minimum at about a right angle, and rises to less than its maximum.
    fn bound(self) -> f64 {
        match self {
            Self::Overcast => 1.0,
            Self::General { coefficients: [a, b, c, d, e], .. } => {
                let gradation = f64::max(1.0, 1.0 + a * libm::exp(b));
                gradation * (1.0 + c * (1.0 - libm::exp(d * FRAC_PI_2)) + e)
            }
        }
    }
}

impl Sky {
    /// Returns a sky that gives an unobstructed horizontal surface the irradiance `horizontal` per band \[W/m²\], above
    /// a ground with the radiance `ground` \[W/(m² sr)\]. `up` is the direction of the zenith.
    ///
    /// Returns `None` if `up` or the direction of the sun has no length, the sun is below the horizon, a type is not
    /// from 1 to 15, or a color is negative or not finite.
    #[must_use]
    pub fn new(up: DVec3, model: SkyModel, horizontal: Rgb, ground: Rgb) -> Option<Self> {
        let up = up.try_normalize()?;
        let pattern = match model {
            SkyModel::Uniform => Pattern::General { coefficients: TYPES[4], sun: up },
            SkyModel::Overcast => Pattern::Overcast,
            SkyModel::General { kind, sun } => {
                let coefficients = *TYPES.get(usize::from(kind).checked_sub(1)?)?;
                Pattern::General { coefficients, sun: sun.try_normalize().filter(|sun| sun.dot(up) >= 0.0)? }
            }
        };
        let possible = |color: Rgb| color.is_finite() && color.min_element() >= 0.0;
        if !possible(horizontal) || !possible(ground) {
            return None;
        }
        // Midpoint rule with equal steps in height, which are equal solid angles, and in longitude.
        let (x_axis, y_axis) = up.any_orthonormal_pair();
        let (mut across, mut projected) = (DVec3::ZERO, 0.0);
        for i in 0..STEPS[0] {
            let sine = (f64::from(i) + 0.5) / f64::from(STEPS[0]);
            let cosine = (1.0 - sine * sine).sqrt();
            for k in 0..STEPS[1] {
                let longitude = 2.0 * PI * (f64::from(k) + 0.5) / f64::from(STEPS[1]);
                let (x, y) = (cosine * libm::cos(longitude), cosine * libm::sin(longitude));
                let direction = up * sine + x_axis * x + y_axis * y;
                let radiance = pattern.at(up, direction);
                across += radiance * direction.abs();
                projected += radiance * sine;
            }
        }
        let cell = 2.0 * PI / (f64::from(STEPS[0]) * f64::from(STEPS[1]));
        let integrals = Integrals { across: across * cell, bound: pattern.bound() };
        Some(Self { up, pattern, scale: horizontal / (projected * cell), ground, integrals })
    }

    /// Returns a sky with the same radiance \[W/(m² sr)\] in all directions.
    ///
    /// Returns `None` if it is negative or not finite.
    #[must_use]
    pub fn everywhere(radiance: Rgb) -> Option<Self> {
        Self::new(DVec3::Y, SkyModel::Uniform, radiance * PI, radiance)
    }

    /// Returns the sky with its radiance times a factor per band.
    #[must_use]
    pub(crate) fn dimmed(&self, factor: Rgb) -> Self {
        Self { scale: self.scale * factor, ground: self.ground * factor, ..self.clone() }
    }

    /// Returns the unit vector to the zenith.
    #[must_use]
    pub fn up(&self) -> DVec3 {
        self.up
    }

    /// Returns the radiance per band \[W/(m² sr)\] that comes from a direction: `towards` is a unit vector that points
    /// to the sky.
    #[must_use]
    pub fn radiance(&self, towards: DVec3) -> Rgb {
        if towards.dot(self.up) > 0.0 { self.scale * self.pattern.at(self.up, towards) } else { self.ground }
    }

    /// Returns an upper bound of the radiance over all directions, per band \[W/(m² sr)\].
    #[must_use]
    pub fn largest_radiance(&self) -> Rgb {
        (self.scale * self.integrals.bound).max(self.ground)
    }

    /// Returns the radiance of the ground per band \[W/(m² sr)\].
    #[must_use]
    pub fn ground(&self) -> Rgb {
        self.ground
    }

    /// Returns the power of the dome per band \[W\] that enters an axis-aligned box whose faces across each axis have
    /// these areas \[m²\].
    ///
    /// The projected area of the box in the direction `ω` is `Σ Aₖ |ωₖ|`.
    #[must_use]
    pub fn dome_through(&self, areas: DVec3) -> Rgb {
        self.scale * self.integrals.across.dot(areas)
    }

    /// Returns the power of the ground per band \[W\] that enters the same box: `|ωₖ|` has the integral `π` over any
    /// hemisphere.
    #[must_use]
    pub fn ground_through(&self, areas: DVec3) -> Rgb {
        self.ground * (PI * areas.element_sum())
    }

    /// Returns the radiance of the dome in a direction divided by its upper bound, from 0 to 1; zero below the horizon.
    /// This is the acceptance probability with which rejection sampling of uniform directions has the density of the
    /// radiance.
    #[must_use]
    pub fn share(&self, towards: DVec3) -> f64 {
        if towards.dot(self.up) > 0.0 {
            self.pattern.at(self.up, towards) / self.integrals.bound
        } else {
            0.0
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SUN: DVec3 = DVec3::new(0.6, 0.0, 0.8);

    #[test]
    fn closed_forms_of_the_simple_skies_hold() {
        let horizontal = Rgb::new(1.0, 2.0, 3.0);
        let uniform = Sky::new(DVec3::Z, SkyModel::Uniform, horizontal, Rgb::ZERO).unwrap();
        assert!((uniform.radiance(SUN) * PI).abs_diff_eq(horizontal, 1e-5));
        // The power that enters through a face is its irradiance; through both sides of an upright one, half the sky
        // each.
        for k in [0, 1, 2] {
            assert!(uniform.dome_through(DVec3::AXES[k]).abs_diff_eq(horizontal, 1e-4), "{k}");
        }
        assert_eq!(uniform.ground_through(DVec3::ONE), Rgb::ZERO);
        assert_eq!(uniform.radiance(-SUN), Rgb::ZERO);
        // L_z = 9 E / 7π; ∫ |x| dω = π, and ∫ sin γ |x| dω = 4/3.
        let overcast = Sky::new(DVec3::Z, SkyModel::Overcast, horizontal, Rgb::ONE).unwrap();
        assert!(overcast.radiance(DVec3::Z).abs_diff_eq(horizontal * 9.0 / (7.0 * PI), 1e-5));
        assert!(overcast.dome_through(DVec3::Z).abs_diff_eq(horizontal, 1e-4));
        let upright = 9.0 / (7.0 * PI) * (PI + 8.0 / 3.0) / 3.0;
        assert!(overcast.dome_through(DVec3::X).abs_diff_eq(horizontal * upright, 1e-4));
        assert!(overcast.ground_through(DVec3::new(1.0, 2.0, 3.0)).abs_diff_eq(Rgb::splat(6.0 * PI), 1e-12));
        assert_eq!(overcast.radiance(-DVec3::Z), Rgb::ONE);
    }

    #[test]
    fn no_direction_exceeds_the_bound() {
        for kind in 1..=15 {
            for sun in [DVec3::Z, SUN, DVec3::X] {
                let sky = Sky::new(DVec3::Z, SkyModel::General { kind, sun }, Rgb::ONE, Rgb::ZERO).unwrap();
                for i in 0..2000 {
                    // A spiral over the hemisphere.
                    let sine = (f64::from(i) + 0.5) / 2000.0;
                    let (y, x) = (f64::from(i) * 2.399_963).sin_cos();
                    let direction = DVec3::new(x, y, 0.0) * (1.0 - sine * sine).sqrt() + DVec3::Z * sine;
                    let share = sky.share(direction);
                    assert!((0.0..=1.0).contains(&share), "type {kind}, {direction}: {share}");
                }
                assert!(sky.share(sun.lerp(DVec3::Z, 1e-6).normalize()) <= 1.0);
            }
        }
    }

    #[test]
    fn a_clear_sky_is_bright_around_the_sun() {
        let sky = Sky::new(DVec3::Z, SkyModel::General { kind: 12, sun: SUN }, Rgb::ONE, Rgb::ZERO).unwrap();
        let opposite = DVec3::new(-0.6, 0.0, 0.8);
        assert!(sky.radiance(SUN).x > 5.0 * sky.radiance(opposite).x);
    }

    #[test]
    fn impossible_skies_are_refused() {
        let new = |model, color| Sky::new(DVec3::Z, model, color, Rgb::ZERO);
        assert!(new(SkyModel::General { kind: 0, sun: SUN }, Rgb::ONE).is_none());
        assert!(new(SkyModel::General { kind: 16, sun: SUN }, Rgb::ONE).is_none());
        assert!(new(SkyModel::General { kind: 1, sun: -SUN }, Rgb::ONE).is_none());
        assert!(new(SkyModel::Uniform, -Rgb::ONE).is_none());
        assert!(Sky::new(DVec3::ZERO, SkyModel::Uniform, Rgb::ONE, Rgb::ZERO).is_none());
    }
}
