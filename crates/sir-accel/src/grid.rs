//! The integer grid on which crossings are decided.

use glam::DVec3;
use sir_types::{BoundingSphere, Line};

/// Radius of the bounding sphere \[steps of the vertex grid\].
pub(crate) const RADIUS: f64 = (1u32 << 30) as f64;
/// Steps of the line grid per step of the vertex grid.
const FINE: f64 = 256.0;
/// Length of a unit direction \[steps of the grid of directions\].
const UNIT: f64 = (1u64 << 38) as f64;
/// Largest distance of the origin of a line from the center \[radii\], so that 128 bits hold every determinant.
const REACH: f64 = 1.75;

/// Map between the scene and the grid.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Grid {
    center: DVec3,
    /// Steps per unit of length.
    scale: f64,
    /// Length of a step.
    step: f64,
}

/// A line on the grid. Doubles and integers represent its coordinates exactly.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GridLine {
    /// A point of the line \[steps\], in multiples of 1/256.
    pub(crate) origin: DVec3,
    /// Direction, of length one up to 2⁻³⁷, in multiples of 2⁻³⁸.
    pub(crate) direction: DVec3,
    /// Distance by which the origin was moved along the line \[steps\].
    pub(crate) start: f64,
}

/// Returns the nearest integer, for numbers below 2⁵¹: the sum has no bits for the fraction, so it is rounded off.
#[inline(always)]
fn nearest(x: f64) -> f64 {
    const SHIFT: f64 = 1.5 * (1u64 << 52) as f64;
    (x + SHIFT) - SHIFT
}

impl Grid {
    pub(crate) fn new(sphere: BoundingSphere) -> Self {
        // Two steps less than `RADIUS`, so that differences of coordinates fit in 32 bits.
        let scale = (RADIUS - 2.0) / sphere.radius;
        Self { center: sphere.center, scale, step: 1.0 / scale }
    }

    /// Returns the origin of the coordinates of the scene \[steps\].
    pub(crate) fn origin(&self) -> DVec3 {
        -self.center * self.scale
    }

    /// Returns the grid point nearest to a point of the scene.
    pub(crate) fn vertex(&self, p: DVec3) -> [i32; 3] {
        ((p - self.center) * self.scale).to_array().map(|x| nearest(x) as i32)
    }

    /// Returns the grid line nearest to a line; `None` if the line passes far from the scene, is not finite, or has a
    /// direction much longer than one.
    #[inline(always)]
    pub(crate) fn line(&self, line: &Line) -> Option<GridLine> {
        let mut origin = (line.origin - self.center) * self.scale;
        let mut start = 0.0;
        let is_near = |origin: DVec3| origin.length_squared() <= (REACH * RADIUS) * (REACH * RADIUS);
        if !is_near(origin) {
            // The origin is far away: move it to where the line comes near.
            start = -origin.dot(line.direction) - 1.25 * RADIUS;
            origin += start * line.direction;
            if !is_near(origin) {
                return None;
            }
        }
        // A longer direction would overflow the exact test.
        let length_squared = line.direction.length_squared();
        if length_squared > 2.0 || length_squared.is_nan() {
            return None;
        }
        // The same operations for all six numbers, so that the compiler uses vector instructions.
        let [o, d] = [origin.to_array(), line.direction.to_array()];
        let fine = [FINE, FINE, FINE, 0.0, UNIT, UNIT, UNIT, 0.0];
        let numbers = [o[0], o[1], o[2], 0.0, d[0], d[1], d[2], 0.0];
        let coarse = [1.0 / FINE, 1.0 / FINE, 1.0 / FINE, 0.0, 1.0 / UNIT, 1.0 / UNIT, 1.0 / UNIT, 0.0];
        let n: [f64; 8] = std::array::from_fn(|i| nearest(numbers[i] * fine[i]) * coarse[i]);
        let (origin, direction) = (DVec3::new(n[0], n[1], n[2]), DVec3::new(n[4], n[5], n[6]));
        Some(GridLine { origin, direction, start })
    }

    /// Converts a length of the scene to steps.
    #[inline]
    pub(crate) fn steps(&self, length: f64) -> f64 {
        length * self.scale
    }

    /// Converts a distance in steps to a length of the scene.
    #[inline]
    pub(crate) fn length(&self, steps: f64) -> f64 {
        steps * self.step
    }
}

impl GridLine {
    /// Returns a line that passes far from the scene.
    pub(crate) fn far() -> Self {
        Self { origin: DVec3::X * (REACH * RADIUS), direction: DVec3::Y, start: 0.0 }
    }

    /// Returns the side of the line on which the edge from `a` to `b` passes: the exact sign of
    /// `d · ((a − o) × (b − o))`. If that is zero, the line is shifted by an infinitesimal. The result is zero only for
    /// an edge parallel to the line (in a plane with it); no triangle with such an edge can be crossed.
    #[cold]
    pub(crate) fn exact_side(&self, a: [i32; 3], b: [i32; 3]) -> i32 {
        let o = self.origin.to_array().map(|x| (x * FINE) as i128);
        let d = self.direction.to_array().map(|x| (x * UNIT) as i128);
        let from_origin =
            |p: [i32; 3]| -> [i128; 3] { std::array::from_fn(|k| i128::from(p[k]) * (FINE as i128) - o[k]) };
        let cross = |p: [i128; 3], q: [i128; 3]| {
            [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]]
        };
        let product = cross(from_origin(a), from_origin(b));
        // |d| ≤ 2³⁸, |p − o| < 2⁴⁰ per component: each term below 2¹²⁰.
        let determinant = d[0] * product[0] + d[1] * product[1] + d[2] * product[2];
        if determinant != 0 {
            return determinant.signum() as i32;
        }
        // Derivative of the determinant with respect to a shift of the line along each axis: (a − b) × d.
        let edge = std::array::from_fn(|k| i128::from(a[k]) - i128::from(b[k]));
        cross(edge, d).into_iter().find(|&x| x != 0).map_or(0, |x| x.signum() as i32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid() -> Grid {
        Grid::new(BoundingSphere { center: DVec3::new(100.0, -7.0, 3.0), radius: 25.0 })
    }

    #[test]
    fn lines_from_far_away_start_near_the_scene() {
        let g = grid();
        let direction = DVec3::new(2.0, -1.0, 2.0) / 3.0;
        let near = DVec3::new(110.0, -7.0, 3.0);
        for distance in [1e3, 1e6, 1e9] {
            let origin = near - distance * direction;
            let line = g.line(&Line { origin, direction }).unwrap();
            assert!(line.origin.length() < 2.0 * RADIUS);
            let back = g.length(line.start) - distance;
            assert!(back.abs() < 60.0, "{back}");
            let away = g.line(&Line { origin, direction: -direction }).unwrap();
            assert!(away.start < 0.0, "the scene is behind the origin");
        }
        let beside = Line { origin: near + DVec3::X * 1e4, direction: DVec3::Y };
        assert!(g.line(&beside).is_none());
    }

    #[test]
    fn exact_sides_are_antisymmetric_and_perturbed_when_zero() {
        let g = grid();
        let line = g.line(&Line { origin: g.center, direction: DVec3::Z }).unwrap();
        let (a, b) = ([-5, 0, 9], [7, 0, -3]);
        // The line meets this edge; the shift along x does not separate them, the one along y does.
        assert_ne!(line.exact_side(a, b), 0);
        assert_eq!(line.exact_side(a, b), -line.exact_side(b, a));
        // An edge on the line itself has no side.
        assert_eq!(line.exact_side([0, 0, 1], [0, 0, 5]), 0);
    }
}
