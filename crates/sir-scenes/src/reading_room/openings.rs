//! Window bars and the door.

use std::f64::consts::PI;

use glam::{DAffine3, DVec3};

use crate::model::{GAP, Model};
use crate::reading_room::palette::Palette;
use crate::reading_room::shell::{LUNETTE_DEPTH, LUNETTE_RADIUS, WINDOW_DEPTH};
use crate::reading_room::size::{BAY, BAYS, HALF_WIDTH, LENGTH, OPENING, SPRING};

/// Returns the bars in front of all panes, and the door opposite the dais.
pub(super) fn openings(palette: &Palette) -> Model {
    let mut m = Model::default();
    let bars = window_bars(palette);
    for bay in 0..BAYS {
        // The bars are modeled in a wall that faces +z; this wall faces +x.
        let place = DAffine3::from_translation(DVec3::new(-HALF_WIDTH, 0.0, BAY * (bay as f64 + 0.5)));
        m.add(&bars, place * DAffine3::from_rotation_y(0.5 * PI));
    }
    m.add_at(&lunette_bars(palette), 0.0, SPRING, -LUNETTE_DEPTH);
    let door = DAffine3::from_translation(DVec3::new(0.0, GAP, LENGTH - GAP)) * DAffine3::from_rotation_y(PI);
    m.add(&door_and_frame(palette), door);
    m
}

/// Returns the bars of an arched window about the origin, behind the plane `z = 0`.
fn window_bars(palette: &Palette) -> Model {
    let mut m = Model::default();
    let half = 0.022;
    let (upright, across) = (-WINDOW_DEPTH + 0.12, -WINDOW_DEPTH + 0.06);
    let clear = 0.01;
    for x in [-0.5, 0.0, 0.5f64] {
        let r = OPENING.radius - clear;
        let side = x.abs() + half;
        let top = OPENING.spring + (r * r - side * side).sqrt();
        m.block(
            [x - half, OPENING.sill + GAP, upright - half],
            [x + half, top, upright + half],
            0.6,
            palette.window_bar,
        );
    }
    for y in [1.77, 2.33, OPENING.spring] {
        let x = OPENING.radius - 0.005;
        m.block([-x, y - half, across - half], [x, y + half, across + half], 0.6, palette.window_bar);
    }
    m
}

/// Returns the bars of the half-round window about the origin: rays from a hub, in front of the plane `z = 0`.
fn lunette_bars(palette: &Palette) -> Model {
    let mut m = Model::default();
    let half = 0.03;
    let mut ray = Model::default();
    ray.block([0.55, -half, 0.1], [LUNETTE_RADIUS - 0.03, half, 0.1 + 2.0 * half], 0.6, palette.window_bar);
    for i in 1..8 {
        m.add(&ray, DAffine3::from_rotation_z(PI * f64::from(i) / 8.0));
    }
    for (radius, z) in [(0.5, 0.1), (1.6, 0.03)] {
        m.add_at(&half_ring(palette, radius, 2.0 * half), 0.0, 0.0, z);
    }
    m
}

/// Returns a half-round bar.
fn half_ring(palette: &Palette, radius: f64, width: f64) -> Model {
    let segments = 16;
    let mut m = Model::default();
    let arc = |r: f64| {
        (0..=segments).map(move |i| {
            let (sin, cos) = (PI * f64::from(i) / f64::from(segments)).sin_cos();
            [r * cos, GAP + r * sin]
        })
    };
    let section: Vec<[f64; 2]> = arc(radius).chain(arc(radius - 0.05).rev()).collect();
    m.prism(&section, [0.0, width], 1.0, palette.window_bar);
    m
}

/// Returns a framed double door about the origin, in front of the plane `z = 0`.
fn door_and_frame(palette: &Palette) -> Model {
    let mut m = Model::default();
    let (half, height, frame) = (0.95, 2.6, 0.16);
    for side in [-1.0, 1.0] {
        let mut slab = |near: f64, far: f64, low: f64, high: f64, back: f64, front: f64, material| {
            let (a, b) = (side * near, side * far);
            m.block([a.min(b), low, back], [a.max(b), high, front], 0.5, material);
        };
        slab(half + GAP, half + frame, 0.0, height, 0.0, 0.10, palette.stone);
        slab(0.004, half, 0.0, height - GAP, 0.0, 0.05, palette.oak);
        for (low, high) in [(0.18, 0.85), (1.0, 1.6), (1.75, 2.42)] {
            slab(0.14, half - 0.14, low, high, 0.05 + GAP, 0.075, palette.walnut);
        }
    }
    let over = half + frame + 0.06;
    m.block([-over, height + GAP, 0.0], [over, height + 0.22, 0.13], 0.5, palette.stone);
    m
}
