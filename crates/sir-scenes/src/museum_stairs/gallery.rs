//! Gallery: floors, beams and balustrades.

use std::f64::consts::FRAC_PI_2;

use glam::{DAffine3, DVec3};

use crate::model::sheet::lines;
use crate::model::{GAP, Model};
use crate::museum_stairs::balustrade;
use crate::museum_stairs::columns::PEDESTAL;
use crate::museum_stairs::palette::Palette;
use crate::museum_stairs::size::{
    AISLE, CELL, COLUMN, DOOR_COLUMN, EDGE, GALLERY, HALF_WIDTH, LENGTH, LOWER_BEAM, SIDE, SOUTH_EDGE,
    UNDER_GALLERY, UPPER_BEAM, column_places,
};

/// Half the width of the beams \[m\].
const BEAM: f64 = 0.24;

/// Distance that the edge of the floor, with its moldings, reaches under the balustrade, which hides the joint \[m\].
const LEDGE: f64 = 0.2;

/// Returns the floors, beams and balustrades.
pub(super) fn gallery(palette: &Palette) -> Model {
    let mut m = Model::default();
    floors(&mut m, palette);
    beams(&mut m, palette, [LOWER_BEAM, UNDER_GALLERY - GAP]);
    beams(&mut m, palette, [UPPER_BEAM, AISLE - GAP]);
    edge_moldings(&mut m, palette);

    let axis = EDGE + COLUMN;
    let floor = GALLERY + GAP;
    let mut stretch = |from: [f64; 2], to: [f64; 2]| {
        let [from, to] = [from, to].map(|[x, z]| DVec3::new(x, floor, z));
        m.add(&balustrade::between(palette, from, to), DAffine3::IDENTITY);
    };
    // The caps of the pedestals project farther than their shafts.
    let clear = PEDESTAL + 0.035;
    let places: Vec<f64> = column_places().collect();
    for side in [-axis, axis] {
        for pair in places.windows(2) {
            stretch([side, pair[0] - clear], [side, pair[1] + clear]);
        }
        let last = places[places.len() - 1];
        stretch([side, last - clear], [side, SIDE + 0.02]);
    }
    let south = SOUTH_EDGE + COLUMN;
    for [from, to] in [[-axis, -DOOR_COLUMN], [-DOOR_COLUMN, DOOR_COLUMN], [DOOR_COLUMN, axis]] {
        stretch([from + clear, south], [to - clear, south]);
    }
    m
}

/// Adds the three parts of the gallery's floor.
fn floors(m: &mut Model, palette: &Palette) {
    let y = [UNDER_GALLERY, GALLERY];
    let (wall, edge) = (HALF_WIDTH - GAP, EDGE + LEDGE);
    let parts = [
        ([-wall, -edge - GAP], [GAP, LENGTH - GAP]),
        ([edge + GAP, wall], [GAP, LENGTH - GAP]),
        ([-edge, edge], [SOUTH_EDGE + LEDGE + GAP, LENGTH - GAP]),
    ];
    for (x, z) in parts {
        let (x, z) = (lines(x[0], x[1], CELL), lines(z[0], z[1], CELL));
        let paint = |d: DVec3, p: DVec3| {
            let number = |lines: &[f64], at: f64| lines.iter().filter(|line| **line < at).count();
            match (d.y > 0.0, d.y < 0.0) {
                (true, _) if (number(&x, p.x) + number(&z, p.z)) % 2 == 0 => palette.ochre_tile,
                (true, _) => palette.cream_tile,
                (_, true) => palette.plaster,
                _ => palette.stone,
            }
        };
        m.grid_block([&x, &y, &z], paint);
    }
    // There are no moldings where the stair arrives.
    for side in [-1.0, 1.0] {
        let (a, b) = (side * (EDGE + GAP), side * edge);
        m.block([a.min(b), y[0], GAP], [a.max(b), y[1], SIDE], CELL, palette.pale);
    }
}

/// Adds beams on the columns, and from each column to the wall behind it.
fn beams(m: &mut Model, palette: &Palette, [low, high]: [f64; 2]) {
    let rise = high - low;
    let section = [
        [-BEAM + 0.03, 0.0],
        [BEAM - 0.03, 0.0],
        [BEAM - 0.03, 0.4 * rise],
        [BEAM, 0.45 * rise],
        [BEAM, rise],
        [-BEAM, rise],
        [-BEAM, 0.45 * rise],
        [-BEAM + 0.03, 0.4 * rise],
    ];
    let axis = EDGE + COLUMN;
    let end = SOUTH_EDGE + COLUMN + BEAM;
    for side in [-axis, axis] {
        let mut beam = Model::default();
        beam.prism(&section, [GAP, end], 0.75, palette.stone);
        m.add_at(&beam, side, low, 0.0);
    }
    let mut south = Model::default();
    let reach = axis - BEAM - GAP;
    south.prism(&section, [-reach, reach], 0.75, palette.stone);
    let place = DAffine3::from_translation(DVec3::new(0.0, low, SOUTH_EDGE + COLUMN));
    m.add(&south, place * DAffine3::from_rotation_y(FRAC_PI_2));

    let (from, to) = (axis + BEAM + GAP, HALF_WIDTH - GAP);
    for z in column_places() {
        for side in [-1.0, 1.0] {
            let (a, b) = (side * from, side * to);
            m.block([a.min(b), low + GAP, z - 0.17], [a.max(b), high, z + 0.17], 0.6, palette.stone);
        }
    }
    for x in [-DOOR_COLUMN, DOOR_COLUMN] {
        m.block([x - 0.17, low + GAP, end + GAP], [x + 0.17, high, LENGTH - GAP], 0.6, palette.stone);
    }
}

/// Adds moldings along the edge of the gallery's floor.
fn edge_moldings(m: &mut Model, palette: &Palette) {
    let y = UNDER_GALLERY;
    let out = 0.16;
    // (distance behind the edge, height)
    let section = [
        [LEDGE, y],
        [LEDGE, GALLERY],
        [-out, GALLERY],
        [-out, GALLERY - 0.10],
        [-out + 0.05, GALLERY - 0.15],
        [-out + 0.06, GALLERY - 0.22],
        [-0.04, GALLERY - 0.30],
        [-0.03, y],
    ];
    let mut side = Model::default();
    side.prism(&section, [SIDE + GAP, SOUTH_EDGE + LEDGE], 0.75, palette.pale);
    m.add_at(&side, EDGE, 0.0, 0.0);
    let turn = DAffine3::from_translation(DVec3::new(-EDGE, 0.0, SOUTH_EDGE + LEDGE + SIDE + GAP))
        * DAffine3::from_rotation_y(2.0 * FRAC_PI_2);
    m.add(&side, turn);
    let mut south = Model::default();
    let reach = EDGE - out - GAP;
    south.prism(&section, [-reach, reach], 0.75, palette.pale);
    // The section's x becomes z.
    let turn = DAffine3::from_cols(DVec3::Z, DVec3::Y, -DVec3::X, DVec3::new(0.0, 0.0, SOUTH_EDGE));
    m.add(&south, turn);
}
