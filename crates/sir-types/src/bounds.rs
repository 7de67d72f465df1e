//! Enclosing volumes.

use glam::DVec3;

use crate::line::Line;

/// An axis-aligned box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundingBox {
    /// Smallest coordinates.
    pub min: DVec3,
    /// Largest coordinates.
    pub max: DVec3,
}

impl BoundingBox {
    /// Returns the smallest box around all points; `None` if there are no points.
    pub fn of(points: impl IntoIterator<Item = DVec3>) -> Option<Self> {
        let mut points = points.into_iter();
        let first = points.next()?;
        Some(
            points
                .fold(Self { min: first, max: first }, |b, p| Self { min: b.min.min(p), max: b.max.max(p) }),
        )
    }

    /// Returns the center of the box.
    #[must_use]
    pub fn center(&self) -> DVec3 {
        0.5 * (self.min + self.max)
    }

    /// Returns the edge lengths of the box.
    #[must_use]
    pub fn size(&self) -> DVec3 {
        self.max - self.min
    }

    /// Returns the areas of the faces across each axis, one of each pair.
    #[must_use]
    pub fn face_areas(&self) -> DVec3 {
        let size = self.size();
        DVec3::new(size.y * size.z, size.z * size.x, size.x * size.y)
    }

    /// Returns true if a point lies in the box or on its surface.
    #[must_use]
    pub fn contains(&self, point: DVec3) -> bool {
        self.min.cmple(point).all() && point.cmple(self.max).all()
    }

    /// Returns the intersection of two boxes; `None` if it is empty.
    #[must_use]
    pub fn intersection(&self, other: &Self) -> Option<Self> {
        let both = Self { min: self.min.max(other.min), max: self.max.min(other.max) };
        both.min.cmple(both.max).all().then_some(both)
    }

    /// Returns true if a line, infinite in both directions, meets the box.
    ///
    /// Seen along the line, the box is a hexagon of box edges. The line must be on the inner side of each pair of
    /// opposite edges. There is no division, so lines along a face and flat boxes are not special cases.
    #[inline]
    #[must_use]
    pub fn meets(&self, line: &Line) -> bool {
        let half = 0.5 * self.size();
        let along = line.direction.abs();
        let across = (line.origin - self.center()).cross(line.direction).abs();
        across.x <= half.y * along.z + half.z * along.y
            && across.y <= half.z * along.x + half.x * along.z
            && across.z <= half.x * along.y + half.y * along.x
    }
}

/// A sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundingSphere {
    /// Center.
    pub center: DVec3,
    /// Radius.
    pub radius: f64,
}

impl BoundingSphere {
    /// Returns a sphere around all points that is at most a few percent larger than the smallest one (Ritter 1990), or
    /// the sphere about the center of their bounding box if that is smaller; `None` if there are no points.
    #[must_use]
    pub fn of(points: &[DVec3]) -> Option<Self> {
        let first = *points.first()?;
        let farthest = |from: DVec3| {
            points.iter().copied().fold(from, |best, p| {
                if p.distance_squared(from) > best.distance_squared(from) { p } else { best }
            })
        };
        let a = farthest(first);
        let b = farthest(a);
        let mut ritter = Self { center: 0.5 * (a + b), radius: 0.5 * a.distance(b) };
        for &p in points {
            let d = p.distance(ritter.center);
            if d > ritter.radius {
                let radius = 0.5 * (ritter.radius + d);
                ritter.center += (p - ritter.center) * ((d - radius) / d);
                ritter.radius = radius;
            }
        }
        let around =
            |center: DVec3| points.iter().map(|p| p.distance_squared(center)).fold(0.0, f64::max).sqrt();
        ritter.radius = around(ritter.center);
        let center = BoundingBox::of(points.iter().copied())?.center();
        let boxed = Self { center, radius: around(center) };
        let mut best = if boxed.radius < ritter.radius { boxed } else { ritter };
        // Margin for rounding: every point is strictly inside.
        best.radius *= 1.0 + 1e-9;
        Some(best)
    }

    /// Returns the surface area `4πR²`.
    #[must_use]
    pub fn surface_area(&self) -> f64 {
        4.0 * std::f64::consts::PI * self.radius * self.radius
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sphere_of_a_cube_is_its_circumsphere() {
        let corners: Vec<_> =
            (0..8).map(|i| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2))).collect();
        let s = BoundingSphere::of(&corners).unwrap();
        assert!((s.radius - 0.75f64.sqrt()).abs() < 1e-8, "{s:?}");
        assert!(corners.iter().all(|c| c.distance(s.center) < s.radius));
    }

    /// Compares with a search for a point in the box in steps along the line, which is certain unless the line only
    /// just meets or misses the box.
    #[test]
    fn lines_meet_a_box_where_one_of_their_points_is_in_it() {
        let bounds = BoundingBox { min: DVec3::new(-1.0, 0.0, 2.0), max: DVec3::new(1.0, 0.5, 3.0) };
        let grown = |by: f64| BoundingBox { min: bounds.min - by, max: bounds.max + by };
        let direction =
            |i: f64| DVec3::new((1.7 * i).sin(), (2.3 * i).cos(), (0.9 * i + 1.0).sin()).normalize();
        let (mut met, mut missed) = (0, 0);
        for i in 0..2_000 {
            let i = f64::from(i);
            let line = Line { origin: 2.0 * direction(3.1 * i) + DVec3::Z, direction: direction(i) };
            let has_point_in =
                |bounds: BoundingBox| (-8_000..8_000).any(|k| bounds.contains(line.at(f64::from(k) * 1e-3)));
            if bounds.meets(&line) {
                met += 1;
                assert!(has_point_in(grown(1e-3)), "{line:?}");
            } else {
                missed += 1;
                assert!(!has_point_in(bounds), "{line:?}");
            }
        }
        assert!(met > 150 && missed > 150, "{met} met, {missed} missed");
        let flat = BoundingBox { min: DVec3::ZERO, max: DVec3::new(1.0, 1.0, 0.0) };
        let at = |x, y, z| DVec3::new(x, y, z);
        assert!(flat.meets(&Line { origin: at(0.5, 0.5, 9.0), direction: -DVec3::Z }));
        assert!(!flat.meets(&Line { origin: at(1.5, 0.5, 9.0), direction: DVec3::Z }));
        assert!(!flat.meets(&Line { origin: at(-1.0, 0.5, 0.1), direction: DVec3::X }));
    }

    #[test]
    fn boxes_have_a_box_in_common_or_nothing() {
        let of = |min, max| BoundingBox { min: DVec3::splat(min), max: DVec3::splat(max) };
        assert_eq!(of(0.0, 2.0).intersection(&of(1.0, 3.0)), Some(of(1.0, 2.0)));
        assert_eq!(of(0.0, 1.0).intersection(&of(1.5, 3.0)), None);
    }

    #[test]
    fn no_points_have_no_bounds() {
        assert_eq!(BoundingSphere::of(&[]), None);
        assert_eq!(BoundingBox::of([]), None);
    }
}
