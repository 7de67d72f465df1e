//! Convex hull of points in space.

mod flat;
mod grid;
mod quickhull;

use glam::DVec3;

use grid::{on_grid, volume, winding};

/// Convex hull of points: a closed surface of triangles whose corners are some of the points.
///
/// Points are rounded to an integer grid of at least 2³⁹ steps along their extent. On this grid all geometric
/// predicates are exact, so any input is allowed: coplanar points, duplicates, any number of points on one face. Except
/// for the rounding, which is less than 10⁻¹² of the extent, the hull is convex and contains all points.
///
/// Coplanar points have a flat hull: a polygon with two sides. Equal points have equal hulls on every machine.
#[derive(Clone, Debug, PartialEq)]
pub struct ConvexHull {
    facets: Vec<[DVec3; 3]>,
}

impl ConvexHull {
    /// Returns the hull of finite points, or `None` if there are no points or all of them are collinear (to the
    /// precision of the grid).
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

    /// Returns the triangles, counterclockwise seen from outside. Coplanar triangles are not merged, and some may be as
    /// narrow as rounding allows.
    #[must_use]
    pub fn facets(&self) -> &[[DVec3; 3]] {
        &self.facets
    }

    /// Returns the area of the surface. A flat hull has two sides.
    #[must_use]
    pub fn surface_area(&self) -> f64 {
        self.facets.iter().map(|[a, b, c]| 0.5 * (b - a).cross(c - a).length()).sum()
    }
}

/// Indices of points that are far apart.
struct Simplex {
    /// Non-degenerate triangle.
    base: [u32; 3],
    /// Point outside the plane of the triangle; `None` if all points lie in it.
    apex: Option<u32>,
}

impl Simplex {
    /// Returns `None` if all points are collinear.
    fn of(points: &[DVec3]) -> Option<Self> {
        // Returns the first point with the largest measure, or `None` if the measure is zero for all points.
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
