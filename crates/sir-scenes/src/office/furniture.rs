//! Places of the furniture.

use std::f64::consts::PI;

use glam::{DAffine3, DVec3};

use crate::model::{GAP, Model};
use crate::office::chair::{plain_chair, swivel_chair};
#[cfg(test)]
use crate::office::desk::TASK_LIGHT;
use crate::office::desk::desk;
use crate::office::palette::Palette;
use crate::office::size::{COLUMNS, DEPTH, DOWNLIGHTS, HEIGHT, LENGTH};
use crate::office::storage::{STORAGE_DEPTH, cabinet, plant, shelf};
use crate::random::Random;

/// Position of a desk on the floor, and the side on which its user sits: −1 at `−x`, 1 at `+x`.
pub(super) type Place = ([f64; 2], f64);

/// Returns the places of the desks: pairs that face each other, with the windows to the side of their users.
pub(super) fn desk_places() -> Vec<Place> {
    let clusters: [(f64, &[f64]); 3] = [(2.85, &[1.5, 3.1]), (6.3, &[1.5, 3.1]), (9.75, &[1.5, 3.1])];
    let pairs = clusters.iter().flat_map(|(x, rows)| rows.iter().map(move |z| (x, z)));
    pairs.flat_map(|(x, z)| [([x - 0.41, *z], -1.0), ([x + 0.41, *z], 1.0)]).collect()
}

/// Returns the center of the luminous opening of the task lamp of a desk.
#[cfg(test)]
pub(super) fn task_light(place: Place) -> DVec3 {
    on_floor(place).transform_point3(TASK_LIGHT)
}

/// Returns the transformation from the frame of a desk to the room.
fn on_floor(([x, z], side): Place) -> DAffine3 {
    DAffine3::from_translation(DVec3::new(x, 0.0, z)) * DAffine3::from_rotation_y(side * 0.5 * PI)
}

/// Returns the desks with their chairs.
pub(super) fn desks(palette: &Palette, random: &mut Random) -> Model {
    let mut m = Model::default();
    let chair = swivel_chair(palette);
    for place in desk_places() {
        m.add(&desk(palette, random), on_floor(place));
        let seat = DVec3::new(random.between(-0.15, 0.2), GAP, random.between(0.62, 0.8));
        let turn = DAffine3::from_rotation_y(random.between(-0.5, 0.5));
        m.add(&chair, on_floor(place) * DAffine3::from_translation(seat) * turn);
    }
    m
}

/// Returns a round table with four chairs on a rug.
pub(super) fn meeting_table(palette: &Palette, random: &mut Random) -> Model {
    let mut m = Model::default();
    m.lathe(&[[0.28, GAP], [0.28, 0.016], [0.04, 0.03]], 28, palette.metal);
    m.lathe(&[[0.035, 0.03 + GAP], [0.035, 0.69], [0.12, 0.714 - GAP]], 16, palette.metal);
    m.lathe(&[[0.585, 0.714], [0.6, 0.722], [0.6, 0.735], [0.594, 0.738]], 48, palette.white);
    let chair = plain_chair(palette);
    for quarter in 0..4 {
        let turn = 0.5 * PI * (f64::from(quarter) + 0.5) + random.between(-0.12, 0.12);
        let out = DAffine3::from_translation(DVec3::new(0.0, GAP, random.between(0.52, 0.66)));
        m.add(&chair, DAffine3::from_rotation_y(turn) * out);
    }
    let rug = 0.008;
    let mut whole = Model::default();
    let mut round = Model::default();
    round.lathe(&[[1.35, GAP], [1.35, rug - 0.003], [1.345, rug]], 48, palette.rug);
    whole.add_at(&round, 2.3, 0.0, 6.1);
    whole.add_at(&m, 2.3, GAP + rug, 6.1);
    whole
}

