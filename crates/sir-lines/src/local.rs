//! Local lines: points on a surface and the directions of diffuse light.

use glam::DVec3;
use sir_geom::Barycentric;

use crate::Stream;
use crate::turn::sin_cos_of_turn;

/// A uniform point of the unit sphere: its height is uniform (Archimedes), and so is its longitude.
///
/// Nothing is rejected: a processor would guess wrong each time.
#[inline]
pub fn unit_vector(stream: &mut Stream) -> DVec3 {
    let (u, turn) = (stream.unit(), stream.unit());
    unit_vector_of([u, turn])
}

/// The point of the unit sphere that belongs to a point of the unit square, area for area.
#[inline]
fn unit_vector_of([u, turn]: [f64; 2]) -> DVec3 {
    let (sin, cos) = sin_cos_of_turn(turn);
    let radius = 2.0 * (u * (1.0 - u)).sqrt();
    DVec3::new(radius * cos, radius * sin, 1.0 - 2.0 * u)
}

/// A direction with density `cos θ / π` about a unit normal: the normal plus a uniform point of the unit sphere.
#[inline]
pub fn cosine_direction(normal: DVec3, stream: &mut Stream) -> DVec3 {
    loop {
        let sum = normal + unit_vector(stream);
        // Too short a sum has no direction; leaving it out changes the density by 1e−16.
        if sum.length_squared() > 1e-16 {
            break sum.normalize();
        }
    }
}

/// As [`cosine_direction`], for a point of the unit square instead of random numbers: evenly distributed points become evenly
/// distributed directions.
#[inline]
#[must_use]
pub fn cosine_direction_of(normal: DVec3, point: [f64; 2]) -> DVec3 {
    (normal + unit_vector_of(point)).try_normalize().unwrap_or(normal)
}

/// A uniform point of a triangle: a uniform point of a parallelogram, folded.
#[inline]
pub fn point_on_triangle(stream: &mut Stream) -> Barycentric {
    let (v, w) = (stream.unit(), stream.unit());
    if v + w > 1.0 { Barycentric { v: 1.0 - v, w: 1.0 - w } } else { Barycentric { v, w } }
}

/// The point of a triangle that belongs to a point of the unit square, area for area. Evenly distributed points stay so: nothing
/// is folded (Turk 1990).
#[inline]
#[must_use]
pub fn point_on_triangle_of([s, t]: [f64; 2]) -> Barycentric {
    let root = s.sqrt();
    Barycentric { v: root * (1.0 - t), w: root * t }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Stage, Streams};

    #[test]
    fn cosines_have_the_density_of_diffuse_light() {
        let normal = DVec3::new(1.0, 2.0, -2.0) / 3.0;
        let n = 200_000;
        let streams = Streams::new(5, Stage::FIRST_SHOT);
        let (mut first, mut second) = (0.0, 0.0);
        for i in 0..n {
            let cos = cosine_direction(normal, &mut streams.line(i)).dot(normal);
            assert!(cos >= 0.0);
            first += cos;
            second += cos * cos;
        }
        let n = f64::from(n as u32);
        // E[cos] = 2/3, E[cos²] = 1/2, Var(cos) = 1/18, Var(cos²) = 1/12.
        assert!((first / n - 2.0 / 3.0).abs() < 4.0 * (1.0 / 18.0 / n).sqrt());
        assert!((second / n - 0.5).abs() < 4.0 * (1.0 / 12.0 / n).sqrt());
    }

    #[test]
    fn points_of_a_triangle_are_uniform() {
        let streams = Streams::new(6, Stage::FIRST_SHOT);
        let n = 100_000;
        let mut sum = [0.0; 3];
        for i in 0..n {
            let Barycentric { v, w } = point_on_triangle(&mut streams.line(i));
            assert!(v >= 0.0 && w >= 0.0 && v + w <= 1.0);
            sum = [sum[0] + v, sum[1] + w, sum[2] + v * w];
        }
        let n = f64::from(n as u32);
        // E[v] = 1/3 with variance 1/18; E[vw] = 1/12 with variance 1/90 − 1/144.
        assert!((sum[0] / n - 1.0 / 3.0).abs() < 4.0 * (1.0 / 18.0 / n).sqrt());
        assert!((sum[1] / n - 1.0 / 3.0).abs() < 4.0 * (1.0 / 18.0 / n).sqrt());
        assert!((sum[2] / n - 1.0 / 12.0).abs() < 4.0 * ((1.0 / 90.0 - 1.0 / 144.0) / n).sqrt());
    }

    /// Of a regular grid of points, as many become points of each of four equal parts of a triangle, and the cosines of the
    /// directions have the right moments.
    #[test]
    fn points_of_the_square_keep_their_areas() {
        let n = 400;
        let grid = (0..n * n).map(|k| [k % n, k / n].map(|i| (f64::from(i) + 0.5) / f64::from(n)));
        let normal = DVec3::new(-2.0, 1.0, 2.0) / 3.0;
        let (mut parts, mut cosine, mut square) = ([0.0; 4], 0.0, 0.0);
        for point in grid {
            let Barycentric { v, w } = point_on_triangle_of(point);
            assert!(v >= 0.0 && w >= 0.0 && v + w <= 1.0);
            parts[[v > 0.5, w > 0.5, v + w < 0.5].iter().position(|&within| within).unwrap_or(3)] += 1.0;
            let cos = cosine_direction_of(normal, point).dot(normal);
            (cosine, square) = (cosine + cos, square + cos * cos);
        }
        let all = f64::from(n * n);
        assert!(parts.iter().all(|part| (part / all - 0.25).abs() < 0.002), "{parts:?}");
        assert!((cosine / all - 2.0 / 3.0).abs() < 1e-4 && (square / all - 0.5).abs() < 1e-4);
    }
}
