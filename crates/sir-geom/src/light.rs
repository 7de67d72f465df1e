//! Lights without a surface: point lights and parallel light.

use std::f64::consts::PI;
use std::sync::Arc;

use glam::{DMat3, DVec3};
use sir_photometry::IntensityDistribution;

use crate::color::Rgb;

/// A point light, or a light at infinite distance.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    /// Name given by the author, or an empty string.
    pub name: String,
    /// Kind, with its parameters.
    pub kind: LightKind,
}

/// Kind of a [`Light`], with its parameters.
#[derive(Clone, Debug, PartialEq)]
pub enum LightKind {
    /// Light from a point.
    Point {
        /// Position.
        position: DVec3,
        /// Radiant intensity `I` per band \[W/sr\] in the direction in which it is largest.
        intensity: Rgb,
        /// Angular distribution of the intensity.
        spread: Spread,
    },
    /// Parallel light, such as that of the sun.
    Distant {
        /// Direction in which the light travels, of unit length.
        direction: DVec3,
        /// Irradiance per band \[W/m²\] of a surface that faces it.
        irradiance: Rgb,
    },
}

/// Angular distribution of the intensity of a point light.
#[derive(Clone, Debug, PartialEq)]
pub enum Spread {
    /// Equal in all directions.
    Isotropic,
    /// Proportional to the cosine of the angle to an axis, and zero behind: a small diffuse surface.
    Lambertian {
        /// Axis, of unit length.
        axis: DVec3,
    },
    /// Full inside the inner cone and zero outside the outer one. Between them the intensity has the factor `t²`, where
    /// `t` falls from 1 to 0 linearly with the cosine of the angle to the axis, as `KHR_lights_punctual` of glTF
    /// recommends.
    Spot {
        /// Axis, of unit length.
        axis: DVec3,
        /// Cosine of half the opening angle of the inner cone.
        inner: f64,
        /// Cosine of half the opening angle of the outer cone, below `inner`.
        outer: f64,
    },
    /// As tabulated in a photometric file.
    Tabulated(Tabulated),
}

/// Tabulated angular distribution, of a luminaire in an orientation.
#[derive(Clone, Debug, PartialEq)]
pub struct Tabulated {
    /// Distribution, with a largest intensity of 1.
    shape: Arc<IntensityDistribution>,
    /// Axes of the luminaire.
    frame: DMat3,
}

impl Tabulated {
    /// Returns the distribution of a luminaire whose axes are the columns of `frame`, a rotation.
    #[must_use]
    pub fn new(distribution: IntensityDistribution, frame: DMat3) -> Self {
        let largest = distribution.largest();
        Self { shape: Arc::new(distribution.scaled(1.0 / largest)), frame }
    }

    /// Returns the same distribution of a luminaire in another orientation.
    #[must_use]
    pub fn turned(&self, frame: DMat3) -> Self {
        Self { shape: Arc::clone(&self.shape), frame }
    }

    /// Returns the axes of the luminaire, which is aimed at −z and has its length along x.
    #[must_use]
    pub fn frame(&self) -> DMat3 {
        self.frame
    }

    /// Returns the direction that belongs to a point of the unit square, with a density in proportion to the intensity.
    #[must_use]
    pub fn sample(&self, point: [f64; 2]) -> DVec3 {
        self.frame * self.shape.sample(point)
    }

    fn share(&self, direction: DVec3) -> f64 {
        self.shape.intensity(self.frame.transpose() * direction)
    }
}

/// Unoccluded light that arrives at a point from a light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arrival {
    /// Unit vector toward the light.
    pub towards: DVec3,
    /// Distance to the light; infinite for parallel light.
    pub distance: f64,
    /// Irradiance per band \[W/m²\] of a surface that faces the light.
    pub irradiance: Rgb,
}

impl Spread {
    /// Returns a spot about an axis of unit length, with full intensity up to the angle `inner` \[rad\] and none beyond
    /// `outer` \[rad\]. Equal angles give the sharpest possible edge. The result has the same bits on all machines.
    ///
    /// Returns `None` unless `0 ≤ inner ≤ outer ≤ π` and `outer` is at least 10⁻⁴.
    #[must_use]
    pub fn spot(axis: DVec3, inner: f64, outer: f64) -> Option<Self> {
        if !(0.0 <= inner && inner <= outer && (1e-4..=PI).contains(&outer)) {
            return None;
        }
        let edge = libm::cos(outer);
        // The ring between the cones gets at least a millionth of the solid angle of the outer cone.
        let sharp = edge + 1e-6 * (1.0 - edge);
        Some(Self::Spot { axis, inner: libm::cos(inner).max(sharp), outer: edge })
    }

    /// Returns the intensity in a direction of unit length relative to the largest intensity, from 0 to 1.
    #[must_use]
    pub fn share(&self, direction: DVec3) -> f64 {
        match *self {
            Self::Isotropic => 1.0,
            Self::Lambertian { axis } => axis.dot(direction).max(0.0),
            Self::Spot { axis, inner, outer } => {
                let t = ((axis.dot(direction) - outer) / (inner - outer)).clamp(0.0, 1.0);
                t * t
            }
            Self::Tabulated(ref tabulated) => tabulated.share(direction),
        }
    }

