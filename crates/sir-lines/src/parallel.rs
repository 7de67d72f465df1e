//! Parallel lines through a box.

use glam::DVec3;
use sir_types::{BoundingBox, Line};

use crate::domain::axis_of;

/// Lines of one direction that meet a box, uniform in the plane perpendicular to them.
///
/// They enter through the faces whose outward normal points against the direction, at most three, in proportion to the
/// projected areas of these faces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParallelLines {
    bounds: BoundingBox,
    direction: DVec3,
    /// Projected area of a face perpendicular to each axis.
    areas: DVec3,
}

impl ParallelLines {
    /// Returns the lines through a box with a direction of unit length.
    #[must_use]
    pub fn through(bounds: BoundingBox, direction: DVec3) -> Self {
        Self { bounds, direction, areas: bounds.face_areas() * direction.abs() }
    }

    /// Returns the box.
    #[must_use]
    pub fn bounds(&self) -> BoundingBox {
        self.bounds
    }

    /// Returns the direction, of unit length.
    #[must_use]
    pub fn direction(&self) -> DVec3 {
        self.direction
    }

    /// Returns the projected area of the box along the direction \[m²\].
    #[must_use]
    pub fn area(&self) -> f64 {
        self.areas.element_sum()
    }

    /// Maps a point of the unit cube to a line with its origin on the box. The coordinates choose the face (one) and
    /// the position on it (two).
    #[inline]
    #[must_use]
    pub fn line(&self, [u, s, t]: [f64; 3]) -> Line {
        let axis = axis_of(self.area() * u, self.areas);
        let mut share = DVec3::ZERO;
        share[(axis + 1) % 3] = s;
        share[(axis + 2) % 3] = t;
        share[axis] = if self.direction[axis] > 0.0 { 0.0 } else { 1.0 };
        Line { origin: self.bounds.min + share * self.bounds.size(), direction: self.direction }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stream::{Purpose, Streams};

    /// The share of the lines that meet a ball in the box is the ratio of the projected areas.
    #[test]
    fn lines_are_uniform_across_their_direction() {
        let bounds = BoundingBox { min: DVec3::new(-1.0, -2.0, -3.0), max: DVec3::new(1.0, 2.0, 3.0) };
        let streams = Streams::new(3, Purpose::FIRST_SHOT);
        for direction in [DVec3::new(2.0, -1.0, -2.0) / 3.0, DVec3::new(0.6, 0.8, 0.0), DVec3::Z] {
            let lines = ParallelLines::through(bounds, direction);
            let expected = std::f64::consts::PI / lines.area();
            for center in [DVec3::ZERO, DVec3::new(0.0, 1.0, -2.0)] {
                let n = 100_000;
                let meets = |i: &u64| {
                    let origin = lines.line(streams.line(*i).point()).origin;
                    (origin - center).cross(direction).length_squared() < 1.0
                };
                let share = (0..n).filter(meets).count() as f64 / n as f64;
                let error = (expected * (1.0 - expected) / n as f64).sqrt();
                assert!((share - expected).abs() < 4.0 * error, "{direction}, {center}: {share}");
            }
        }
    }
}
