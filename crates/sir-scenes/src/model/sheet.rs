//! Grids of quadrilaterals, and boxes made of six grids.

use glam::DVec3;
use sir_geom::MaterialId;

use crate::model::Model;

/// Returns coordinates from `from` to `to`, both included, in equal steps of at most `cell`.
pub(crate) fn lines(from: f64, to: f64, cell: f64) -> Vec<f64> {
    let cells = ((to - from) / cell - 1e-9).ceil().max(1.0);
    (0..=cells as usize).map(|i| from + (to - from) * (i as f64 / cells)).collect()
}

impl Model {
    /// Adds a grid of quadrilaterals with the corners `point(i, j)`. The normal of the front is the cross product of
    /// the directions of increasing `i` and increasing `j`.
    pub(crate) fn sheet(
        &mut self,
        [rows, columns]: [usize; 2],
        point: impl Fn(usize, usize) -> DVec3,
        material: impl Fn(usize, usize) -> MaterialId,
    ) {
        for i in 0..rows {
            for j in 0..columns {
                let corners = [point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)];
                self.polygon(&corners, material(i, j));
            }
        }
    }

    /// Adds the triangles between two polylines that run side by side, with `b` on the left of `a` seen from the front.
    /// The polylines may begin or end at a common point.
    pub(crate) fn stitch(&mut self, a: &[DVec3], b: &[DVec3], material: MaterialId) {
        let (mut i, mut j) = (0, 0);
        while i + 1 < a.len() || j + 1 < b.len() {
            // The shorter of the two possible next edges gives the better triangle.
            let along_a =
                j + 1 == b.len() || (i + 1 < a.len() && a[i + 1].distance(b[j]) <= a[i].distance(b[j + 1]));
            let triangle = if along_a {
                i += 1;
                [a[i - 1], a[i], b[j]]
            } else {
                j += 1;
                [a[i], b[j], b[j - 1]]
            };
            let [p, q, r] = triangle;
            if p.distance(q).min(q.distance(r)).min(r.distance(p)) > 1e-9 {
                self.polygon(&triangle, material);
            }
        }
    }

    /// Adds a closed box whose faces are grids with the given lines along `x`, `y` and `z`. `material` receives the
    /// outward normal of a face and the center of a cell.
    pub(crate) fn grid_block(&mut self, grid: [&[f64]; 3], material: impl Fn(DVec3, DVec3) -> MaterialId) {
        for axis in 0..3 {
            for end in [0, grid[axis].len() - 1] {
                // The two other axes, ordered so that their cross product points outward.
                let (mut u, mut v) = ((axis + 1) % 3, (axis + 2) % 3);
                let mut normal = DVec3::AXES[axis];
                if end == 0 {
                    (u, v) = (v, u);
                    normal = -normal;
                }
                let point = |i: usize, j: usize| {
                    let mut p = DVec3::ZERO;
                    p[axis] = grid[axis][end];
                    p[u] = grid[u][i];
                    p[v] = grid[v][j];
                    p
                };
                self.sheet([grid[u].len() - 1, grid[v].len() - 1], point, |i, j| {
                    material(normal, 0.5 * (point(i, j) + point(i + 1, j + 1)))
                });
            }
        }
    }

    /// Adds a closed box with faces in cells of at most `cell` \[m\].
    pub(crate) fn block(&mut self, min: [f64; 3], max: [f64; 3], cell: f64, material: MaterialId) {
        let [x, y, z] = [0, 1, 2].map(|axis| lines(min[axis], max[axis], cell));
        self.grid_block([&x, &y, &z], |_, _| material);
    }
}
