//! A triangle as seen from a point, and uniform directions within its solid angle.

use std::f64::consts::PI;

use glam::DVec3;

/// Triangle as seen from a point: a spherical triangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct SeenTriangle {
    /// Unit vectors to the corners.
    corners: [DVec3; 3],
    /// Solid angle \[sr\].
    pub(super) solid_angle: f64,
}

/// Solid angle \[sr\] below which rounding decides where a direction lies.
const SMALLEST: f64 = 1e-9;

impl SeenTriangle {
    /// Returns the triangle with these corners as seen from a point; `None` if its solid angle is too small to be known
    /// well (van Oosterom and Strackee 1983).
    pub(super) fn from(origin: DVec3, corners: [DVec3; 3]) -> Option<Self> {
        let [a, b, c] = corners.map(|corner| (corner - origin).try_normalize());
        let corners @ [a, b, c] = [a?, b?, c?];
        let (volume, sum) = (a.dot(b.cross(c)).abs(), 1.0 + a.dot(b) + b.dot(c) + c.dot(a));
        let solid_angle = 2.0 * libm::atan2(volume, sum);
        (SMALLEST..2.0 * PI).contains(&solid_angle).then_some(Self { corners, solid_angle })
    }

    /// Returns the direction that belongs to a point of the unit square. The directions of uniform points are uniform
    /// within the solid angle (Arvo 1995).
    pub(super) fn direction(&self, [u, v]: [f64; 2]) -> DVec3 {
        let [a, b, c] = self.corners;
        // The part of the triangle up to an edge from `b` to a point of the opposite edge has the share `u` of the area.
        let (ab, ac) = (a.cross(b).normalize_or_zero(), a.cross(c).normalize_or_zero());
        let (cos_a, sin_a) = (ab.dot(ac), ab.cross(ac).length());
        let (sin, cos) = libm::sincos(u * self.solid_angle);
        let (s, t) = (sin * cos_a - cos * sin_a, cos * cos_a + sin * sin_a);
        let (p, q) = (t - cos_a, s + sin_a * a.dot(b));
        let along = ((q * t - p * s) * cos_a - q) / ((q * s + p * t) * sin_a);
        let opposite = if along.is_finite() { between(a, c, along.clamp(-1.0, 1.0)) } else { c };
        between(b, opposite, 1.0 - v * (1.0 - opposite.dot(b)))
    }
}

/// Returns the unit vector at an angle with the cosine `cosine` from `a`, towards `b`.
fn between(a: DVec3, b: DVec3, cosine: f64) -> DVec3 {
    let across = (b - b.dot(a) * a).normalize_or_zero();
    cosine * a + (1.0 - cosine * cosine).max(0.0).sqrt() * across
}

/// Returns the share of the diffuse light arriving at a point of a surface with this unit normal that comes from a triangle,
/// if all directions of the hemisphere are equally bright: the view factor from the point to the triangle (Lambert 1760).
pub(super) fn share_of_hemisphere(origin: DVec3, normal: DVec3, corners: [DVec3; 3]) -> f64 {
    // The part above the horizon.
    let mut above = [DVec3::ZERO; 4];
    let mut count = 0;
    let mut push = |corner: DVec3| {
        above[count] = corner.normalize_or_zero();
        count += 1;
    };
    for i in 0..3 {
        let [from, to] = [corners[i], corners[(i + 1) % 3]].map(|corner| corner - origin);
        let (low, high) = (from.dot(normal), to.dot(normal));
        if low > 0.0 {
            push(from);
        }
        if (low > 0.0) != (high > 0.0) {
            push(from + (to - from) * (low / (low - high)));
        }
    }
    let edges = (0..count).map(|i| {
        let (a, b) = (above[i], above[(i + 1) % count]);
        let across = a.cross(b);
        let angle = libm::atan2(across.length(), a.dot(b));
        angle * across.normalize_or_zero().dot(normal)
    });
    edges.sum::<f64>().abs() / (2.0 * PI)
}

#[cfg(test)]
mod tests {
    use super::*;
    use sir_lines::{Purpose, Streams};

