//! Middle of the ceiling: hanging panels that hide lamps on their upper side, and signs under the panels.

use crate::airplane_cabin::palette::Palette;
use crate::airplane_cabin::size::{FRONT, UNIT, UNITS};
use crate::model::Model;
use crate::model::pillow::Ends;
use crate::model::sheet::lines;

/// Half the width of the panels \[m\].
const HALF: f64 = 0.20;
/// Height of the panels' underside \[m\].
const LOW: f64 = 2.205;
/// Half the width of the bright strip under the panels \[m\].
const STRIP: f64 = 0.025;
/// Section of a panel \[m\]. The third edge is the strip.
const SECTION: [[f64; 2]; 12] = [
    [-HALF + 0.006, LOW + 0.008],
    [-HALF + 0.03, LOW],
    [-STRIP, LOW],
    [STRIP, LOW],
    [HALF - 0.03, LOW],
    [HALF - 0.006, LOW + 0.008],
    [HALF, LOW + 0.02],
    [HALF - 0.02, LOW + 0.03],
    [STRIP, LOW + 0.03],
    [-STRIP, LOW + 0.03],
    [-HALF + 0.02, LOW + 0.03],
    [-HALF, LOW + 0.02],
];

/// Returns one panel per unit, with lamps, and the exit signs.
pub(super) fn spine(palette: &Palette) -> Model {
    let mut m = Model::default();
    for i in 0..UNITS {
        let z = FRONT + UNIT * i as f64;
        let ends = Ends { radius: 0.006, pieces: 1, cell: 0.8, cut: 0.0 };
        m.pillow(&SECTION, [z + 0.008, z + UNIT - 0.008], ends, |k| {
            if k == Some(2) { palette.spine_strip } else { palette.panel }
        });
        let z = lines(z + 0.05, z + UNIT - 0.05, 0.8);
        for side in [-1.0, 1.0] {
            let (a, b) = (side * 0.09, side * 0.13);
            let low = LOW + 0.031;
            m.grid_block([&[f64::min(a, b), f64::max(a, b)], &[low, low + 0.014], &z], |d, _| {
                if d.y > 0.0 { palette.spine_lamp } else { palette.trim }
            });
        }
    }
    for z in [FRONT + UNIT * 3.5, FRONT + UNIT * 7.5] {
        exit_sign(&mut m, palette, z);
    }
    m
}

/// Adds an exit sign across the aisle that emits on both sides.
fn exit_sign(m: &mut Model, palette: &Palette, z: f64) {
    let (top, half) = (LOW - 0.002, 0.15);
    let x = [-half, -half + 0.02, -0.02, 0.02, half - 0.02, half];
    let y = [top - 0.105, top - 0.09, top - 0.025, top];
    m.grid_block([&x, &y, &[z - 0.02, z + 0.02]], |d, p| {
        let inside = p.x.abs() < half - 0.02 && p.y > y[1] && p.y < y[2];
        match inside && d.z != 0.0 {
            true if p.x.abs() < 0.02 => palette.reveal,
            true => palette.exit_sign,
            false => palette.trim,
        }
    });
}
