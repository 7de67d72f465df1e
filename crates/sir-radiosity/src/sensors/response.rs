//! Weight of light by its direction in what a sensor measures.
//!
//! Every sensor integrates radiance times a response: `∫ L(ω) f(ω) dω` over all directions. It does so with *facets*, small
//! surfaces at its position, each of which samples radiance times the clamped cosine to its normal. The cosines of all
//! facets that a direction is in front of add up to `S(ω)`, and light from there counts for each with the weight `f/S`. A
//! plane is a single facet of weight 1. A cylinder has four, at right angles around its axis, with `S = |x| + |y|` for
//! the components `x` and `y` of the direction across the axis. `S` lies between `sin ε` and `√2 sin ε`, so no ray weighs
//! much.

use std::f64::consts::{FRAC_1_PI, FRAC_2_PI};

use glam::DVec3;

/// Kind of irradiance that a sensor measures. All vectors are of unit length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Response {
    /// Irradiance of a plane: `f = cos⁺ θ`.
    Planar {
        /// Normal of the plane.
        normal: DVec3,
    },
    /// Mean irradiance of the lateral surface of a small cylinder: `f = sin ε/π` for the angle `ε` to the axis. It is also
    /// the mean irradiance of all planes through the axis (EN 12665).
    Cylindrical {
        /// Axis of the cylinder.
        axis: DVec3,
    },
    /// Mean irradiance of the curved surface of a small half cylinder: `f = sin ε (1 + cos α)/π` for the angle `α` between
    /// the directions of the light and of the half cylinder across the axis (EN 13201-3).
    SemiCylindrical {
        /// Axis of the cylinder.
        axis: DVec3,
        /// Direction of the half cylinder, perpendicular to the axis.
        direction: DVec3,
    },
}

impl Response {
    /// Returns the normals of the facets.
    pub(crate) fn facets(self) -> Vec<DVec3> {
        let Some([x, y]) = self.across() else { return vec![self.direction()] };
        vec![x, y, -x, -y]
    }

    /// Returns the number of facets.
    pub(crate) fn facet_count(self) -> u64 {
        if self.across().is_some() { 4 } else { 1 }
    }

    /// Returns the normal, the axis or the direction across the axis.
    pub(crate) fn direction(self) -> DVec3 {
        match self {
            Self::Planar { normal } => normal,
            Self::Cylindrical { axis } => axis,
            Self::SemiCylindrical { direction, .. } => direction,
        }
    }

    /// Returns the weight `f` of light from a direction, a unit vector.
    pub(crate) fn value(self, direction: DVec3) -> f64 {
        let Some([x, y]) = self.components(direction) else {
            return direction.dot(self.direction()).max(0.0);
        };
        let sine = libm::sqrt(x * x + y * y);
        match self {
            Self::SemiCylindrical { .. } => FRAC_1_PI * (sine + x).max(0.0),
            _ => FRAC_1_PI * sine,
        }
    }

    /// Returns the weight `f/S` of light from a direction that a facet has measured.
    pub(crate) fn facet_weight(self, direction: DVec3) -> f64 {
        let Some([x, y]) = self.components(direction) else { return 1.0 };
        let sum = x.abs() + y.abs();
        if sum > 0.0 { self.value(direction) / sum } else { 0.0 }
    }

    /// Returns the largest weight of light that a facet has measured.
    pub(crate) fn largest_facet_weight(self) -> f64 {
        match self {
            Self::Planar { .. } => 1.0,
            Self::Cylindrical { .. } => FRAC_1_PI,
            Self::SemiCylindrical { .. } => FRAC_2_PI,
        }
    }

    /// Returns the components of a direction across the axis of a cylinder; `None` for a plane.
    fn components(self, direction: DVec3) -> Option<[f64; 2]> {
        self.across().map(|across| across.map(|across| across.dot(direction)))
    }

    /// Returns two directions across the axis of a cylinder, at right angles; `None` for a plane.
    fn across(self) -> Option<[DVec3; 2]> {
        match self {
            Self::Planar { .. } => None,
            Self::Cylindrical { axis } => Some(axis.any_orthonormal_pair().into()),
            Self::SemiCylindrical { axis, direction } => Some([direction, axis.cross(direction)]),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    const AXIS: DVec3 = DVec3::new(1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0);
    const ACROSS: DVec3 = DVec3::new(2.0 / 3.0, 1.0 / 3.0, -2.0 / 3.0);

    fn directions() -> impl Iterator<Item = DVec3> {
        let ring = |i: u32| (0..24).map(move |k| (f64::from(i) * 0.13 + 0.05, f64::from(k) * 0.261));
        (0..24).flat_map(ring).map(|(polar, azimuth)| {
            let ((sin, cos), (s, c)) = (libm::sincos(polar), libm::sincos(azimuth));
            DVec3::new(sin * c, sin * s, cos)
        })
    }

    /// The definition: the mean over normals around the axis, by the midpoint rule.
    #[test]
    fn cylinders_are_means_of_planes() {
        let normal = |angle: f64| {
            let (sin, cos) = libm::sincos(angle);
            cos * ACROSS + sin * AXIS.cross(ACROSS)
        };
        for direction in directions() {
            let mean = |from: f64, to: f64| {
                let count = 2000;
                let angles = (0..count).map(|i| from + (to - from) * (f64::from(i) + 0.5) / f64::from(count));
                let planes = angles.map(|angle| Response::Planar { normal: normal(angle) }.value(direction));
                planes.sum::<f64>() / f64::from(count)
            };
            let whole = Response::Cylindrical { axis: AXIS }.value(direction);
            let half = Response::SemiCylindrical { axis: AXIS, direction: ACROSS }.value(direction);
            assert!((whole - mean(-PI, PI)).abs() < 1e-5, "{direction}: {whole}");
            assert!((half - mean(-0.5 * PI, 0.5 * PI)).abs() < 1e-5, "{direction}: {half}");
        }
    }

    #[test]
    fn facets_add_up_to_the_response_and_have_bounded_weights() {
        for response in [
            Response::Planar { normal: ACROSS },
            Response::Cylindrical { axis: AXIS },
            Response::SemiCylindrical { axis: AXIS, direction: ACROSS },
        ] {
            assert_eq!(response.facets().len() as u64, response.facet_count());
            for direction in directions() {
                let cosines = response.facets().into_iter().map(|normal| normal.dot(direction).max(0.0));
                let sum = cosines.map(|cosine| cosine * response.facet_weight(direction)).sum::<f64>();
                assert!((sum - response.value(direction)).abs() < 1e-12, "{response:?} {direction}");
                assert!(response.facet_weight(direction) <= response.largest_facet_weight() + 1e-12);
            }
            assert!(response.facet_weight(AXIS).is_finite());
        }
    }
}
