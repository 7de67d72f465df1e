//! The cabin of an airliner.
//!
//! Almost all lamps are hidden. The light of violet-blue lamps on the overhead bins and of amber lamps above the middle
//! of the ceiling mixes on the vault. Warm strips under the bins illuminate the side walls. Skylight enters through
//! deep windows, many of which have their blinds down. Blue and orange seats tint the pale panels.

mod bulkhead;
mod galley;
mod overhead;
mod palette;
mod seat;
mod seat_back;
mod seat_size;
mod shell;
mod size;
mod spine;
mod window;

use sir_geom::{Built, SceneBuilder, SceneError};

use crate::model::furnish::add_cameras;
use crate::model::{GAP, Model};
use crate::random::Random;
use palette::Palette;
use seat_size::HALF_GROUP;
use size::{AISLE, FIRST_ROW, FRONT, PITCH, REAR, ROWS, near};

/// Returns the cabin of an airliner with one aisle, 3.7 m wide and 27 m long, with 29 rows of six seats between two
/// galleys.
///
/// The cabin is closed: no light escapes. The cameras are `aisle` along the aisle from the rear, `row` from a seat
/// toward its neighbors and the windows, and `galley` from the front over the seats.
///
/// # Errors
///
/// None that can occur with the dimensions of the cabin; the signature is the same for all scenes.
pub fn airplane_cabin() -> Result<Built, SceneError> {
    let mut builder = SceneBuilder::new();
    let palette = Palette::new(&mut builder);
    let mut random = Random::new(320);
    let mut cabin = shell::shell(&palette, &mut random);
    for part in [
        seats(&palette, &mut random),
        overhead::overhead(&palette, &mut random),
        spine::spine(&palette),
        bulkhead::bulkheads(&palette),
        galley::galleys(&palette),
    ] {
        cabin.add_at(&part, 0.0, 0.0, 0.0);
    }
    cabin.store(&mut builder);
    let row = FIRST_ROW + PITCH * 12.0;
    let views = [
        ("aisle", [0.0, 1.6, REAR - 7.1], [0.0, 1.2, 2.0], 52.0),
        ("row", [-0.55, 1.30, row + 0.62], [1.5, 0.96, row - 1.05], 52.0),
        ("galley", [0.12, 1.72, FRONT + 0.15], [-0.1, 1.2, FRONT + 6.0], 62.0),
    ];
    add_cameras(&mut builder, &views);
    builder.build()
}

/// Returns all seats and the floor marks beside them.
fn seats(palette: &Palette, random: &mut Random) -> Model {
    let mut m = Model::default();
    for row in 0..ROWS {
        let z = FIRST_ROW + PITCH * row as f64;
        for side in [-1.0, 1.0] {
            let group = seat::group(palette, random, near(side, z));
            m.add_at(&group, side * (AISLE + HALF_GROUP), 0.0, z);
            if row % 2 == 0 {
                let x = side * (AISLE + 0.04);
                m.grid_block([&[x - 0.02, x + 0.02], &[GAP, 0.012], &[z + 0.25, z + 0.33]], |d, _| {
                    if d.y > 0.0 { palette.floor_lamp } else { palette.dark }
                });
            }
        }
    }
    m
}
