//! Window: a deep rounded recess in the curved wall, with a pane of sky behind a blind.

use std::f64::consts::TAU;

use glam::DVec3;

use crate::airplane_cabin::palette::Palette;
use crate::airplane_cabin::size::{FRONT, WALL_LINES, WINDOW_LINES, half_width, near};
use crate::model::Model;
use crate::random::Random;

/// Side wall seen from the aisle.
#[derive(Clone, Copy)]
pub(super) struct Wall {
    /// 1 for the right wall and −1 for the left wall, looking forward.
    pub(super) side: f64,
}

impl Wall {
    /// Returns a point of the wall.
    pub(super) fn at(self, z: f64, y: f64) -> DVec3 {
        DVec3::new(self.side * half_width(y), y, z)
    }
}

/// Rings of a recess from the wall to the pane: half the width, half the height, and the depth \[m\].
const RINGS: [[f64; 3]; 4] =
    [[0.205, 0.285, 0.0], [0.160, 0.232, 0.0], [0.126, 0.190, 0.075], [0.118, 0.180, 0.105]];
/// Position `z` in front of which all windows are rounder, like those near a camera: a camera looks along them \[m\].
const ROUND_BEFORE: f64 = FRONT + 4.3;
/// Exponent of the superellipses that form the rings: 2 is an ellipse, large values approach a rectangle.
const SQUARENESS: f64 = 3.0;

/// Adds a window and the cell of the wall around it. `z` holds the positions of its left edge, middle and right edge
/// seen from inside.
pub(super) fn window(m: &mut Model, palette: &Palette, random: &mut Random, wall: Wall, z: [f64; 3]) {
    let [low, middle, high] = WINDOW_LINES.map(|i| WALL_LINES[i]);
    let [left, center, right] = z;
    let around = [
        (right, middle),
        (right, high),
        (center, high),
        (left, high),
        (left, middle),
        (left, low),
        (center, low),
        (right, low),
        (right, middle),
    ]
    .map(|(z, y)| wall.at(z, y));
    // The wall is flat here.
    let up = (wall.at(center, high) - wall.at(center, low)).normalize();
    let outward = wall.side * up.cross(DVec3::Z);
    // Row `k` of the pane lies between the points `k` and `points / 2 − 1 − k` of a ring.
    let round = near(wall.side, center) || center < ROUND_BEFORE;
    let points = if round { 20 } else { 12 };
    let rings = RINGS.map(|[a, b, depth]| {
        (0..=points)
            .map(|i| {
                let (sin, cos) = (((i % points) as f64 + 0.5) * TAU / points as f64).sin_cos();
                let power = |x: f64| x.signum() * x.abs().powf(2.0 / SQUARENESS);
                let on_wall = wall.at(center + wall.side * a * power(cos), middle + b * power(sin));
                on_wall + depth * outward
            })
            .collect::<Vec<_>>()
    });
    m.stitch(&around, &rings[0], palette.panel);
    for pair in rings.windows(2) {
        m.sheet([points, 1], |i, j| pair[j][i], |_, _| palette.reveal);
    }
    let pane = &rings[RINGS.len() - 1];
    let half = points / 2;
    let shut = blind(random, half);
    // Right and left end of each line between the rows, from top to bottom.
    let row = |r: usize| {
        let k = (half / 2 + points - 1 - r) % points;
        [pane[k], pane[(half + points - 1 - k) % points]]
    };
    for r in 0..half - 1 {
        let ([top_right, top_left], [low_right, low_left]) = (row(r), row(r + 1));
        let material = if r < shut { palette.blind } else { palette.sky };
        m.polygon(&[low_right, top_right, top_left, low_left], material);
    }
}

/// Returns the number of pane rows that the blind covers. `half` is half the number of points of a ring.
///
/// A pane has `half − 1` rows, of which the middle one is the tallest.
fn blind(random: &mut Random, half: usize) -> usize {
    match random.unit() {
        x if x < 0.48 => 0,
        x if x < 0.60 => half / 2 - 1,
        x if x < 0.70 => half / 2,
        _ => half - 1,
    }
}
