//! Seats in groups of three.
//!
//! Seats are modeled from the side: `x` runs from the front edge of the cushion backward, `y` up, and `z` across.

use glam::{DAffine3, DVec3};
use sir_geom::MaterialId;

use crate::airplane_cabin::palette::Palette;
use crate::airplane_cabin::seat_back::back_things;
use crate::airplane_cabin::seat_size::{ARM, HALF_BACK, HALF_GROUP, PIVOT, PLACE};
use crate::model::pillow::Ends;
use crate::model::{GAP, Model};
use crate::random::Random;

/// Section of the cushion \[m\].
///
/// All sections here are counterclockwise seen from the side. As [`Model::pillow`] requires, the first and the last
/// point face each other, then the second and the second to last, and so on.
const CUSHION: [[f64; 2]; 8] = [
    [0.02, 0.335],
    [0.12, 0.315],
    [0.41, 0.335],
    [0.432, 0.365],
    [0.425, 0.405],
    [0.28, 0.432],
    [0.06, 0.460],
    [0.0, 0.42],
];
/// Section of the backrest \[m\]. The first three edges are the rear, the sixth and seventh the shoulders.
const BACK: [[f64; 2]; 10] = [
    [0.520, 0.375],
    [0.5688, 0.62],
    [0.632, 0.935],
    [0.636, 0.962],
    [0.615, 0.99],
    [0.580, 0.99],
    [0.552, 0.968],
    [0.508, 0.78],
    [0.462, 0.62],
    [0.458, 0.375],
];
/// Section of the headrest \[m\].
const HEAD: [[f64; 2]; 8] = [
    [0.640, 1.0],
    [0.660, 1.07],
    [0.678, 1.15],
    [0.655, 1.195],
    [0.600, 1.190],
    [0.570, 1.14],
    [0.545, 1.05],
    [0.565, 1.0],
];
/// Section of an arm rest with its post, which reaches down beside the cushion \[m\].
const ARM_REST: [[f64; 2]; 8] = [
    [0.13, 0.602],
    [0.17, 0.595],
    [0.40, 0.59],
    [0.34, 0.35],
    [0.44, 0.35],
    [0.49, 0.60],
    [0.48, 0.645],
    [0.13, 0.64],
];

/// Returns three seats side by side that look along `−z`, with the middle of the group's front on the origin. The
/// middle seat has other colors.
///
/// Groups that are `near` a camera are rounder.
pub(super) fn group(palette: &Palette, random: &mut Random, near: bool) -> Model {
    let mut m = Model::default();
    for (i, colors) in
        [Colors::blue(palette), Colors::orange(palette), Colors::blue(palette)].iter().enumerate()
    {
        let z = (i as f64 - 1.0) * PLACE;
        m.add_at(&cushion(colors, near), 0.0, 0.0, z);
        // Most backs are upright, some are reclined a little.
        let lean = if random.unit() < 0.3 { random.between(0.02, 0.07) } else { 0.0 };
        let hinge = DAffine3::from_translation(PIVOT + DVec3::new(0.0, 0.0, z))
            * DAffine3::from_rotation_z(-lean)
            * DAffine3::from_translation(-PIVOT);
        let mut upright = back(colors, near);
        upright.add_at(&back_things(palette, random), 0.0, 0.0, 0.0);
        m.add(&upright, hinge);
    }
    for i in 0..4 {
        let z = (f64::from(i) - 1.5) * PLACE;
        let half = 0.5 * ARM;
        let (radius, pieces) = if near { (0.008, 1) } else { (0.0, 0) };
        let ends = Ends { radius, pieces, cell: 0.4, cut: 0.0 };
        m.pillow(&ARM_REST, [z - half, z + half], ends, |_| palette.armrest);
    }
    frame(&mut m, palette, near);
    let mut group = Model::default();
    group.add(&m, DAffine3::from_cols(DVec3::Z, DVec3::Y, -DVec3::X, DVec3::ZERO));
    group
}

/// Materials of the upholstery of a seat.
struct Colors {
    seat: MaterialId,
    back: MaterialId,
    shoulder: MaterialId,
    behind: MaterialId,
    head: MaterialId,
}

impl Colors {
    fn blue(palette: &Palette) -> Self {
        Self {
            seat: palette.fabric,
            back: palette.fabric,
            shoulder: palette.shoulder,
            behind: palette.backrest,
            head: palette.accent,
        }
    }

    fn orange(palette: &Palette) -> Self {
        Self {
            seat: palette.accent,
            back: palette.accent,
            shoulder: palette.accent_shoulder,
            behind: palette.backrest,
            head: palette.fabric,
        }
    }
}

fn cushion(colors: &Colors, near: bool) -> Model {
    let mut m = Model::default();
    soft(&mut m, &CUSHION, HALF_BACK, 0.028, near, |_| colors.seat);
    m
}

fn back(colors: &Colors, near: bool) -> Model {
    let mut m = Model::default();
    let color = |k: Option<usize>| match k {
        Some(0..3) => colors.behind,
        Some(5 | 6) => colors.shoulder,
        _ => colors.back,
    };
    soft(&mut m, &BACK, HALF_BACK, 0.02, near, color);
    soft(&mut m, &HEAD, HALF_BACK - 0.022, 0.028, near, |_| colors.head);
    m
}

/// Adds a pillow from `-half` to `half`.
fn soft(
    m: &mut Model,
    section: &[[f64; 2]],
    half: f64,
    radius: f64,
    near: bool,
    material: impl Fn(Option<usize>) -> MaterialId,
) {
    let (pieces, cut) = if near { (2, 0.025) } else { (1, 0.0) };
    m.pillow(section, [-half, half], Ends { radius, pieces, cell: 0.4, cut }, material);
}

/// Adds the beam under a group and its legs.
fn frame(m: &mut Model, palette: &Palette, near: bool) {
    let half = HALF_GROUP - 0.06;
    m.block([0.12, 0.26, -half], [0.37, 0.30, half], 0.7, palette.metal);
    for z in [-0.42, 0.42] {
        // Front legs are visible only from nearby.
        for [low, high] in [[0.46, 0.335], [0.12, 0.125]].into_iter().take(if near { 2 } else { 1 }) {
            let leg = [[low, GAP], [low + 0.04, GAP], [high + 0.04, 0.26 - GAP], [high, 0.26 - GAP]];
            m.prism(&leg, [z - 0.022, z + 0.022], 1.0, palette.metal);
        }
    }
}
