//! The inlaid floor of the hall.

use glam::DVec3;
use sir_geom::MaterialId;

use crate::model::Model;
use crate::model::sheet::lines;
use crate::museum_stairs::palette::Palette;
use crate::museum_stairs::size::{CELL, EDGE, HALF_WIDTH, LENGTH, SOUTH_EDGE};

/// Adds the floor. A cell on the edge of a lozenge consists of two triangles with different colors.
pub(super) fn floor(m: &mut Model, palette: &Palette) {
    let (x, z) = (lines(-HALF_WIDTH, HALF_WIDTH, CELL), lines(0.0, LENGTH, CELL));
    for i in 0..z.len() - 1 {
        for j in 0..x.len() - 1 {
            let corner = |di: usize, dj: usize| DVec3::new(x[j + dj], 0.0, z[i + di]);
            let [a, b, c, d] = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
            let (column, flip) = folded(0.5 * (x[j] + x[j + 1]));
            match pattern(palette, column, 0.5 * (z[i] + z[i + 1]), i) {
                Inlay::Plain(material) => m.polygon(&[a, b, c, d], material),
                Inlay::Lozenge { inner, outer, quarter: [right, low] } => {
                    // The triangle toward the middle of the lozenge has the inner color.
                    match (right != flip, low) {
                        (false, false) => halves(m, [b, c, d], [d, a, b], [inner, outer]),
                        (true, false) => halves(m, [a, b, c], [c, d, a], [inner, outer]),
                        (false, true) => halves(m, [c, d, a], [a, b, c], [inner, outer]),
                        (true, true) => halves(m, [d, a, b], [b, c, d], [inner, outer]),
                    }
                }
            }
        }
    }
}

fn halves(m: &mut Model, first: [DVec3; 3], second: [DVec3; 3], [inner, outer]: [MaterialId; 2]) {
    m.polygon(&first, inner);
    m.polygon(&second, outer);
}

/// Returns the index of a cell's column from the middle, and true if it lies on the left.
fn folded(x: f64) -> (usize, bool) {
    ((x.abs() / CELL) as usize, x < 0.0)
}

/// Inlay of a cell.
enum Inlay {
    Plain(MaterialId),
    /// Quarter of a lozenge. `quarter` is true for the right half and for the lower half.
    Lozenge {
        inner: MaterialId,
        outer: MaterialId,
        quarter: [bool; 2],
    },
}

/// Returns the inlay of a cell: lozenges in frames under the skylight, a checkerboard under the gallery.
fn pattern(palette: &Palette, column: usize, z: f64, row: usize) -> Inlay {
    let edge = (EDGE / CELL) as usize;
    if column >= edge || z > SOUTH_EDGE {
        let border = column <= edge && z < SOUTH_EDGE + CELL;
        return Inlay::Plain(match (border, (column + row) % 2) {
            (true, _) => palette.verde,
            (_, 0) => palette.cream_tile,
            _ => palette.rosso,
        });
    }
    // Frames are one cell wide, fields two.
    let (i, j) = (row % 3, column % 3);
    match (i == 0, j == 2) {
        (true, true) => Inlay::Plain(palette.dark_tile),
        (true, false) | (false, true) => Inlay::Plain(palette.ochre_tile),
        (false, false) => {
            let inner = if (row / 3 + column / 3).is_multiple_of(2) { palette.verde } else { palette.rosso };
            let outer = palette.cream_tile;
            Inlay::Lozenge { inner, outer, quarter: [j == 1, i == 2] }
        }
    }
}
