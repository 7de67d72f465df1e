//! Triangles of one plane that overlap.

use glam::DVec3;
use sir_geom::{Scene, TriangleId};

use crate::lattice::{Cut, Frame, Placement, Size};

/// Depth up to which triangles may overlap by rounding, relative to the size of all.
const TOLERANCE: f64 = 1e-6;

/// Largest number of bins across.
const MAX_BINS: f64 = 256.0;

/// Splits triangles of one plane into those that do not overlap any before them, and the others.
pub(crate) fn without_overlaps(
    scene: &Scene,
    triangles: Vec<TriangleId>,
    normal: DVec3,
) -> (Vec<TriangleId>, Vec<TriangleId>) {
    // Two triangles that continue each other across an edge are on different sides of it.
    if triangles.len() < 3 {
        return (triangles, Vec::new());
    }
    let [u, v] = <[DVec3; 2]>::from(normal.any_orthonormal_pair());
    let corners = |t: TriangleId| scene.corners(t).map(|p| [p.dot(u), p.dot(v)]);
    let all = || triangles.iter().flat_map(|&t| corners(t));
    let low = all().fold([f64::INFINITY; 2], |low, p| [low[0].min(p[0]), low[1].min(p[1])]);
    let high = all().fold([f64::NEG_INFINITY; 2], |high, p| [high[0].max(p[0]), high[1].max(p[1])]);
    let extent = [high[0] - low[0], high[1] - low[1]];
    let tolerance = TOLERANCE * extent[0].max(extent[1]);
    let across = (triangles.len() as f64).sqrt().ceil().min(MAX_BINS) as u16;
    let size = Size { columns: across, rows: across };
    let axes = [u / extent[0], v / extent[1]].map(|axis| axis * f64::from(across));
    let frame = Frame { origin: low[0] * u + low[1] * v, axes };
    let mut bins: Vec<Vec<u32>> = vec![Vec::new(); size.cells() as usize];
    let (mut kept, mut others): (Vec<TriangleId>, Vec<TriangleId>) = (Vec::new(), Vec::new());
    let mut met = Vec::new();
    for &t in &triangles {
        met.clear();
        let placement = Placement::new(&frame, scene.corners(t));
        placement.for_each_cell(size, t, |Cut { cell, .. }| met.push(cell as usize));
        let own = corners(t);
        let mut beside = met.iter().flat_map(|&bin| &bins[bin]);
        if beside.any(|&other| overlap(own, corners(kept[other as usize]), tolerance)) {
            others.push(t);
        } else {
            met.iter().for_each(|&bin| bins[bin].push(kept.len() as u32));
            kept.push(t);
        }
    }
    (kept, others)
}

/// True if two triangles overlap by more than a tolerance. Both are counterclockwise.
fn overlap(a: [[f64; 2]; 3], b: [[f64; 2]; 3], tolerance: f64) -> bool {
    // Convex shapes are apart if and only if one of their edges separates them.
    let separates = |of: &[[f64; 2]; 3], from: &[[f64; 2]; 3]| {
        (0..3).any(|i| {
            let (p, q) = (of[i], of[(i + 1) % 3]);
            let along = [q[0] - p[0], q[1] - p[1]];
            let least = tolerance * (along[0] * along[0] + along[1] * along[1]).sqrt();
            from.iter().all(|r| along[0] * (r[1] - p[1]) - along[1] * (r[0] - p[0]) <= least)
        })
    };
    !separates(&a, &b) && !separates(&b, &a)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_overlap_if_no_edge_is_between_them() {
        let a = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
        let beside = [[1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let over = [[0.9, 0.0], [1.0, 1.0], [0.0, 1.0]];
        assert!(!overlap(a, beside, 1e-6) && !overlap(beside, a, 1e-6));
        assert!(overlap(a, over, 1e-6) && overlap(over, a, 1e-6));
        assert!(overlap(a, a, 1e-6));
    }
}
