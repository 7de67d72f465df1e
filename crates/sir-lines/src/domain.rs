//! Convex bodies from which global lines are drawn.

use sir_geom::{BoundingSphere, Line};

use crate::{Forecast, Stream, unit_vector};

/// A convex body around the scene, and the uniform (isotropic) lines through it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Domain {
    /// A sphere. A line through two independent uniform points of a sphere is a uniform line
    /// (Santaló 1976; used for radiosity by Sbert 1993).
    Sphere(BoundingSphere),
}

impl Domain {
    /// A random line; its origin is on the surface of the body and its direction points inside.
    #[inline]
    pub fn sample(&self, stream: &mut Stream) -> Line {
        match self {
            Self::Sphere(sphere) => loop {
                let (a, b) = (unit_vector(stream), unit_vector(stream));
                if let Some(direction) = (b - a).try_normalize() {
                    break Line { origin: sphere.centre + sphere.radius * a, direction };
                }
            },
        }
    }

    /// Surface of the body.
    #[must_use]
    pub fn surface(&self) -> f64 {
        match self {
            Self::Sphere(sphere) => sphere.surface_area(),
        }
    }

    /// What to expect of this number of lines.
    #[must_use]
    pub fn forecast(&self, lines: u64) -> Forecast {
        Forecast { lines, surface: self.surface() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Stage, Streams};
    use glam::DVec3;

    /// The mean chord of uniform lines is 4V/S = 4R/3 (Cauchy), and their direction is uniform.
    #[test]
    fn chords_and_directions_are_those_of_uniform_lines() {
        let sphere = BoundingSphere { centre: DVec3::new(1.0, -2.0, 3.0), radius: 2.0 };
        let streams = Streams::new(3, Stage::GLOBAL);
        let n = 200_000;
        let (mut chord, mut chord2) = (0.0, 0.0);
        let mut direction = DVec3::ZERO;
        let mut squares = DVec3::ZERO;
        for i in 0..n {
            let line = Domain::Sphere(sphere).sample(&mut streams.line(i));
            assert!((line.direction.length() - 1.0).abs() < 1e-14);
            let length = 2.0 * (sphere.centre - line.origin).dot(line.direction);
            chord += length;
            chord2 += length * length;
            direction += line.direction;
            squares += line.direction * line.direction;
        }
        let n = n as f64;
        let mean = chord / n;
        let sigma = ((chord2 / n - mean * mean) / n).sqrt();
        assert!((mean - 8.0 / 3.0).abs() < 4.0 * sigma, "mean chord {mean} ± {sigma}");
        for axis in 0..3 {
            assert!((direction[axis] / n).abs() < 4.0 * (1.0 / (3.0 * n)).sqrt());
            // Var(cos²) = 1/5 − 1/9.
            assert!((squares[axis] / n - 1.0 / 3.0).abs() < 4.0 * (4.0 / 45.0 / n).sqrt());
        }
    }
}
