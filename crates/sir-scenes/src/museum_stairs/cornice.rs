//! Cornice under the raised middle of the ceiling, with lamps in a trough that shine upward.

use glam::{DAffine3, DVec3};

use crate::model::sheet::lines;
use crate::model::{GAP, Model};
use crate::museum_stairs::palette::Palette;
use crate::museum_stairs::size::{AISLE, EDGE, SOUTH_EDGE};

/// Projection of the cornice from the wall \[m\].
const OUT: f64 = 0.62;

/// Returns the cornice along three sides.
pub(super) fn cornice(palette: &Palette) -> Model {
    let mut m = Model::default();
    let side = [GAP, SOUTH_EDGE - GAP];
    let place = |x: DVec3, z: DVec3, origin: DVec3| DAffine3::from_cols(x, DVec3::Y, z, origin);
    m.add(&stretch(palette, side), place(-DVec3::X, -DVec3::Z, DVec3::new(EDGE, 0.0, SOUTH_EDGE)));
    m.add(&stretch(palette, side), place(DVec3::X, DVec3::Z, DVec3::new(-EDGE, 0.0, 0.0)));
    let reach = EDGE - OUT - GAP;
    m.add(&stretch(palette, [-reach, reach]), place(-DVec3::Z, DVec3::X, DVec3::new(0.0, 0.0, SOUTH_EDGE)));
    m
}

/// Returns a piece of cornice along `z`; the wall is at `x = 0`.
fn stretch(palette: &Palette, [from, to]: [f64; 2]) -> Model {
    let mut m = Model::default();
    let y = AISLE - 0.36;
    let section = [
        [GAP, y],
        [0.08, y],
        [0.10, y + 0.12],
        [0.24, y + 0.15],
        [0.30, y + 0.26],
        [0.52, y + 0.30],
        [0.60, y + 0.40],
        [OUT, y + 0.44],
        [OUT, y + 0.58],
        [OUT - 0.04, y + 0.58],
        [OUT - 0.04, y + 0.42],
        [GAP, y + 0.42],
    ];
    m.prism(&section, [from, to], 0.75, palette.pale);
    // Blocks under it, as in a classical cornice.
    for z in lines(from + 0.3, to - 0.3, 0.6) {
        m.block([0.32, y + 0.17, z - 0.09], [0.48, y + 0.262, z + 0.09], 1.0, palette.gold);
    }
    let z = lines(from + 0.8, to - 0.8, 1.1);
    let lamp = |d: DVec3, _| if d.y > 0.0 { palette.cove_lamp } else { palette.pale };
    m.grid_block([&[0.36, 0.52], &[y + 0.42 + GAP, y + 0.45], &z], lamp);
    m
}
