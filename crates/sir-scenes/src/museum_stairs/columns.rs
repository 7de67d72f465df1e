//! Columns on both floors, and the pilasters behind them.

use std::f64::consts::TAU;

use glam::DVec3;

use crate::model::{GAP, Model};
use crate::museum_stairs::palette::Palette;
use crate::museum_stairs::size::{
    BAY, COLUMN, DOOR_COLUMN, EDGE, GALLERY, HALF_WIDTH, LOWER_BEAM, RAIL, SOUTH_EDGE, UPPER_BEAM,
    bay_middles, column_places,
};

/// Half the width of the pedestals of the upper columns \[m\].
pub(super) const PEDESTAL: f64 = 0.24;
/// Projection of the pilasters from the walls \[m\].
const PILASTER: f64 = 0.10;

/// Returns all columns with their pedestals and pilasters.
pub(super) fn columns(palette: &Palette) -> Model {
    let mut m = Model::default();
    let lower = fluted_column(palette, LOWER_BEAM - 2.0 * GAP);
    let pedestal_top = GALLERY + RAIL + 0.06;
    let upper = leafed_column(palette, UPPER_BEAM - pedestal_top - 3.0 * GAP);
    let pedestal = pedestal(palette, pedestal_top - GALLERY - GAP);
    let sides = column_places().flat_map(|z| [-1.0, 1.0].map(|side| (side * (EDGE + COLUMN), z)));
    for (x, z) in sides.chain([-DOOR_COLUMN, DOOR_COLUMN].map(|x| (x, SOUTH_EDGE + COLUMN))) {
        m.add_at(&lower, x, GAP, z);
        m.add_at(&pedestal, x, GALLERY + GAP, z);
        m.add_at(&upper, x, pedestal_top + 2.0 * GAP, z);
    }
    for z in column_places() {
        for side in [-1.0, 1.0] {
            let (a, b) = (side * (HALF_WIDTH - GAP), side * (HALF_WIDTH - PILASTER));
            for (low, high) in [(GAP, LOWER_BEAM), (GALLERY + GAP, UPPER_BEAM)] {
                let mut slab = |low: f64, high: f64, half: f64, out: f64| {
                    let b = b - side * out;
                    m.block([a.min(b), low, z - half], [a.max(b), high, z + half], 1.0, palette.stone);
                };
                slab(low, low + 0.25, 0.27, 0.03);
                slab(low + 0.25 + GAP, high - 0.2, 0.22, 0.0);
                slab(high - 0.2 + GAP, high - GAP, 0.26, 0.03);
            }
        }
    }
    rails(&mut m, palette);
    m
}

/// Adds moldings on the walls where the color changes.
fn rails(m: &mut Model, palette: &Palette) {
    for z in bay_middles() {
        for side in [-1.0, 1.0] {
            let (a, b) = (side * (HALF_WIDTH - GAP), side * (HALF_WIDTH - 0.05));
            let half = 0.5 * BAY - 0.27;
            for (y, material) in [(6.0, palette.pale), (9.5, palette.gold)] {
                m.block([a.min(b), y - 0.05, z - half], [a.max(b), y + 0.04, z + half], 0.9, material);
            }
        }
    }
    let half = EDGE - 0.06;
    m.block([-half, 9.45, GAP], [half, 9.54, 0.06], 0.8, palette.gold);
}

