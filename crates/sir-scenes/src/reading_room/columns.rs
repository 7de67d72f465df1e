//! Columns, their cornices with hidden lamps, and the ribs of the vault.

use std::f64::consts::PI;

use glam::{DAffine3, DVec3};

use crate::model::{GAP, Model};
use crate::reading_room::palette::Palette;
use crate::reading_room::size::{ARC, BAY, BAYS, COLUMN, CORNICE, DAIS, HALF_WIDTH, LENGTH, SPRING};

/// Returns the columns, the cornices and the ribs.
pub(super) fn columns(palette: &Palette) -> Model {
    let mut m = Model::default();
    let ends = [0.32, LENGTH - 0.32];
    let places = (1..BAYS).map(|i| BAY * i as f64).chain(ends);
    let rib = rib(palette);
    for z in places {
        let foot = if z < BAY { DAIS } else { 0.0 };
        let column = column(palette, CORNICE - foot - 2.0 * GAP);
        for side in [-1.0, 1.0] {
            m.add_at(&column, side * (HALF_WIDTH - COLUMN), foot + GAP, z);
        }
        m.add_at(&rib, 0.0, SPRING, z);
    }
    let cornice = cornice(palette);
    m.add_at(&cornice, -HALF_WIDTH, 0.0, 0.0);
    let turned = DAffine3::from_rotation_y(PI);
    m.add(&cornice, DAffine3::from_translation(DVec3::new(HALF_WIDTH, 0.0, LENGTH)) * turned);
    m
}

/// Returns a column on a square plinth, on the origin.
fn column(palette: &Palette, height: f64) -> Model {
    let mut m = Model::default();
    let plinth = 0.12;
    m.block([-0.25, 0.0, -0.25], [0.25, plinth, 0.25], 1.0, palette.stone);
    let abacus = height - 0.09;
    m.block([-0.25, abacus, -0.25], [0.25, height, 0.25], 1.0, palette.stone);

    let (foot, head) = (plinth + GAP, abacus - GAP);
    let base = [[0.235, 0.0], [0.245, 0.03], [0.235, 0.07], [0.205, 0.085], [0.21, 0.12], [0.19, 0.15]];
    let shaft = [[0.18, 0.18], [0.182, 1.0], [0.176, 1.8], [0.166, 2.5]];
    let capital = [[0.155, -0.36], [0.18, -0.34], [0.18, -0.31], [0.16, -0.29]];
    let bell = [[0.165, -0.2], [0.20, -0.08], [0.245, -0.02], [0.245, 0.0]];
    let stretch = (head - foot - 0.4) / 3.2;
    let mut profile: Vec<[f64; 2]> = base.iter().map(|[r, y]| [*r, foot + y]).collect();
    profile.extend(shaft.iter().map(|[r, y]| [*r, foot + if *y < 0.5 { *y } else { y * stretch }]));
    profile.extend(capital.iter().chain(&bell).map(|[r, y]| [*r, head + y]));
    m.lathe(&profile, 16, palette.stone);
    m
}

/// Returns the cornice along the wall `x = 0`, with a lamp in a trough that shines upward and is hidden from below.
fn cornice(palette: &Palette) -> Model {
    let mut m = Model::default();
    let section = [
        [GAP, CORNICE],
        [0.66, CORNICE],
        [0.66, 4.13],
        [0.72, 4.20],
        [0.77, 4.25],
        [0.79, 4.30],
        [0.79, 4.50],
        [0.74, 4.50],
        [0.74, 4.32],
        [GAP, 4.32],
    ];
    m.prism(&section, [GAP, LENGTH - GAP], 0.75, palette.stone);
    let lamp = |d: DVec3, _| if d.y > 0.0 { palette.cove_lamp } else { palette.stone };
    let z = crate::model::sheet::lines(0.05, LENGTH - 0.05, 0.5);
    m.grid_block([&[0.45, 0.65], &[4.32 + GAP, 4.35], &z], lamp);
    m
}

/// Returns a rib under the vault, about the origin.
fn rib(palette: &Palette) -> Model {
    let mut m = Model::default();
    let half = 0.19;
    let low = 0.03;
    // Corners of the section in order around it: (distance from the vault, z).
    let section = [[0.004, half], [0.004, -half], [0.12, -half], [0.17, -0.11], [0.17, 0.11], [0.12, half]];
    let at = |i: usize, j: usize| {
        let [below, z] = section[j % section.len()];
        let (sin, cos) = (low + (PI - 2.0 * low) * i as f64 / ARC as f64).sin_cos();
        let r = HALF_WIDTH - below - 0.012;
        DVec3::new(r * cos, r * sin, z)
    };
    m.sheet([section.len(), ARC], |j, i| at(i, j), |_, _| palette.stone);
    let start: Vec<DVec3> = (0..section.len()).rev().map(|j| at(0, j)).collect();
    let end: Vec<DVec3> = (0..section.len()).map(|j| at(ARC, j)).collect();
    m.polygon(&start, palette.stone);
    m.polygon(&end, palette.stone);
    m
}
