//! Points on an integer grid, with exact tests on which side of a plane they lie.

use glam::DVec3;
use sir_types::BoundingBox;

/// Largest number of grid steps along an axis. It is such that 128 bits hold every determinant.
const STEPS: f64 = (1u64 << 40) as f64;

/// Rounds points to a grid: vectors of whole numbers from 0 to 2⁴⁰. Returns `None` if the extent of the points is zero
/// or not finite.
pub(super) fn on_grid(points: &[DVec3]) -> Option<Vec<DVec3>> {
    let bounds = BoundingBox::of(points.iter().copied())?;
    // A power of two, so that points with few significant bits are not rounded, and coplanar ones stay coplanar.
    let scale = power_of_two_below(STEPS / bounds.size().max_element());
    let round = |x: f64| (x + 0.5) as i64 as f64;
    (scale > 0.0 && scale.is_finite()).then(|| {
        let place = |p: &DVec3| ((p - bounds.min) * scale).to_array().map(round);
        points.iter().map(|p| DVec3::from_array(place(p))).collect()
    })
}

/// Returns the largest power of two that is not above the positive number `x`, by clearing its mantissa.
fn power_of_two_below(x: f64) -> f64 {
    f64::from_bits(x.to_bits() & f64::INFINITY.to_bits())
}

fn to_integers(p: DVec3) -> [i128; 3] {
    p.to_array().map(|x| x as i128)
}

/// Returns `(b − a) × (c − a)` exactly; its components are at most 2⁸¹.
pub(super) fn winding(a: DVec3, b: DVec3, c: DVec3) -> [i128; 3] {
    let (u, v) = (to_integers(b - a), to_integers(c - a));
    [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
}

/// Returns six times the signed volume of a tetrahedron exactly: positive if the triangle is counterclockwise seen from
/// `p`.
pub(super) fn volume([a, b, c]: [DVec3; 3], p: DVec3) -> i128 {
    let (n, d) = (winding(a, b, c), to_integers(p - a));
    n[0] * d[0] + n[1] * d[1] + n[2] * d[2]
}

/// Plane of a triangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    origin: DVec3,
    normal: DVec3,
    /// Bound of the rounding error of a height, per step along each axis.
    error_bound: DVec3,
}

impl Plane {
    pub(super) fn new([a, b, c]: [DVec3; 3]) -> Self {
        // Exact: differences of whole numbers below 2⁵³.
        let (u, v) = (b - a, c - a);
        let (p, q) = (u.abs(), v.abs());
        let terms = DVec3::new(p.y * q.z + p.z * q.y, p.z * q.x + p.x * q.z, p.x * q.y + p.y * q.x);
        // Two roundings in each component of the normal and three in a scalar product with it: five times 2⁻⁵³.
        Self { origin: a, normal: u.cross(v), error_bound: terms * (8.0 * 0.5 * f64::EPSILON) }
    }

    /// Returns the signed height of a point above the plane, in an arbitrary unit. The sign is exact: zero means that
    /// the point is in the plane. `corners` must return the corners that the plane was built from.
    #[inline]
    pub(super) fn height(&self, corners: impl FnOnce() -> [DVec3; 3], p: DVec3) -> f64 {
        let d = p - self.origin;
        let (height, bound) = (self.normal.dot(d), self.error_bound.dot(d.abs()));
        // If the bound is zero, all terms of the height are zero.
        if height.abs() > bound || bound == 0.0 { height } else { volume(corners(), p) as f64 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn points_with_few_digits_are_not_changed() {
        let points = [DVec3::new(-1.0, 0.25, 7.0), DVec3::new(2.0, 0.5, 7.0), DVec3::new(1.125, 0.25, 7.75)];
        let grid = on_grid(&points).unwrap();
        let scale = (grid[1].x - grid[0].x) / 3.0;
        assert!(scale > 0.0 && scale.log2().fract() == 0.0 && 3.0 * scale > 0.5 * STEPS);
        for (p, g) in points.iter().zip(&grid) {
            assert_eq!(*p - points[0], (*g - grid[0]) / scale);
        }
    }

    #[test]
    fn points_without_an_extent_have_no_grid() {
        let (far, near) = (DVec3::splat(1e308), DVec3::splat(-1e308));
        for points in [&[][..], &[DVec3::ONE; 3], &[far, near], &[DVec3::ZERO, DVec3::splat(1e-310)]] {
            assert_eq!(on_grid(points), None);
        }
        assert!(on_grid(&[DVec3::ZERO, DVec3::splat(1e-290)]).is_some());
        assert!(on_grid(&[DVec3::ZERO, DVec3::splat(1e300)]).is_some());
    }

    /// Four points of the grid: independent ones; the fourth in the plane of the others or one step above or below; or
    /// all nearly collinear, so that the normal of the plane is mostly rounding error.
    fn four_points() -> impl Strategy<Value = [DVec3; 4]> {
        let vector = |p: [i64; 3]| DVec3::from_array(p.map(|x| x as f64));
        let component = prop_oneof![0..=1i64 << 40, 0..100i64];
        let point = prop::array::uniform3(component).prop_map(vector);
        let step = prop::array::uniform3(-1..=1i64).prop_map(vector);
        (prop::array::uniform4(point), step, 0..3, prop::array::uniform2(0.0..1.0f64)).prop_map(
            |([a, b, c, d], step, sort, share)| {
                let on_line = share.map(|s| a.lerp(b, s).round());
                let near = b + c - a + step;
                match sort {
                    0 if near.min_element() >= 0.0 && near.max_element() <= STEPS => [a, b, c, near],
                    1 => [a, b, on_line[0], on_line[1]],
                    _ => [a, b, c, d],
                }
            },
        )
    }

    proptest! {
        #[test]
        fn heights_have_the_right_sign([a, b, c, p] in four_points()) {
            let height = Plane::new([a, b, c]).height(|| [a, b, c], p);
            let exact = volume([a, b, c], p);
            prop_assert_eq!(height > 0.0, exact > 0);
            prop_assert_eq!(height < 0.0, exact < 0);
        }
    }
}
