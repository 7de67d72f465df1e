//! Local lines: points on a surface and the directions of diffuse light.

use glam::DVec3;
use sir_geom::Barycentric;

use crate::stream::Stream;
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

/// A direction about an axis of unit length with the density of a spot: uniform where the cosine of the angle to the axis is above `inner`,
/// in proportion to `t²` where it falls to `outer`, with `t` linear in the cosine.
///
/// `t` has the density `3t²` of the largest of three uniform numbers, so there is no cube root to take.
#[inline]
pub fn spot_direction(axis: DVec3, inner: f64, outer: f64, stream: &mut Stream) -> DVec3 {
    let (full, ring) = (1.0 - inner, (inner - outer) / 3.0);
    // One minus the cosine, which keeps its digits in a narrow cone.
    let below = if (full + ring) * stream.unit() < full {
        full * stream.unit()
    } else {
        let t = stream.unit().max(stream.unit()).max(stream.unit());
        full + (inner - outer) * (1.0 - t)
    };
    let (sin, cos) = sin_cos_of_turn(stream.unit());
    let (x, y) = axis.any_orthonormal_pair();
    axis * (1.0 - below) + (x * cos + y * sin) * (below * (2.0 - below)).sqrt()
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
    use crate::stream::{Stage, Streams};

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

    /// Means of the cosine and of its distance from the outer one, squared, from the density; errors from the sample itself.
    #[test]
    fn spots_have_the_density_of_their_rings() {
        let axis = DVec3::new(2.0, -1.0, 2.0) / 3.0;
        let streams = Streams::new(8, Stage::FIRST_SHOT);
        for (inner, outer) in [(0.9, 0.5), (1.0, 0.0), (0.2, -1.0)] {
            let n = 100_000;
            let t = |c: f64| (c - outer) / (inner - outer);
            // Moments of t in [0, 1], where its density is 3t², and above, where it is uniform.
            let (full, ring) = (1.0 - inner, (inner - outer) / 3.0);
            let top = t(1.0);
            let moment = |k: i32| {
                let above =
                    if full > 0.0 { (top.powi(k + 1) - 1.0) / (f64::from(k + 1) * (top - 1.0)) } else { 0.0 };
                (full * above + ring * 3.0 / f64::from(k + 3)) / (full + ring)
            };
            let mut sums = [0.0; 2];
            let mut side = DVec3::ZERO;
            for i in 0..n {
                let direction = spot_direction(axis, inner, outer, &mut streams.line(i));
                assert!((direction.length() - 1.0).abs() < 1e-12);
                let t = t(direction.dot(axis));
                assert!((-1e-12..=top + 1e-12).contains(&t));
                sums = [sums[0] + t, sums[1] + t * t];
                side += direction - axis * direction.dot(axis);
            }
            let n = f64::from(n as u32);
            for (k, sum) in (1..).zip(sums) {
                let error = ((moment(2 * k) - moment(k).powi(2)) / n).sqrt();
                assert!((sum / n - moment(k)).abs() < 4.0 * error, "{inner}, {outer}: moment {k}");
            }
            assert!(side.length() / n < 4.0 / n.sqrt());
        }
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
