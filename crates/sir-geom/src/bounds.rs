//! Enclosing volumes.

use glam::DVec3;

/// An axis-aligned box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundingBox {
    /// Smallest coordinates.
    pub min: DVec3,
    /// Largest coordinates.
    pub max: DVec3,
}

impl BoundingBox {
    /// The smallest box around all points; `None` if there are none.
    pub fn of(points: impl IntoIterator<Item = DVec3>) -> Option<Self> {
        let mut points = points.into_iter();
        let first = points.next()?;
        Some(
            points
                .fold(Self { min: first, max: first }, |b, p| Self { min: b.min.min(p), max: b.max.max(p) }),
        )
    }

    /// Centre of the box.
    #[must_use]
    pub fn centre(&self) -> DVec3 {
        0.5 * (self.min + self.max)
    }

    /// Edge lengths of the box.
    #[must_use]
    pub fn size(&self) -> DVec3 {
        self.max - self.min
    }

    /// Areas of the faces across each axis, one of each pair.
    #[must_use]
    pub fn face_areas(&self) -> DVec3 {
        let size = self.size();
        DVec3::new(size.y * size.z, size.z * size.x, size.x * size.y)
    }
}

/// A sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundingSphere {
    /// Centre.
    pub centre: DVec3,
    /// Radius.
    pub radius: f64,
}

impl BoundingSphere {
    /// A sphere around all points that is at most a few per cent larger than the smallest one (Ritter 1990),
    /// or the sphere about the centre of their box where that is smaller; `None` if there are no points.
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
        let mut ritter = Self { centre: 0.5 * (a + b), radius: 0.5 * a.distance(b) };
        for &p in points {
            let d = p.distance(ritter.centre);
            if d > ritter.radius {
                let radius = 0.5 * (ritter.radius + d);
                ritter.centre += (p - ritter.centre) * ((d - radius) / d);
                ritter.radius = radius;
            }
        }
        let around =
            |centre: DVec3| points.iter().map(|p| p.distance_squared(centre)).fold(0.0, f64::max).sqrt();
        ritter.radius = around(ritter.centre);
        let centre = BoundingBox::of(points.iter().copied())?.centre();
        let boxed = Self { centre, radius: around(centre) };
        let mut best = if boxed.radius < ritter.radius { boxed } else { ritter };
        // Room for rounding: every point is strictly inside.
        best.radius *= 1.0 + 1e-9;
        Some(best)
    }

    /// Surface area `4πR²`.
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
        assert!(corners.iter().all(|c| c.distance(s.centre) < s.radius));
    }

    #[test]
    fn no_points_have_no_bounds() {
        assert_eq!(BoundingSphere::of(&[]), None);
        assert_eq!(BoundingBox::of([]), None);
    }
}
