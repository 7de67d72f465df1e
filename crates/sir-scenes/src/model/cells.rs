//! Solids made of the cells of a rectilinear grid.

use glam::DVec3;
use sir_geom::MaterialId;

use crate::model::Model;

impl Model {
    /// Adds the surface of the filled cells of a grid with the given lines along `x`, `y` and `z`.
    ///
    /// `filled` receives the center of a cell. `material` receives the outward normal and the center of a quadrilateral
    /// between a filled and an empty cell. The surface is closed if no two filled cells touch in an edge alone.
    pub(crate) fn cells(
        &mut self,
        grid: [&[f64]; 3],
        filled: impl Fn(DVec3) -> bool,
        material: impl Fn(DVec3, DVec3) -> MaterialId,
    ) {
        let counts = grid.map(|lines| lines.len() - 1);
        let middle = |axis: usize, cell: usize| 0.5 * (grid[axis][cell] + grid[axis][cell + 1]);
        let is_filled = |cell: [usize; 3]| {
            (0..3).all(|axis| cell[axis] < counts[axis])
                && filled(DVec3::from_array([0, 1, 2].map(|axis| middle(axis, cell[axis]))))
        };
        for axis in 0..3 {
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            for (line, &height) in grid[axis].iter().enumerate() {
                let corner = |i: usize, j: usize| {
                    let mut corner = DVec3::ZERO;
                    (corner[axis], corner[u], corner[v]) = (height, grid[u][i], grid[v][j]);
                    corner
                };
                for (i, j) in (0..counts[u]).flat_map(|i| (0..counts[v]).map(move |j| (i, j))) {
                    let mut cell = [0; 3];
                    (cell[axis], cell[u], cell[v]) = (line, i, j);
                    let above = is_filled(cell);
                    // An index that wraps around is beyond the grid, and empty.
                    cell[axis] = line.wrapping_sub(1);
                    let below = is_filled(cell);
                    if above == below {
                        continue;
                    }
                    let mut corners =
                        [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
                    let mut normal = DVec3::AXES[axis];
                    if above {
                        corners.reverse();
                        normal = -normal;
                    }
                    self.polygon(&corners, material(normal, 0.5 * (corners[0] + corners[2])));
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_enclose_their_volume() {
        let mut m = Model::default();
        let lines = [0.0, 1.0, 2.0, 4.0];
        // All cells of a cube except the middle one.
        m.cells([&lines; 3], |p| p.distance(DVec3::splat(1.5)) > 0.1, |_, _| MaterialId(0));
        let volume: f64 = m
            .polygons
            .iter()
            .map(|(p, _)| (2..4).map(|i| p[0].dot(p[i - 1].cross(p[i])) / 6.0).sum::<f64>())
            .sum();
        assert_eq!((m.polygons.len(), volume), (60, 63.0));
    }
}
