//! Desks with what stands on them.

use glam::{DAffine3, DVec3};

use crate::model::pillow::Ends;
use crate::model::{GAP, Model};
use crate::office::palette::Palette;
use crate::office::size::DESK;
use crate::random::Random;

/// Half the width of a desk \[m\].
const HALF_WIDTH: f64 = 0.795;
/// Half the depth of a desk \[m\].
const HALF_DEPTH: f64 = 0.395;
/// Height of the underside of the head of a task lamp above the desk \[m\].
const LAMP_HEIGHT: f64 = 0.43;

/// Center of the luminous opening of the task lamp of a desk in the frame of [`desk`], 1 mm below the head of the lamp.
#[cfg(test)]
pub(super) const TASK_LIGHT: DVec3 = DVec3::new(-0.34, DESK + LAMP_HEIGHT + GAP, -0.2);

/// Returns a desk about the origin, 1.6 m along `x`, whose user sits at `+z` and looks toward `−z`.
pub(super) fn desk(palette: &Palette, random: &mut Random) -> Model {
    let mut m = Model::default();
    let top = Ends { radius: 0.006, pieces: 1, cell: 9.0, cut: 0.0 };
    let (w, d) = (HALF_WIDTH, HALF_DEPTH);
    m.pillow(&[[-w, DESK - 0.025], [w, DESK - 0.025], [w, DESK], [-w, DESK]], [-d, d], top, |_| palette.desk);
    let under = DESK - 0.025 - GAP;
    for side in [-1.0, 1.0] {
        let x = side * (w - 0.1);
        m.block([x - 0.03, GAP, -0.34], [x + 0.03, 0.03, 0.34], 9.0, palette.metal);
        m.block([x - 0.025, 0.03 + GAP, -0.045], [x + 0.025, under - 0.03 - GAP, 0.045], 9.0, palette.metal);
        m.block([x - 0.03, under - 0.03, -0.33], [x + 0.03, under, 0.33], 9.0, palette.metal);
    }
    m.block([-w + 0.16, under - 0.30, -d + 0.08], [w - 0.16, under - GAP, -d + 0.095], 9.0, palette.white);
    let on_top = DESK + GAP;
    let at = |x: f64, z: f64, turn: f64| {
        DAffine3::from_translation(DVec3::new(x, on_top, z)) * DAffine3::from_rotation_y(turn)
    };
    m.add(&screen(palette), at(0.2, -0.2, random.between(-0.06, 0.06)));
    m.add(&keyboard(palette), at(0.16 + random.between(-0.03, 0.03), 0.14, random.between(-0.04, 0.04)));
    m.add_at(&task_lamp(palette), 0.0, on_top, 0.0);
    m.add(&papers(palette, random), at(-0.42, 0.17, random.between(-0.35, 0.35)));
    if random.unit() < 0.6 {
        m.add_at(&mug(palette, random), 0.66 + random.between(-0.05, 0.05), on_top, -0.245);
    }
    m
}

/// Returns a screen on a foot; it faces `+z`.
fn screen(palette: &Palette) -> Model {
    let mut m = Model::default();
    m.block([-0.12, 0.0, -0.09], [0.12, 0.01, 0.09], 9.0, palette.metal);
    m.block([-0.03, 0.01 + GAP, -0.045], [0.03, 0.30, -0.025], 9.0, palette.metal);
    let back = [-0.025 + GAP, 0.012];
    m.block([-0.305, 0.11, back[0]], [0.305, 0.46, back[1]], 9.0, palette.dark);
    m.block([-0.298, 0.117, back[1] + GAP], [0.298, 0.453, back[1] + 0.003], 9.0, palette.screen);
    m
}

/// Returns a keyboard and a mouse. They end below the work plane at 0.75 m.
fn keyboard(palette: &Palette) -> Model {
    let mut m = Model::default();
    m.block([-0.215, 0.0, -0.065], [0.215, 0.008, 0.065], 9.0, palette.dark);
    for row in 0..4 {
        let z = -0.055 + 0.028 * f64::from(row);
        m.block([-0.205, 0.008 + GAP, z], [0.205, 0.012, z + 0.023], 9.0, palette.metal);
    }
    m.block([0.27, 0.0, -0.045], [0.33, 0.012, 0.055], 9.0, palette.dark);
    m
}

/// Returns a few sheets of paper, or a notebook.
fn papers(palette: &Palette, random: &mut Random) -> Model {
    let mut m = Model::default();
    let cover = palette.binders[random.below(palette.binders.len())];
    let material = if random.unit() < 0.5 { palette.paper } else { cover };
    m.block([-0.105, 0.0, -0.148], [0.105, 0.006, 0.148], 9.0, material);
    m
}

/// Returns a mug without a handle.
fn mug(palette: &Palette, random: &mut Random) -> Model {
    let mut m = Model::default();
    let color = palette.binders[random.below(palette.binders.len())];
    let profile = [[0.036, 0.0], [0.041, 0.095], [0.037, 0.095], [0.033, 0.05], [0.0, 0.05]];
    m.lathe(&profile, 14, color);
    m
}

/// Returns a task lamp: a foot at the rear left of a desk, two arms, and a flat head whose opening is at [`TASK_LIGHT`].
fn task_lamp(palette: &Palette) -> Model {
    let mut m = Model::default();
    let foot = DVec3::new(-0.68, 0.0, -0.2);
    let mut base = Model::default();
    base.lathe(&[[0.085, 0.0], [0.085, 0.008], [0.02, 0.011]], 20, palette.dark);
    let joint = 0.36;
    base.lathe(&[[0.011, 0.011 + GAP], [0.011, joint]], 10, palette.metal);
    base.lathe(&[[0.017, joint + GAP], [0.017, joint + 0.03]], 10, palette.dark);
    m.add_at(&base, foot.x, foot.y, foot.z);
    // The upper arm rises from the joint to the near end of the head.
    let head = [-0.50, -0.18];
    let from = DVec3::new(foot.x + 0.02, joint + 0.02, foot.z);
    let to = DVec3::new(head[0] - 0.004, LAMP_HEIGHT + 0.016, foot.z);
    let mut arm = Model::default();
    arm.block([0.0, -0.007, -0.008], [from.distance(to), 0.007, 0.008], 9.0, palette.metal);
    let angle = (to.y - from.y).atan2(to.x - from.x);
    m.add(&arm, DAffine3::from_translation(from) * DAffine3::from_rotation_z(angle));
    let section = [
        [head[0], LAMP_HEIGHT + GAP],
        [head[1], LAMP_HEIGHT + GAP],
        [head[1], LAMP_HEIGHT + 0.02],
        [head[0], LAMP_HEIGHT + 0.024],
    ];
    let ends = Ends { radius: 0.008, pieces: 1, cell: 9.0, cut: 0.0 };
    m.pillow(&section, [foot.z - 0.035, foot.z + 0.035], ends, |_| palette.dark);
    m
}