/// Returns shelves and cabinets along the rear wall, and plants.
pub(super) fn storage(palette: &Palette, random: &mut Random) -> Model {
    let mut m = Model::default();
    let mut right = 1.35;
    let mut along_wall = |unit: &Model, width: f64| {
        right += width + 0.004;
        let place = DAffine3::from_translation(DVec3::new(right, GAP, DEPTH - 0.004));
        m.add(unit, place * DAffine3::from_rotation_y(PI));
    };
    for width in [1.0, 1.0, 1.0] {
        along_wall(&shelf(palette, random, width, 5), width);
    }
    for width in [1.2; 6] {
        along_wall(&cabinet(palette, width, 1.1), width);
    }
    m.add_at(&plant(palette, random), 0.42, GAP, 0.48);
    m.add_at(&plant(palette, random), LENGTH - 0.45, GAP, 0.5);
    // An island in the middle of the room, lower than the work plane.
    let low = cabinet(palette, 1.2, 0.73);
    for i in 0..3 {
        let x = 5.1 + 1.204 * f64::from(i);
        m.add_at(&low, x, GAP, 5.85);
        let turned = DAffine3::from_translation(DVec3::new(x + 1.2, GAP, 5.845));
        m.add(&low, turned * DAffine3::from_rotation_y(PI));
    }
    for x in [5.54, 6.05] {
        let small = DAffine3::from_translation(DVec3::new(x, 0.73 + 2.0 * GAP, 5.93))
            * DAffine3::from_scale(DVec3::splat(0.58));
        m.add(&plant(palette, random), small);
    }
    // Boxes on the low cabinets.
    for (x, width, height) in [(5.2, 0.36, 0.24), (5.62, 0.3, 0.18), (8.6, 0.42, 0.26)] {
        let z = DEPTH - 0.5 * STORAGE_DEPTH;
        m.block([x, 1.1 + 2.0 * GAP, z - 0.14], [x + width, 1.1 + height, z + 0.14], 9.0, palette.binders[1]);
    }
    m
}

/// Returns the door, the boards on the walls, and the skirting.
pub(super) fn walls(palette: &Palette) -> Model {
    let mut m = Model::default();
    let (from, to, top) = (6.75, 7.65, 2.1);
    m.block([GAP, GAP, from], [0.03, top, to], 9.0, palette.door);
    for z in [from - 0.07 - GAP, to + GAP] {
        m.block([GAP, GAP, z], [0.045, top + 0.07, z + 0.07], 9.0, palette.frame);
    }
    m.block([GAP, top + GAP, from], [0.045, top + 0.07, to], 9.0, palette.frame);
    m.block([0.03 + GAP, 1.03, from + 0.06], [0.075, 1.05, from + 0.08], 9.0, palette.metal);
    m.block([0.06, 1.03, from + 0.08 + GAP], [0.075, 1.05, from + 0.20], 9.0, palette.metal);

    // A white board, panels of felt that absorb sound, and pictures.
    m.block([GAP, 0.9, 4.3], [0.02, 2.1, 6.1], 9.0, palette.metal);
    m.block([0.02 + GAP, 0.915, 4.315], [0.025, 2.085, 6.085], 9.0, palette.white);
    for (i, z) in [0.95, 1.85, 2.75].into_iter().enumerate() {
        let color = if i == 1 { palette.binders[5] } else { palette.felt };
        m.block([GAP, 0.9, z], [0.04, 2.1, z + 0.84], 9.0, color);
    }
    for (i, x) in [6.0, 7.4, 8.8].into_iter().enumerate() {
        let color = palette.binders[[4, 3, 1][i]];
        m.block([x, 1.45, DEPTH - 0.03], [x + 1.0, 2.15, DEPTH - GAP], 9.0, color);
    }
    m.block([LENGTH - 0.03, 0.9, 2.2], [LENGTH - GAP, 2.1, 5.2], 9.0, palette.felt);

    let (low, high, thick) = (GAP, 0.06, 0.014);
    m.block([GAP, low, 0.02], [thick, high, from - 0.075], 9.0, palette.dark);
    m.block([GAP, low, to + 0.075], [thick, high, DEPTH - 0.02], 9.0, palette.dark);
    m.block([LENGTH - thick, low, 0.02], [LENGTH - GAP, high, DEPTH - 0.02], 9.0, palette.dark);
    m.block([0.02, low, GAP], [LENGTH - 0.02, high, thick], 9.0, palette.dark);
    m
}

/// Returns the housings of the downlights: rings around shallow cups in the ceiling.
pub(super) fn downlights(palette: &Palette) -> Model {
    let mut m = Model::default();
    let (cup, rim, top) = (-0.004, -0.009, -GAP);
    let profile = [[0.0, cup], [0.078, cup], [0.078, rim], [0.092, rim], [0.095, top]];
    let mut housing = Model::default();
    housing.lathe(&profile, 32, palette.luminaire);
    for x in COLUMNS {
        m.add_at(&housing, x, HEIGHT, DOWNLIGHTS);
    }
    m
}
