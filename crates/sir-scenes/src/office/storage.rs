//! Shelves with binders, cabinets, and a plant.

use std::f64::consts::TAU;

use glam::{DAffine3, DVec3};

use crate::model::{GAP, Model};
use crate::office::palette::Palette;
use crate::random::Random;

/// Thickness of boards \[m\].
const BOARD: f64 = 0.022;
/// Depth of shelves and cabinets \[m\].
pub(super) const STORAGE_DEPTH: f64 = 0.42;

/// Returns an open shelf with binders. Its left rear corner stands on the origin, and its front faces `+z`.
pub(super) fn shelf(palette: &Palette, random: &mut Random, width: f64, levels: u32) -> Model {
    let mut m = Model::default();
    let (pitch, depth) = (0.38, STORAGE_DEPTH);
    let height = 0.08 + pitch * f64::from(levels) + BOARD;
    let wood = palette.cabinet;
    m.block([0.0, 0.0, 0.0], [width, height, 0.012], 9.0, wood);
    let front = 0.012 + GAP;
    for x in [0.0, width - BOARD] {
        m.block([x, 0.0, front], [x + BOARD, height, depth], 9.0, wood);
    }
    let (left, right) = (BOARD + GAP, width - BOARD - GAP);
    m.block([left, 0.0, front], [right, 0.08, depth - 0.02], 9.0, wood);
    m.block([left, height - BOARD, front], [right, height, depth - GAP], 9.0, wood);
    for level in 0..levels {
        let floor = 0.08 + pitch * f64::from(level) + GAP;
        m.block([left, floor, front], [right, floor + BOARD - GAP, depth - GAP], 9.0, wood);
        let mut x = left + 0.004 + if random.unit() < 0.3 { 0.25 * random.unit() } else { 0.0 };
        let mut color = palette.binders[random.below(palette.binders.len())];
        while x + 0.08 < right {
            if random.unit() < 0.18 {
                x += random.between(0.03, 0.2);
                color = palette.binders[random.below(palette.binders.len())];
                continue;
            }
            let thick = if random.unit() < 0.7 { 0.075 } else { 0.05 };
            let back = random.between(0.05, 0.07);
            let low = floor + BOARD;
            m.block([x, low, back], [x + thick, low + 0.315, back + 0.285], 9.0, color);
            m.block(
                [x + 0.012, low + 0.14, back + 0.285 + GAP],
                [x + thick - 0.012, low + 0.27, back + 0.288],
                9.0,
                palette.paper,
            );
            x += thick + 0.003;
        }
    }
    m
}

/// Returns a cabinet with two doors. Its left rear corner stands on the origin, and its front faces `+z`.
pub(super) fn cabinet(palette: &Palette, width: f64, height: f64) -> Model {
    let mut m = Model::default();
    let front = STORAGE_DEPTH - 0.02;
    m.block([0.02, 0.0, 0.02], [width - 0.02, 0.06, front - 0.03], 9.0, palette.dark);
    m.block([0.0, 0.06 + GAP, 0.0], [width, height, front - GAP], 9.0, palette.cabinet);
    let middle = 0.5 * width;
    for [left, right, handle] in
        [[0.003, middle - 0.002, middle - 0.04], [middle + 0.002, width - 0.003, middle + 0.03]]
    {
        m.block([left, 0.066, front], [right, height - 0.004, STORAGE_DEPTH - 0.004], 9.0, palette.cabinet);
        let high = height - 0.08;
        m.block(
            [handle, high - 0.14, STORAGE_DEPTH - 0.003],
            [handle + 0.01, high, STORAGE_DEPTH + 0.012],
            9.0,
            palette.metal,
        );
    }
    m
}

/// Returns a plant in a pot, on the origin.
pub(super) fn plant(palette: &Palette, random: &mut Random) -> Model {
    let mut m = Model::default();
    let pot = [[0.15, 0.0], [0.19, 0.36], [0.175, 0.36], [0.17, 0.31], [0.0, 0.31]];
    m.lathe(&pot, 20, palette.pot);
    let leaves = 13;
    for i in 0..leaves {
        // Inner leaves are steeper. Each has its own direction, so that no two meet.
        let share = f64::from(i) / f64::from(leaves - 1);
        let turn = TAU * (0.381_966 * f64::from(i) + random.between(-0.01, 0.01));
        let place = DAffine3::from_rotation_y(turn)
            * DAffine3::from_translation(DVec3::new(0.025 + 0.1 * share, 0.312, 0.0));
        m.add(&leaf(palette, 1.15 - 0.45 * share, 0.12 + 0.95 * share), place);
    }
    m
}

/// Returns a sword-shaped leaf that rises from the origin and bends toward `+x` by an angle at its end.
fn leaf(palette: &Palette, length: f64, bend: f64) -> Model {
    let mut m = Model::default();
    let rings = 9;
    let point = |i: usize, j: usize| {
        let along = i as f64 / (rings - 1) as f64;
        let angle = bend * along;
        // A circular arc.
        let center = length / bend * DVec3::new(1.0 - angle.cos(), angle.sin(), 0.0);
        let width = 0.004 + 0.03 * (along * (1.0 - along) * 4.0).sqrt() * (1.0 - 0.5 * along);
        let normal = DVec3::new(angle.cos(), -angle.sin(), 0.0);
        let [across, out] = [[width, 0.0], [0.0, 0.003], [-width, 0.0], [0.0, -0.003]][j];
        center + across * DVec3::Z + (out + 0.25 * across.abs()) * normal
    };
    m.loft(rings, 4, point, |_, _| palette.leaf);
    m
}
