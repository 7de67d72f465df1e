//! Overhead units: bins, service panels, and the lamps hidden above and beside them.
//!
//! A unit is modeled on the right side, from `z = 0` to the length of a unit.

use std::f64::consts::PI;

use glam::{DAffine3, DVec3};
use sir_geom::MaterialId;

use crate::airplane_cabin::palette::Palette;
use crate::airplane_cabin::size::{FRONT, PITCH, UNIT, UNITS};
use crate::model::pillow::Ends;
use crate::model::sheet::lines;
use crate::model::{GAP, Model};
use crate::random::Random;

/// Section of a bin, from the outer end of its top around its curved front to its underside \[m\].
const BIN: [[f64; 2]; 16] = [
    [1.42, 2.0],
    [1.25, 2.015],
    [0.95, 2.015],
    // Lip that hides the lamp on the bin.
    [0.73, 2.03],
    [0.705, 2.075],
    [0.682, 2.085],
    [0.668, 2.075],
    [0.662, 2.02],
    [0.667, 1.925],
    [0.685, 1.845],
    [0.720, 1.775],
    [0.775, 1.715],
    [0.85, 1.680],
    [0.95, 1.674],
    [1.25, 1.680],
    [1.60, 1.685],
];

/// Returns all units on both sides.
pub(super) fn overhead(palette: &Palette, random: &mut Random) -> Model {
    let mut m = Model::default();
    for i in 0..UNITS {
        let z = FRONT + UNIT * i as f64;
        m.add_at(&unit(palette, random), 0.0, 0.0, z);
        let turned =
            DAffine3::from_translation(DVec3::new(0.0, 0.0, z + UNIT)) * DAffine3::from_rotation_y(PI);
        m.add(&unit(palette, random), turned);
    }
    m
}

fn unit(palette: &Palette, random: &mut Random) -> Model {
    let mut m = Model::default();
    m.pillow(&BIN, [0.006, UNIT - 0.006], Ends { radius: 0.012, pieces: 1, cell: 0.53, cut: 0.0 }, |k| {
        if k.is_some_and(|k| (10..13).contains(&k)) { palette.bin_foot } else { palette.bin }
    });
    // Latch on the steep part of the front.
    let middle = 0.5 * UNIT;
    let latch = [[0.6736, 1.86], [0.6796, 1.86], [0.674, 1.885], [0.668, 1.885]];
    m.prism(&latch, [middle - 0.05, middle + 0.05], 1.0, palette.trim);

    let z = lines(GAP, UNIT - GAP, PITCH);
    let cove = [[0.86, 2.075], [0.80, 2.035], [0.86, 2.035]];
    slanted_lamp(&mut m, &z, cove, [palette.cove_lamp, palette.trim]);
    let wall = [[1.615, 1.672], [1.672, 1.700], [1.615, 1.700]];
    slanted_lamp(&mut m, &z, wall, [palette.wall_lamp, palette.trim]);
    service_panels(&mut m, palette, random);
    m
}

/// Adds a triangular rail along a unit. The side between the first two corners of its section emits.
fn slanted_lamp(m: &mut Model, z: &[f64], section: [[f64; 2]; 3], [lamp, rail]: [MaterialId; 2]) {
    let point = |i: usize, z: f64| DVec3::new(section[i % 3][0], section[i % 3][1], z);
    for i in 0..3 {
        let material = if i == 0 { lamp } else { rail };
        m.sheet([1, z.len() - 1], |a, j| point(i + a, z[j]), |_, _| material);
    }
    let last = z[z.len() - 1];
    m.polygon(&[0, 1, 2].map(|i| point(i, last)), rail);
    m.polygon(&[2, 1, 0].map(|i| point(i, z[0])), rail);
}

/// Adds a panel along the unit with a lip beside the lamp, and with lights, nozzles and signs for two seat rows.
fn service_panels(m: &mut Model, palette: &Palette, random: &mut Random) {
    let section = [[0.98, 1.655], [1.56, 1.650], [1.575, 1.640], [1.60, 1.640], [1.60, 1.665], [1.0, 1.670]];
    m.prism(&section, [0.004, UNIT - 0.004], 0.4, palette.panel);
    for row in 0..2 {
        let z = PITCH * (f64::from(row) + 0.5);
        m.block([1.02, 1.632, z - 0.16], [1.50, 1.65 - GAP, z + 0.2], 0.5, palette.tray);
        for place in 0..3 {
            let x = 1.14 + 0.13 * f64::from(place);
            let on = random.unit() < 0.5;
            let light = |d: DVec3, _| if on && d.y < 0.0 { palette.reading_lamp } else { palette.metal };
            m.grid_block([&[x - 0.02, x + 0.02], &[1.618, 1.632 - GAP], &[z + 0.10, z + 0.14]], light);
        }
        // Row of air nozzles.
        m.block([1.14, 1.618, z - 0.12], [1.40, 1.632 - GAP, z - 0.08], 0.2, palette.trim);
        let sign = |d: DVec3, _| if row == 0 && d.y < 0.0 { palette.seat_sign } else { palette.dark };
        m.grid_block([&[1.19, 1.33], &[1.622, 1.632 - GAP], &[z - 0.01, z + 0.03]], sign);
    }
}
