//! A vaulted reading room.
//!
//! There are three kinds of light, and none reaches most of the room directly: cool skylight through deep windows on
//! one side, warm lamps that are hidden on the cornices and shine onto the vault, and small reading lamps under opaque
//! shades. A red rug, wood and pale plaster tint the reflected light.

mod bookcase;
mod columns;
mod dais;
mod openings;
mod palette;
mod shell;
mod size;
mod table;

use std::f64::consts::PI;

use glam::{DAffine3, DVec3};
use sir_geom::{Built, SceneBuilder, SceneError};

use crate::model::furnish::add_cameras;
use crate::model::sheet::lines;
use crate::model::{GAP, Model};
use crate::random::Random;
use bookcase::{Bookcase, books_on_table, ladder};
use palette::Palette;
use size::{BAY, BAYS, DAIS, HALF_WIDTH, LENGTH};
use table::TABLE_HEIGHT;

/// Returns a barrel-vaulted reading room, 8 m wide, 15 m long and 8.4 m high, with bookcases, tables, lamps and a dais.
///
/// The room is closed: no light escapes. The cameras are `nave` from the door toward the dais, `dais` back toward the
/// door, and `table` between the tables.
///
/// # Errors
///
/// None that can occur with the dimensions of the room; the signature is the same for all scenes.
pub fn reading_room() -> Result<Built, SceneError> {
    let mut builder = SceneBuilder::new();
    let palette = Palette::new(&mut builder);
    let mut random = Random::new(2009);
    let mut room = shell::shell(&palette);
    for part in [
        columns::columns(&palette),
        openings::openings(&palette),
        dais::dais(&palette),
        dais::niche(&palette),
        bookcases(&palette, &mut random),
        tables(&palette, &mut random),
        rug(&palette),
    ] {
        room.add_at(&part, 0.0, 0.0, 0.0);
    }
    room.add_at(&dais::globe(&palette), 2.4, DAIS + GAP, 1.2);
    room.store(&mut builder);
    let views = [
        ("nave", [-0.6, 1.75, LENGTH - 0.6], [0.2, 2.5, 0.0], 56.0),
        ("dais", [1.2, DAIS + 1.75, 1.2], [-0.6, 2.0, LENGTH], 58.0),
        ("table", [-0.2, 1.35, 11.2], [2.9, 1.05, 5.2], 45.0),
    ];
    add_cameras(&mut builder, &views);
    builder.build()
}

/// Returns tall bookcases between the columns opposite the windows, low ones under the windows, one on the dais, and a
/// ladder.
fn bookcases(palette: &Palette, random: &mut Random) -> Model {
    let mut m = Model::default();
    let tall = Bookcase { width: 2.36, depth: 0.4, height: 3.2, stacks: 2, shelves: 7 };
    let low = Bookcase { width: 2.36, depth: 0.34, height: 0.98, stacks: 2, shelves: 2 };
    let margin = 0.5 * (BAY - tall.width);
    for bay in 1..BAYS {
        // The column of the last bay stands inside the bay, in front of the end wall.
        let narrower = if bay + 1 == BAYS { 0.4 } else { 0.0 };
        let tall = Bookcase { width: tall.width - narrower, ..tall };
        let low = Bookcase { width: low.width - narrower, ..low };
        let z = BAY * bay as f64 + margin;
        let east = DAffine3::from_translation(DVec3::new(HALF_WIDTH - 0.005, GAP, z))
            * DAffine3::from_rotation_y(-0.5 * PI);
        m.add(&tall.build(palette, random), east);
        let west = DAffine3::from_translation(DVec3::new(0.005 - HALF_WIDTH, GAP, z + low.width))
            * DAffine3::from_rotation_y(0.5 * PI);
        m.add(&low.build(palette, random), west);
    }
    let on_dais = Bookcase { width: 1.5, depth: 0.4, height: 2.6, stacks: 2, shelves: 6 };
    let east = DAffine3::from_translation(DVec3::new(HALF_WIDTH - 0.005, DAIS + GAP, 0.62))
        * DAffine3::from_rotation_y(-0.5 * PI);
    m.add(&on_dais.build(palette, random), east);

    let reach = 0.70;
    let foot = HALF_WIDTH - 0.005 - tall.depth - 0.035 - reach;
    let place =
        DAffine3::from_translation(DVec3::new(foot, 0.008, 7.0)) * DAffine3::from_rotation_y(-0.5 * PI);
    m.add(&ladder(palette, 3.1, reach), place);
    m
}

/// Returns two rows of tables and the librarian's table, with chairs, lamps and books.
fn tables(palette: &Palette, random: &mut Random) -> Model {
    let mut m = Model::default();
    let (table, chair, lamp) = (table::table(palette), table::chair(palette), table::reading_lamp(palette));
    for z in [5.4, 8.6, 11.8] {
        for x in [-1.85, 1.85] {
            m.add_at(&table, x, GAP, z);
            for end in [-0.6, 0.6] {
                m.add_at(&lamp, x, GAP + TABLE_HEIGHT + GAP, z + end);
            }
            for side in [-1.0, 1.0] {
                for place in [-0.78, 0.0, 0.78] {
                    let pulled_out = random.between(0.60, 0.72);
                    let turn = side * 0.5 * PI + random.between(-0.12, 0.12);
                    let at = DVec3::new(x + side * pulled_out, GAP, z + place + random.between(-0.03, 0.03));
                    m.add(&chair, DAffine3::from_translation(at) * DAffine3::from_rotation_y(turn));
                }
                if random.unit() < 0.7 {
                    let turn = DAffine3::from_rotation_y(side * 0.5 * PI + random.between(-0.2, 0.2));
                    let along = [-0.8, 0.0, 0.8][random.below(3)];
                    let at = DVec3::new(x + side * 0.28, TABLE_HEIGHT + 2.0 * GAP, z + along);
                    m.add(&books_on_table(palette, random), DAffine3::from_translation(at) * turn);
                }
            }
        }
    }
    // The librarian's table, across the dais.
    let desk =
        DAffine3::from_translation(DVec3::new(-0.2, DAIS + GAP, 1.2)) * DAffine3::from_rotation_y(0.5 * PI);
    m.add(&table, desk);
    let seat = DAffine3::from_translation(DVec3::new(-0.2, DAIS + GAP, 0.5)) * DAffine3::from_rotation_y(PI);
    m.add(&chair, seat);
    m.add_at(&lamp, -0.9, DAIS + TABLE_HEIGHT + 2.0 * GAP, 1.2);
    m.add_at(&books_on_table(palette, random), 0.3, DAIS + TABLE_HEIGHT + 2.0 * GAP, 1.15);
    m
}

/// Returns the rug between the tables.
fn rug(palette: &Palette) -> Model {
    let mut m = Model::default();
    let x = [-0.7, -0.62, -0.54, -0.5, 0.0, 0.5, 0.54, 0.62, 0.7];
    let (from, to) = (3.9, 13.9);
    let mut z = vec![from, from + 0.08, from + 0.16, from + 0.2];
    z.extend(lines(from + 0.2, to - 0.2, 0.5).iter().skip(1));
    z.extend([to - 0.16, to - 0.08, to]);
    let color = |_, p: DVec3| {
        let edge = (0.7 - p.x.abs()).min((p.z - from).min(to - p.z));
        if (0.08..0.16).contains(&edge) { palette.rug_border } else { palette.rug }
    };
    m.grid_block([&x, &[GAP, 0.012], &z], color);
    m
}
