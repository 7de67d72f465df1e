//! The convex hull of points in space.

mod flat;
mod grid;
mod quickhull;

use glam::DVec3;

use grid::{on_grid, volume, winding};

/// The convex hull of points, as a closed surface of triangles whose corners are some of the points.
///
/// Where the points lie to each other is decided exactly, once they are rounded to an integer grid of at least 2³⁹ steps
/// along their extent. Any points will do: in a plane, on top of each other, in masses on the same faces. They all lie
/// in the hull, and the hull is convex, but for that rounding, which is less than 10⁻¹² of the extent.
///
/// Points in a plane have a flat hull: a polygon with both its sides. Equal points have equal hulls, on every machine.
#[derive(Clone, Debug, PartialEq)]
pub struct ConvexHull {
    facets: Vec<[DVec3; 3]>,
}

impl ConvexHull {
    /// The hull of finite points; `None` if there are none, or all lie on one line (to the precision of the grid).
    ///
    /// A million points on a sphere take about a second, a million points in a room less.
    #[must_use]
    pub fn of(points: &[DVec3]) -> Option<Self> {
        let grid = on_grid(points)?;
        let simplex = Simplex::of(&grid)?;
        let facets = match simplex.apex {
            Some(apex) => quickhull::facets(&grid, simplex.base, apex),
            None => flat::facets(&grid, simplex.base),
        };
        let at = |i: u32| points[i as usize];
        Some(Self { facets: facets.into_iter().map(|corners| corners.map(at)).collect() })
    }

    /// Triangles, counterclockwise seen from outside. Those in the same plane are not made one, and some may be as narrow
    /// as rounding allows.
    #[must_use]
    pub fn facets(&self) -> &[[DVec3; 3]] {
        &self.facets
    }

    /// Area of the surface; for a flat hull, of both sides.
    #[must_use]
    pub fn surface_area(&self) -> f64 {
        self.facets.iter().map(|[a, b, c]| 0.5 * (b - a).cross(c - a).length()).sum()
    }
}

/// Points that are far apart, by their numbers.
struct Simplex {
    /// A triangle with an area.
    base: [u32; 3],
    /// A point outside its plane; `None` if all lie in it.
    apex: Option<u32>,
}

impl Simplex {
    /// `None` if all points lie on one line.
    fn of(points: &[DVec3]) -> Option<Self> {
        // The first of the points that are farthest, by a measure that is zero only where it is meaningless.
        let farthest = |measure: &dyn Fn(DVec3) -> f64| {
            let (mut best, mut most) = (None, 0.0);
            for (i, &p) in points.iter().enumerate() {
                let m = measure(p);
                if m > most {
                    (best, most) = (Some(i as u32), m);
                }
            }
            best
        };
        let at = |i: u32| points[i as usize];
        let a = farthest(&|p| p.distance_squared(points[0]))?;
        let b = farthest(&|p| p.distance_squared(at(a)))?;
        let c = farthest(&|p| winding(at(a), at(b), p).iter().map(|&x| x as f64 * x as f64).sum())?;
        let base = [a, b, c];
        let apex = farthest(&|p| (volume(base.map(at), p) as f64).abs());
        Some(Self { base, apex })
    }
}