/// Returns a fluted column on a square plinth, on the origin.
fn fluted_column(palette: &Palette, height: f64) -> Model {
    let mut m = Model::default();
    let (plinth, abacus) = (0.12, height - 0.10);
    m.block([-0.33, 0.0, -0.33], [0.33, plinth, 0.33], 1.0, palette.stone);
    m.block([-0.32, abacus, -0.32], [0.32, height, 0.32], 1.0, palette.stone);

    let base = [[0.32, 0.0], [0.325, 0.035], [0.315, 0.075], [0.275, 0.09], [0.30, 0.145], [0.26, 0.17]];
    lathe_between(&mut m, palette, &base, plinth + GAP);
    let echinus = [[0.20, 0.0], [0.225, 0.02], [0.205, 0.06], [0.25, 0.16], [0.29, 0.22], [0.30, 0.25]];
    lathe_between(&mut m, palette, &echinus, abacus - GAP - 0.25);

    let (low, high) = (plinth + 0.17 + 2.0 * GAP, abacus - 0.25 - 2.0 * GAP);
    let (flutes, points) = (14, 3);
    // The shaft swells slightly and tapers to five sixths.
    let radius = |t: f64| 0.245 * (1.0 + 0.06 * t - 0.22 * t * t);
    let rows = [0.0, 0.45, 1.0];
    m.loft(
        rows.len(),
        flutes * points,
        |i, j| {
            let depth = if j % points == 0 { 1.0 } else { 0.90 };
            let (sin, cos) = (TAU * j as f64 / (flutes * points) as f64).sin_cos();
            let r = depth * radius(rows[i]);
            DVec3::new(r * cos, low + (high - low) * rows[i], -r * sin)
        },
        |_, _| palette.stone,
    );
    m
}

/// Returns a smooth marble column with a leaf capital, on the origin.
fn leafed_column(palette: &Palette, height: f64) -> Model {
    let mut m = Model::default();
    let abacus = height - 0.07;
    m.block([-0.28, abacus, -0.28], [0.28, height, 0.28], 1.0, palette.pale);
    let base = [[0.25, 0.0], [0.255, 0.03], [0.245, 0.06], [0.215, 0.075], [0.23, 0.11], [0.205, 0.13]];
    lathe_between(&mut m, palette, &base, 0.0);

    let bell = 0.42;
    let (low, high) = (0.13 + GAP, abacus - bell - 2.0 * GAP);
    let shaft: Vec<[f64; 2]> = [[0.195, 0.0], [0.197, 0.35], [0.187, 0.7], [0.165, 1.0]]
        .map(|[r, t]| [r, low + t * (high - low)])
        .to_vec();
    m.lathe(&shaft, 16, palette.rosso);

    // Radius of the leaves' ribs, radius of the bell between them, and height, from bottom to top.
    let rows = [
        [0.165, 0.165, 0.0],
        [0.185, 0.180, 0.02],
        [0.195, 0.165, 0.16],
        [0.215, 0.168, 0.19],
        [0.185, 0.170, 0.22],
        [0.195, 0.262, 0.385],
        [0.205, 0.250, 0.42],
    ];
    let leaves = 5;
    m.loft(
        rows.len(),
        4 * leaves,
        |i, j| {
            let [rib, between, y] = rows[i];
            let angle = TAU * j as f64 / (4 * leaves) as f64;
            let r = between + (rib - between) * (0.5 + 0.5 * (leaves as f64 * angle).cos());
            DVec3::new(r * angle.cos(), abacus - GAP - bell + y, -r * angle.sin())
        },
        |_, _| palette.pale,
    );
    m
}

fn lathe_between(m: &mut Model, palette: &Palette, profile: &[[f64; 2]], foot: f64) {
    let profile: Vec<[f64; 2]> = profile.iter().map(|[r, y]| [*r, foot + y]).collect();
    m.lathe(&profile, 14, palette.pale);
}

/// Returns a pedestal between two stretches of balustrade, on the origin.
pub(super) fn pedestal(palette: &Palette, height: f64) -> Model {
    let mut m = Model::default();
    let mut slab = |half: f64, low: f64, high: f64| {
        m.block([-half, low, -half], [half, high, half], 1.0, palette.pale);
    };
    slab(PEDESTAL, 0.0, 0.10);
    slab(PEDESTAL - 0.02, 0.10 + GAP, height - 0.10 - GAP);
    slab(PEDESTAL + 0.03, height - 0.10, height);
    m
}
