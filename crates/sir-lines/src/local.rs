//! Samplers for local lines: points on a triangle, and directions of isotropic, diffuse and spot sources.

use glam::DVec3;
use sir_types::Barycentric;

use crate::turn::sin_cos_of_turn;

/// Maps a point of the unit square to a point of the unit sphere. The map preserves area: the height is linear in the
/// first coordinate (Archimedes), the longitude in the second.
#[inline]
#[must_use]
pub fn unit_vector([u, turn]: [f64; 2]) -> DVec3 {
    let (sin, cos) = sin_cos_of_turn(turn);
    let radius = 2.0 * (u * (1.0 - u)).sqrt();
    DVec3::new(radius * cos, radius * sin, 1.0 - 2.0 * u)
}

/// Maps a point of the unit square to a direction with the density `cos θ / π` about a unit normal: the normalized sum
/// of the normal and a point of the unit sphere. The map preserves low discrepancy.
///
/// Returns the normal itself if the sum is too short to be normalized. For random points, that has a probability of
/// 2.5 · 10⁻¹⁷.
#[inline]
#[must_use]
pub fn cosine_direction(normal: DVec3, point: [f64; 2]) -> DVec3 {
    let sum = normal + unit_vector(point);
    if sum.length_squared() > 1e-16 { sum.normalize() } else { normal }
}

/// Maps a point of the unit cube to a direction of a spot light about an axis of unit length. The density is uniform
/// where the cosine of the angle to the axis is above `inner`, and in proportion to `t²` between there and `outer`,
/// where `t` is linear in the cosine: 1 at `inner`, 0 at `outer`.
///
/// The first coordinate chooses the inner cone or the ring around it. The cone uses the next two coordinates, the ring
/// the next four. `t` has the density `3t²` and is sampled as the largest of three uniform numbers, which avoids a cube
/// root.
#[inline]
#[must_use]
pub fn spot_direction(axis: DVec3, inner: f64, outer: f64, [choice, a, b, c, d]: [f64; 5]) -> DVec3 {
    let (full, ring) = (1.0 - inner, (inner - outer) / 3.0);
    // `below` is one minus the cosine, which does not lose precision in a narrow cone.
    let (below, turn) = if (full + ring) * choice < full {
        (full * a, b)
    } else {
        let t = a.max(b).max(c);
        (full + (inner - outer) * (1.0 - t), d)
    };
    let (sin, cos) = sin_cos_of_turn(turn);
    let (x, y) = axis.any_orthonormal_pair();
    axis * (1.0 - below) + (x * cos + y * sin) * (below * (2.0 - below)).sqrt()
}

/// Maps a point of the unit square to a point of a triangle: the square is mapped to a parallelogram, which is folded.
/// The map preserves area and needs no square root, but it is not continuous. Use [`continuous_point_on_triangle`] for
/// low-discrepancy points.
#[inline]
#[must_use]
pub fn point_on_triangle([v, w]: [f64; 2]) -> Barycentric {
    if v + w > 1.0 { Barycentric { v: 1.0 - v, w: 1.0 - w } } else { Barycentric { v, w } }
}

/// Maps a point of the unit square to a point of a triangle by a continuous map that preserves area (Turk 1990), and
/// therefore low discrepancy.
#[inline]
#[must_use]
pub fn continuous_point_on_triangle([s, t]: [f64; 2]) -> Barycentric {
    let root = s.sqrt();
    Barycentric { v: root * (1.0 - t), w: root * t }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stream::{Purpose, Streams};

    #[test]
    fn cosines_have_the_density_of_diffuse_light() {
        let normal = DVec3::new(1.0, 2.0, -2.0) / 3.0;
        let n = 200_000;
        let streams = Streams::new(5, Purpose::FIRST_SHOT);
        let (mut first, mut second) = (0.0, 0.0);
        for i in 0..n {
            let cos = cosine_direction(normal, streams.line(i).point()).dot(normal);
            assert!(cos >= 0.0);
            first += cos;
            second += cos * cos;
        }
        let n = f64::from(n as u32);
        // E[cos] = 2/3, E[cos²] = 1/2, Var(cos) = 1/18, Var(cos²) = 1/12.
        assert!((first / n - 2.0 / 3.0).abs() < 4.0 * (1.0 / 18.0 / n).sqrt());
        assert!((second / n - 0.5).abs() < 4.0 * (1.0 / 12.0 / n).sqrt());
    }

    /// First and second moments of `t` against the density, within four standard errors.
    #[test]
    fn spots_have_the_density_of_their_rings() {
        let axis = DVec3::new(2.0, -1.0, 2.0) / 3.0;
        let streams = Streams::new(8, Purpose::FIRST_SHOT);
        for (inner, outer) in [(0.9, 0.5), (1.0, 0.0), (0.2, -1.0)] {
            let n = 100_000;
            let t = |c: f64| (c - outer) / (inner - outer);
            // Moments of t: its density is 3t² in [0, 1], and uniform above.
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
                let direction = spot_direction(axis, inner, outer, streams.line(i).point());
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
        let streams = Streams::new(6, Purpose::FIRST_SHOT);
        let n = 100_000;
        let mut sum = [0.0; 3];
        for i in 0..n {
            let Barycentric { v, w } = point_on_triangle(streams.line(i).point());
            assert!(v >= 0.0 && w >= 0.0 && v + w <= 1.0);
            sum = [sum[0] + v, sum[1] + w, sum[2] + v * w];
        }
        let n = f64::from(n as u32);
        // E[v] = 1/3 with variance 1/18; E[vw] = 1/12 with variance 1/90 − 1/144.
        assert!((sum[0] / n - 1.0 / 3.0).abs() < 4.0 * (1.0 / 18.0 / n).sqrt());
        assert!((sum[1] / n - 1.0 / 3.0).abs() < 4.0 * (1.0 / 18.0 / n).sqrt());
        assert!((sum[2] / n - 1.0 / 12.0).abs() < 4.0 * ((1.0 / 90.0 - 1.0 / 144.0) / n).sqrt());
    }

    /// A regular grid of points is mapped in equal numbers to four equal parts of a triangle, and the cosines of the
    /// directions have the right moments.
    #[test]
    fn points_of_the_square_keep_their_areas() {
        let n = 400;
        let grid = (0..n * n).map(|k| [k % n, k / n].map(|i| (f64::from(i) + 0.5) / f64::from(n)));
        let normal = DVec3::new(-2.0, 1.0, 2.0) / 3.0;
        let (mut parts, mut cosine, mut square) = ([0.0; 4], 0.0, 0.0);
        for point in grid {
            let Barycentric { v, w } = continuous_point_on_triangle(point);
            assert!(v >= 0.0 && w >= 0.0 && v + w <= 1.0);
            parts[[v > 0.5, w > 0.5, v + w < 0.5].iter().position(|&within| within).unwrap_or(3)] += 1.0;
            let cos = cosine_direction(normal, point).dot(normal);
            (cosine, square) = (cosine + cos, square + cos * cos);
        }
        let all = f64::from(n * n);
        assert!(parts.iter().all(|part| (part / all - 0.25).abs() < 0.002), "{parts:?}");
        assert!((cosine / all - 2.0 / 3.0).abs() < 1e-4 && (square / all - 0.5).abs() < 1e-4);
    }
}
