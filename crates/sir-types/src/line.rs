//! Lines, and points on triangles.

use glam::DVec3;

/// A directed line, or a ray from its origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// A point of the line.
    pub origin: DVec3,
    /// Direction, of unit length.
    pub direction: DVec3,
}

impl Line {
    /// Returns the point at signed distance `t` from the origin.
    #[must_use]
    pub fn at(&self, t: f64) -> DVec3 {
        self.origin + t * self.direction
    }
}

/// A point of a triangle `(a, b, c)`: `(1 − v − w) a + v b + w c`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Barycentric {
    /// Weight of the second corner.
    pub v: f64,
    /// Weight of the third corner.
    pub w: f64,
}

impl Barycentric {
    /// Returns the coordinates of a point in the plane of the triangle with the given corners; for any other point,
    /// those of its projection onto the plane.
    #[must_use]
    pub fn of(point: DVec3, [a, b, c]: [DVec3; 3]) -> Self {
        let normal = (b - a).cross(c - a);
        let scale = 1.0 / normal.length_squared();
        let to = point - a;
        Self { v: to.cross(c - a).dot(normal) * scale, w: (b - a).cross(to).dot(normal) * scale }
    }

    /// Returns the point with these coordinates in the triangle with the given corners.
    #[must_use]
    pub fn point(self, [a, b, c]: [DVec3; 3]) -> DVec3 {
        (1.0 - self.v - self.w) * a + self.v * b + self.w * c
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_of_a_point_give_the_point() {
        let corners = [DVec3::new(1.0, 2.0, 3.0), DVec3::new(-1.0, 0.5, 2.0), DVec3::new(0.0, 7.0, -4.0)];
        for (v, w) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (0.2, 0.5), (-0.3, 1.7)] {
            let found = Barycentric::of(Barycentric { v, w }.point(corners), corners);
            assert!((found.v - v).abs() < 1e-12 && (found.w - w).abs() < 1e-12, "{found:?}");
        }
    }
}