    /// Distributes directions over the four parts into which the midpoints of the edges cut a triangle: each part gets its
    /// share of the solid angle within five standard errors.
    #[test]
    fn directions_are_uniform_within_the_solid_angle() {
        let shapes = [
            [DVec3::new(-1.0, -1.0, 1.0), DVec3::new(2.0, -1.0, 1.0), DVec3::new(0.0, 3.0, 0.5)],
            // Seen at a grazing angle, and from within an inch.
            [DVec3::new(0.0, 0.0, 0.01), DVec3::new(5.0, 0.1, 0.02), DVec3::new(5.0, 3.0, 0.03)],
            [DVec3::new(100.0, 0.0, 1.0), DVec3::new(100.0, 0.2, 1.0), DVec3::new(100.0, 0.0, 1.3)],
        ];
        for corners @ [a, b, c] in shapes {
            let seen = SeenTriangle::from(DVec3::ZERO, corners).unwrap();
            let (ab, bc, ca) = (a.midpoint(b), b.midpoint(c), c.midpoint(a));
            let parts = [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]];
            let shares =
                parts.map(|part| SeenTriangle::from(DVec3::ZERO, part).map_or(0.0, |part| part.solid_angle));
            assert!((shares.iter().sum::<f64>() / seen.solid_angle - 1.0).abs() < 1e-6);
            let streams = Streams::new(1, Purpose::PROBE);
            let n = 40_000;
            let mut counts = [0u32; 4];
            for i in 0..n {
                let direction = seen.direction(streams.line(i).point());
                assert!((direction.length() - 1.0).abs() < 1e-12);
                let is_in = |[a, b, c]: [DVec3; 3]| {
                    let signs = [(a, b), (b, c), (c, a)].map(|(a, b)| direction.dot(a.cross(b)));
                    signs.iter().all(|&s| s >= -1e-12) || signs.iter().all(|&s| s <= 1e-12)
                };
                let part = parts.iter().position(|&part| is_in(part));
                counts[part.expect("within the triangle")] += 1;
            }
            for (count, solid_angle) in counts.into_iter().zip(shares) {
                let (n, share) = (n as f64, solid_angle / seen.solid_angle);
                let sigma = (n * share * (1.0 - share)).sqrt();
                assert!((f64::from(count) - n * share).abs() < 5.0 * sigma, "{counts:?} {shares:?}");
            }
        }
    }

    #[test]
    fn solid_angles_are_those_of_the_textbook() {
        // An octant of the sphere, and a triangle that is too far away.
        let octant = SeenTriangle::from(DVec3::ZERO, [DVec3::X, DVec3::Y, DVec3::Z]).unwrap();
        assert!((octant.solid_angle - PI / 2.0).abs() < 1e-15);
        let far = DVec3::new(1e6, 0.0, 0.0);
        assert!(SeenTriangle::from(DVec3::ZERO, [far, far + DVec3::Y, far + DVec3::Z]).is_none());
    }

    #[test]
    fn shares_of_the_hemisphere_are_those_of_uniform_directions() {
        let far = 1e6;
        // A plane above takes all of it, an upright one half.
        let above =
            [DVec3::new(-far, -far, 1.0), DVec3::new(3.0 * far, -far, 1.0), DVec3::new(-far, 3.0 * far, 1.0)];
        assert!((share_of_hemisphere(DVec3::ZERO, DVec3::Z, above) - 1.0).abs() < 1e-5);
        let upright = above.map(|p| DVec3::new(p.z, p.x, p.y));
        assert!((share_of_hemisphere(DVec3::ZERO, DVec3::Z, upright) - 0.5).abs() < 1e-5);
        // A triangle that is partly below the horizon: the mean cosine over its solid angle.
        let corners = [DVec3::new(1.0, -1.0, -0.5), DVec3::new(2.0, 2.0, 1.0), DVec3::new(0.5, 1.0, 3.0)];
        let seen = SeenTriangle::from(DVec3::ZERO, corners).unwrap();
        let (n, streams) = (100_000, Streams::new(2, Purpose::PROBE));
        let cosines = (0..n).map(|i| seen.direction(streams.line(i).point()).z.max(0.0));
        let mean = cosines.sum::<f64>() * seen.solid_angle / (n as f64 * PI);
        let share = share_of_hemisphere(DVec3::ZERO, DVec3::Z, corners);
        assert!((mean / share - 1.0).abs() < 0.01, "{mean} {share}");
        assert_eq!(share_of_hemisphere(DVec3::ZERO, -DVec3::Z, above), 0.0);
    }
}
