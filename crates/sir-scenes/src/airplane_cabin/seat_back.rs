//! Fittings on the rear of a backrest: a screen, a folded table, and a pocket with a magazine.

use glam::{DAffine3, DVec3};

use crate::airplane_cabin::palette::Palette;
use crate::airplane_cabin::seat_size::HALF_BACK;
use crate::model::{GAP, Model};
use crate::random::Random;

/// Lower end of the flat part of the rear \[m\].
const FOOT: DVec3 = DVec3::new(0.5365, 0.45, 0.0);
/// Slope of the rear, relative to the vertical.
const SLOPE: f64 = 0.1975;

/// Returns the fittings on the rear of an upright backrest, in the coordinates of a seat.
pub(super) fn back_things(palette: &Palette, random: &mut Random) -> Model {
    // Here `x` is the distance from the rear, and `y` runs up along it.
    let mut m = Model::default();
    table(&mut m, palette);
    screen(&mut m, palette, random);
    pocket(&mut m, palette, random);
    let mut placed = Model::default();
    placed.add(&m, DAffine3::from_translation(FOOT) * DAffine3::from_rotation_z(-SLOPE.atan()));
    placed
}

fn table(m: &mut Model, palette: &Palette) {
    let section = [[0.004, 0.172], [0.020, 0.180], [0.020, 0.366], [0.004, 0.374]];
    let half = HALF_BACK - 0.024;
    m.prism(&section, [-half, half], 1.0, palette.tray);
}

fn screen(m: &mut Model, palette: &Palette, random: &mut Random) {
    m.block([0.004, 0.382, -0.105], [0.014, 0.494, 0.105], 1.0, palette.dark);
    let lit = random.unit() < 0.55;
    let [sea, land, route] = palette.screens;
    let split = random.between(-0.06, 0.06);
    let [left, right] = [[sea, land], [land, sea], [route, sea], [sea, sea]][random.below(4)];
    let columns: &[f64] = if left == right { &[-0.094, 0.094] } else { &[-0.094, split, 0.094] };
    m.grid_block([&[0.014 + GAP, 0.018], &[0.392, 0.484], columns], |d, p| match d.x > 0.0 {
        true if lit && p.z < split => left,
        true if lit => right,
        _ => palette.dark,
    });
}

fn pocket(m: &mut Model, palette: &Palette, random: &mut Random) {
    let section = [[0.018, 0.0], [0.034, 0.004], [0.042, 0.05], [0.032, 0.12], [0.026, 0.12]];
    let half = HALF_BACK - 0.03;
    m.prism(&section, [-half, half], 1.0, palette.pocket);
    if random.unit() < 0.7 {
        let cover = palette.magazines[random.below(palette.magazines.len())];
        let left = random.between(-0.13, -0.03);
        let top = random.between(0.14, 0.165);
        m.block([0.006, 0.01, left], [0.014, top, left + 0.16], 1.0, cover);
    }
}
