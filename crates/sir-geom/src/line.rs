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
    /// The point at signed distance `t` from the origin.
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
    /// The point with these coordinates in the triangle with the given corners.
    #[must_use]
    pub fn point(self, [a, b, c]: [DVec3; 3]) -> DVec3 {
        (1.0 - self.v - self.w) * a + self.v * b + self.w * c
    }
}
