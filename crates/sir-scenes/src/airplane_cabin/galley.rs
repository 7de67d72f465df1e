//! Galleys beyond the bulkheads, seen through the doorways, and doors in the end walls.

use glam::DVec3;

use crate::airplane_cabin::bulkhead::DOORWAY;
use crate::airplane_cabin::palette::Palette;
use crate::airplane_cabin::size::{FRONT, LENGTH, REAR};
use crate::model::sheet::lines;
use crate::model::{GAP, Model};

/// Returns both galleys.
pub(super) fn galleys(palette: &Palette) -> Model {
    let mut m = Model::default();
    for side in [-1.0, 1.0] {
        kitchen(&mut m, palette, side, [0.5, FRONT - 0.42]);
        kitchen(&mut m, palette, side, [REAR + 0.42, LENGTH - 0.3]);
    }
    door(&mut m, palette, 0.02, 1.0);
    door(&mut m, palette, LENGTH - 0.02, -1.0);
    for (from, to) in [(0.45, FRONT - 0.35), (REAR + 0.35, LENGTH - 0.45)] {
        let z = lines(from, to, 0.4);
        m.grid_block([&[-0.25, 0.0, 0.25], &[2.17, 2.19], &z], |d, _| {
            if d.y < 0.0 { palette.galley_lamp } else { palette.trim }
        });
    }
    m
}

/// Adds a row of trolleys under a counter, with ovens above, along one wall.
fn kitchen(m: &mut Model, palette: &Palette, side: f64, [from, to]: [f64; 2]) {
    let (front, back) = (side * (DOORWAY + 0.14), side * 1.18);
    let mut place = |inset: f64, y: [f64; 2], z: [f64; 2], material| {
        let near = front + side * inset;
        m.block([near.min(back), y[0], z[0]], [near.max(back), y[1], z[1]], 0.4, material);
    };
    place(-0.03, [0.98, 1.02], [from, to], palette.wood);
    place(-0.02, [1.95, 1.99], [from, to], palette.panel);
    let edges = lines(from, to, 0.34);
    for (i, pair) in edges.windows(2).enumerate() {
        let z = [pair[0] + 0.008, pair[1] - 0.008];
        place(0.02, [0.04, 0.97], z, palette.steel);
        place(0.12, [1.36, 1.94], z, if i % 2 == 0 { palette.steel } else { palette.bin });
    }
}

/// Adds a closed door on an end wall, whose front faces in the direction `toward · z`.
fn door(m: &mut Model, palette: &Palette, z: f64, toward: f64) {
    let mut slab = |half: f64, y: [f64; 2], from: f64, to: f64, material| {
        let (a, b) = (z + toward * from, z + toward * to);
        m.block([-half, y[0], a.min(b)], [half, y[1], a.max(b)], 0.3, material);
    };
    slab(0.36, [GAP, 1.98], 0.0, 0.03, palette.panel);
    slab(0.28, [1.05, 1.85], 0.03 + GAP, 0.045, palette.bin);
    slab(0.28, [0.12, 0.95], 0.03 + GAP, 0.045, palette.bin);
    slab(0.05, [1.0, 1.02], 0.03 + GAP, 0.07, palette.metal);
    let sign = [&[-0.15, 0.0, 0.15][..], &[2.03, 2.12], &[z - 0.01, z + 0.01]];
    m.grid_block(sign, |d: DVec3, _| if d.z * toward > 0.0 { palette.exit_sign } else { palette.trim });
}
