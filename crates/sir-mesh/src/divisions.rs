//! How finely each triangle is cut.

use glam::DVec3;
use sir_geom::{BoundingBox, Scene, TriangleId};

use crate::error::MeshError;

/// The largest number of parts of an edge: `n²` must fit 32 bits.
pub(crate) const MAX_DIVISIONS: u32 = 65_535;

/// How to make patches of triangles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Subdivision {
    /// Every triangle is one patch.
    PerTriangle,
    /// Every flat polygon of the file is one patch, whatever the number of triangles it was cut into. The triangles
    /// of a bent one are patches of their own, because a line must not meet a patch twice.
    PerFace,
    /// No patch is larger than this area.
    MaxArea(f64),
    /// No edge of a patch is longer than this length.
    MaxEdge(f64),
    /// This many patches in all, as nearly as whole subdivisions allow, of areas as equal as possible.
    /// Never fewer than there are triangles.
    Patches(u64),
}

impl Subdivision {
    /// Parts of an edge per triangle: 1 of those whose middle is not in the box `within`, if there is one.
    pub(crate) fn divisions(self, scene: &Scene, within: Option<BoundingBox>) -> Result<Vec<u32>, MeshError> {
        let matters = |t: &TriangleId| within.is_none_or(|bounds| bounds.contains(middle(scene, *t)));
        let of_each = |n: &dyn Fn(TriangleId) -> Result<u32, MeshError>| {
            scene.triangle_ids().map(|t| if matters(&t) { n(t) } else { Ok(1) }).collect()
        };
        let positive = |what: &'static str, x: f64| {
            if x.is_finite() && x > 0.0 { Ok(x) } else { Err(MeshError::NotPositive { what, value: x }) }
        };
        match self {
            Self::PerTriangle | Self::PerFace => Ok(vec![1; scene.triangles().len()]),
            Self::MaxArea(max) => {
                let max = positive("area", max)?;
                of_each(&|t| parts((scene.area(t) / max).sqrt()))
            }
            Self::MaxEdge(max) => {
                let max = positive("edge", max)?;
                let longest = |t| {
                    let [a, b, c] = scene.corners(t);
                    a.distance(b).max(b.distance(c)).max(c.distance(a))
                };
                of_each(&|t| parts(longest(t) / max))
            }
            Self::Patches(target) => {
                // What has no area is not cut.
                let area = |t| if matters(&t) { scene.area(t) } else { 0.0 };
                let areas: Vec<f64> = scene.triangle_ids().map(area).collect();
                by_count(&areas, target)
            }
        }
    }
}

fn middle(scene: &Scene, triangle: TriangleId) -> DVec3 {
    let [a, b, c] = scene.corners(triangle);
    (a + b + c) / 3.0
}

/// The fewest whole parts that are each at most one unit of `x` units.
fn parts(x: f64) -> Result<u32, MeshError> {
    // What rounding adds to a whole number must not add a part.
    let n = (x * (1.0 - 1e-12)).ceil().max(1.0);
    if n <= f64::from(MAX_DIVISIONS) { Ok(n as u32) } else { Err(MeshError::TooMany) }
}

fn count(divisions: &[u32]) -> u64 {
    divisions.iter().map(|&n| u64::from(n) * u64::from(n)).sum()
}

/// Divisions whose count comes nearest to `target` with patches of nearly equal area.
fn by_count(areas: &[f64], target: u64) -> Result<Vec<u32>, MeshError> {
    if target > u64::from(u32::MAX) {
        return Err(MeshError::TooMany);
    }
    // Nearest to equal areas: n = √(A/a) rounded; the count falls as `a` grows, so bisection finds the `a` with
    // the largest count that does not exceed the target.
    let divide = |a: f64| -> Vec<u32> {
        let cap = f64::from(MAX_DIVISIONS);
        areas.iter().map(|&area| (area / a).sqrt().round().clamp(1.0, cap) as u32).collect()
    };
    let total: f64 = areas.iter().sum();
    let (mut fine, mut coarse) = (total / (4.0 * target.max(1) as f64 + 4.0), 16.0 * total);
    for _ in 0..100 {
        let a = (fine * coarse).sqrt();
        if count(&divide(a)) > target { fine = a } else { coarse = a }
    }
    let mut divisions = divide(coarse);
    fill_up(areas, target, &mut divisions);
    Ok(divisions)
}

/// Cuts the triangles with the largest patches once more, as long as the count does not exceed `target`.
fn fill_up(areas: &[f64], target: u64, divisions: &mut [u32]) {
    let mut missing = target.saturating_sub(count(divisions));
    let mut order: Vec<usize> = (0..areas.len()).collect();
    let patch_area = |t: usize, n: u32| areas[t] / f64::from(n * n);
    order.sort_by(|&s, &t| {
        patch_area(t, divisions[t]).total_cmp(&patch_area(s, divisions[s])).then(s.cmp(&t))
    });
    for t in order {
        let more = u64::from(2 * divisions[t] + 1);
        if more <= missing && divisions[t] < MAX_DIVISIONS && areas[t] > 0.0 {
            divisions[t] += 1;
            missing -= more;
        }
    }
}
