//! An open-plan office by day and night, with the photometric files of its luminaires.
//!
//! The scene itself has no lamps. Pipelines add them: recessed luminaires in the tiles of the ceiling, downlights along
//! the rear wall, task lamps on the desks, and a sky. The room is the cavity of a building on a street, with windows on
//! one long side.

mod chair;
mod desk;
mod furniture;
mod palette;
mod photometric;
mod shell;
mod size;
mod storage;

use glam::DVec3;
use sir_geom::{Built, Camera, Projection, SceneBuilder, SceneError};

use crate::model::Model;
use crate::model::furnish::add_cameras;
use crate::random::Random;
use palette::Palette;
use size::{DEPTH, HEIGHT, LENGTH};

pub use photometric::{DOWNLIGHT_FLUX, RECESSED_FLUX, TASK_FLUX};
pub(crate) use photometric::{downlight_ies, recessed_ldt, task_ies};

/// Returns an office, 12.6 m long, 8.4 m deep and 2.8 m high, with twelve desks and a meeting table.
///
/// The building, its furniture and what is outside are closed solids. The cameras are `room` from a corner, `desk` over
/// a desk toward the windows, and `plan` from above, without perspective.
///
/// # Errors
///
/// None that can occur with the dimensions of the room; the signature is the same for all scenes.
pub fn office() -> Result<Built, SceneError> {
    let mut builder = SceneBuilder::new();
    let palette = Palette::new(&mut builder);
    let mut random = Random::new(42);
    let mut all = Model::default();
    for part in [
        shell::building(&palette),
        shell::windows(&palette),
        shell::street(&palette),
        furniture::walls(&palette),
        furniture::desks(&palette, &mut random),
        furniture::meeting_table(&palette, &mut random),
        furniture::storage(&palette, &mut random),
        furniture::downlights(&palette),
    ] {
        all.add_at(&part, 0.0, 0.0, 0.0);
    }
    all.store(&mut builder);
    let views = [
        ("room", [12.2, 1.66, 7.75], [4.6, 1.1, 2.7], 54.0),
        ("desk", [7.35, 1.42, 5.0], [5.85, 0.86, 1.3], 50.0),
    ];
    add_cameras(&mut builder, &views);
    let below_ceiling = DVec3::new(0.5 * LENGTH, HEIGHT - 0.05, 0.5 * DEPTH);
    builder.add_camera(Camera {
        name: "plan".to_owned(),
        eye: below_ceiling,
        forward: DVec3::NEG_Y,
        up: DVec3::NEG_Z,
        projection: Projection::Orthographic { height: DEPTH },
        aspect: Some(LENGTH / DEPTH),
    });
    builder.build()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn task_lights_are_where_the_pipelines_have_them() {
        let places = furniture::desk_places();
        assert_eq!(places.len(), 12);
        let first = furniture::task_light(places[0]);
        assert!(first.distance(DVec3::new(2.64, 1.166, 1.16)) < 1e-9, "{first}");
        let second = furniture::task_light(places[1]);
        assert!(second.distance(DVec3::new(3.06, 1.166, 1.84)) < 1e-9, "{second}");
    }
}