    /// Returns the integral of [`share`](Self::share) over all directions \[sr\]: the power divided by the largest
    /// intensity.
    #[must_use]
    pub fn solid_angle(&self) -> f64 {
        match *self {
            Self::Isotropic => 4.0 * PI,
            Self::Lambertian { .. } => PI,
            Self::Spot { inner, outer, .. } => 2.0 * PI * ((1.0 - inner) + (inner - outer) / 3.0),
            Self::Tabulated(ref tabulated) => tabulated.shape.flux(),
        }
    }
}

impl LightKind {
    /// Checks the parameters. The error is the name of an invalid field and the rule that it violates.
    pub(crate) fn check(&self) -> Result<(), (&'static str, &'static str)> {
        let color = |what, color: Rgb| {
            let good = color.is_finite() && color.min_element() >= 0.0;
            good.then_some(()).ok_or((what, "it must be finite and not negative"))
        };
        let unit = |what, vector: DVec3| {
            let good = (vector.length_squared() - 1.0).abs() < 1e-9;
            good.then_some(()).ok_or((what, "it must be of unit length"))
        };
        match *self {
            Self::Point { position, intensity, ref spread } => {
                color("intensity", intensity)?;
                if !position.is_finite() {
                    return Err(("position", "it must be finite"));
                }
                match *spread {
                    Spread::Isotropic => Ok(()),
                    Spread::Tabulated(ref tabulated) => {
                        let frame = tabulated.frame;
                        let is_rotation = (frame.transpose() * frame).abs_diff_eq(DMat3::IDENTITY, 1e-9)
                            && frame.determinant() > 0.0;
                        is_rotation.then_some(()).ok_or(("frame", "it must be a rotation"))
                    }
                    Spread::Lambertian { axis } => unit("axis", axis),
                    Spread::Spot { axis, inner, outer } => {
                        let good = -1.0 <= outer && outer < inner && inner <= 1.0;
                        unit("axis", axis)?;
                        good.then_some(()).ok_or(("cone", "the inner cone must be inside the outer cone"))
                    }
                }
            }
            Self::Distant { direction, irradiance } => {
                unit("direction", direction)?;
                color("irradiance", irradiance)
            }
        }
    }

    /// Multiplies the intensity or irradiance by a factor per band.
    pub(crate) fn dim(&mut self, factor: Rgb) {
        match self {
            Self::Point { intensity: strength, .. } | Self::Distant { irradiance: strength, .. } => {
                *strength *= factor;
            }
        }
    }

    /// Returns the unoccluded light that arrives at a point; `None` at the position of the light, and where it sends
    /// nothing.
    #[must_use]
    pub fn arrival(&self, point: DVec3) -> Option<Arrival> {
        let arrival = match *self {
            Self::Point { position, intensity, ref spread } => {
                let distance = position.distance(point);
                let towards = (position - point).try_normalize()?;
                let irradiance = intensity * (spread.share(-towards) / (distance * distance));
                Arrival { towards, distance, irradiance }
            }
            Self::Distant { direction, irradiance } => {
                Arrival { towards: -direction, distance: f64::INFINITY, irradiance }
            }
        };
        (arrival.irradiance != Rgb::ZERO).then_some(arrival)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_add_up_to_the_solid_angle() {
        let axis = DVec3::new(2.0, -1.0, 2.0) / 3.0;
        let spreads =
            [Spread::Isotropic, Spread::Lambertian { axis }, Spread::Spot { axis, inner: 0.9, outer: 0.6 }];
        let across = axis.any_orthonormal_vector();
        for spread in spreads {
            let n = 100_000;
            let sum: f64 = (0..n)
                .map(|i| {
                    let cos = 2.0 * (f64::from(i) + 0.5) / f64::from(n) - 1.0;
                    spread.share(axis * cos + across * (1.0 - cos * cos).sqrt())
                })
                .sum();
            let solid_angle = 4.0 * PI * sum / f64::from(n);
            assert!((solid_angle / spread.solid_angle() - 1.0).abs() < 1e-4, "{spread:?}: {solid_angle}");
        }
    }

    #[test]
    fn light_falls_off_with_the_square_of_the_distance() {
        let kind = LightKind::Point {
            position: DVec3::Z * 3.0,
            intensity: Rgb::splat(1000.0),
            spread: Spread::Lambertian { axis: -DVec3::Z },
        };
        let below = kind.arrival(DVec3::ZERO).unwrap();
        assert!((below.irradiance.x - 1000.0 / 9.0).abs() < 1e-12 && below.towards == DVec3::Z);
        assert_eq!(kind.arrival(DVec3::Z * 4.0), None);
        assert_eq!(kind.arrival(DVec3::Z * 3.0), None);
    }
}
