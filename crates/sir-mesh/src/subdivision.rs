//! Rules for the division of a scene into patches.

use glam::DVec3;
use sir_geom::{BoundingBox, Scene, TriangleId};

use crate::error::MeshError;

/// Largest number of parts of an edge: `n²` must fit in 32 bits.
pub(crate) const MAX_DIVISIONS: u32 = 65_535;

/// Rule for the division of a scene into patches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Subdivision {
    /// Every triangle is one patch.
    PerTriangle,
    /// Every flat polygon of the file is one patch, regardless of the number of triangles that it was cut into. The
    /// triangles of a bent polygon are separate patches.
    PerFace,
    /// Every triangle is cut into congruent triangles. There are never fewer patches than triangles.
    Triangles(PatchSize),
    /// Flat surfaces are cut into square cells, regardless of their triangles; small triangles of bent surfaces are
    /// joined.
    Surfaces(PatchSize),
}

/// Size of patches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PatchSize {
    /// No patch is larger than this area.
    MaxArea(f64),
    /// No edge of a patch is longer than this length. With [`Subdivision::Surfaces`], this is the edge of a cell; a cell
    /// that slight fragments have joined may be longer.
    MaxEdge(f64),
    /// Total number of patches, met as nearly as the rule allows, with areas as equal as possible.
    Count(u64),
}

impl Subdivision {
    /// Returns an estimate of the number of patches of a scene whose surfaces are divided, before anything is; `None` for
    /// other rules, whose patches take no memory.
    #[must_use]
    pub fn estimated_cells(self, scene: &Scene, within: Option<BoundingBox>) -> Option<f64> {
        let Self::Surfaces(size) = self else { return None };
        let matters = |t: &TriangleId| within.is_none_or(|bounds| bounds.contains(centroid(scene, *t)));
        let area: f64 = scene.triangle_ids().filter(matters).map(|t| scene.area(t)).sum();
        Some(match size {
            PatchSize::MaxArea(max) => area / max,
            PatchSize::MaxEdge(max) => area / (max * max),
            PatchSize::Count(count) => count as f64,
        })
    }

    /// Returns the number of parts of an edge per triangle, for rules that cut triangles. It is 1 for triangles whose
    /// centroid is not in the box `within`, if one is given.
    pub(crate) fn divisions(self, scene: &Scene, within: Option<BoundingBox>) -> Result<Vec<u32>, MeshError> {
        let matters = |t: &TriangleId| within.is_none_or(|bounds| bounds.contains(centroid(scene, *t)));
        let of_each = |n: &dyn Fn(TriangleId) -> Result<u32, MeshError>| {
            scene.triangle_ids().map(|t| if matters(&t) { n(t) } else { Ok(1) }).collect()
        };
        let Self::Triangles(size) = self else { return Ok(vec![1; scene.triangles().len()]) };
        size.check()?;
        match size {
            PatchSize::MaxArea(max) => of_each(&|t| parts((scene.area(t) / max).sqrt())),
            PatchSize::MaxEdge(max) => of_each(&|t| parts(longest_edge(scene, t) / max)),
            PatchSize::Count(target) => {
                // Triangles of area zero are not cut.
                let area = |t| if matters(&t) { scene.area(t) } else { 0.0 };
                let areas: Vec<f64> = scene.triangle_ids().map(area).collect();
                by_count(&areas, target)
            }
        }
    }
}

impl PatchSize {
    /// Returns an error if a limit is not positive.
    pub(crate) fn check(self) -> Result<(), MeshError> {
        let (what, value) = match self {
            Self::MaxArea(value) => ("area", value),
            Self::MaxEdge(value) => ("edge", value),
            Self::Count(_) => return Ok(()),
        };
        if value.is_finite() && value > 0.0 { Ok(()) } else { Err(MeshError::NotPositive { what, value }) }
    }
}

/// Returns the length of the longest edge of a triangle.
pub(crate) fn longest_edge(scene: &Scene, triangle: TriangleId) -> f64 {
    let [a, b, c] = scene.corners(triangle);
    a.distance(b).max(b.distance(c)).max(c.distance(a))
}

pub(crate) fn centroid(scene: &Scene, triangle: TriangleId) -> DVec3 {
    let [a, b, c] = scene.corners(triangle);
    (a + b + c) / 3.0
}

/// Returns the smallest number of equal parts of a length of `x` units that are each at most one unit long.
pub(crate) fn parts(x: f64) -> Result<u32, MeshError> {
    // Rounding errors above a whole number must not add a part.
    let n = (x * (1.0 - 1e-12)).ceil().max(1.0);
    if n <= f64::from(MAX_DIVISIONS) { Ok(n as u32) } else { Err(MeshError::TooMany) }
}

fn count(divisions: &[u32]) -> u64 {
    divisions.iter().map(|&n| u64::from(n) * u64::from(n)).sum()
}

/// Returns the divisions whose number of patches comes nearest to `target`, with patches of nearly equal area.
fn by_count(areas: &[f64], target: u64) -> Result<Vec<u32>, MeshError> {
    if target > u64::from(u32::MAX) {
        return Err(MeshError::TooMany);
    }
    // Areas are nearest to equal for n = √(A/a), rounded. The count falls as `a` grows, so bisection finds the `a` with
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
