//! Scenes that are stored as files in the repository.

use sir_geom::{Rgb, Scene, SceneError};

use crate::exact::{SphereShell, concentric_spheres, furnace};
use crate::office::{downlight_ies, recessed_ldt, task_ies};
use crate::{airplane_cabin, cornell_box, museum_stairs, office, reading_room};

/// Reflectance of the stored furnace, whose radiosity is 2, 5 and 10 W/m².
pub const FURNACE_REFLECTANCE: Rgb = Rgb::new(0.5, 0.8, 0.9);
/// Exitance of the stored furnace \[W/m²\].
pub const FURNACE_EXITANCE: Rgb = Rgb::ONE;
/// Inner sphere of the stored concentric spheres.
pub const INNER_SPHERE: SphereShell =
    SphereShell { radius: 1.0, reflectance: Rgb::splat(0.5), exitance: Rgb::splat(100.0) };
/// Outer sphere of the stored concentric spheres.
pub const OUTER_SPHERE: SphereShell =
    SphereShell { radius: 2.0, reflectance: Rgb::splat(0.8), exitance: Rgb::ZERO };

/// Scene with the path of its file.
#[derive(Clone, Debug)]
pub struct Stored {
    /// Path relative to the folder `scenes`, with `/` as separator.
    pub path: &'static str,
    /// Scene.
    pub scene: Scene,
}

/// Builds all stored scenes.
///
/// # Errors
///
/// None that can occur with the parameters above.
pub fn stored() -> Result<Vec<Stored>, SceneError> {
    Ok(vec![
        Stored { path: "cornell-box/cornell-box.gltf", scene: cornell_box()?.scene },
        Stored {
            path: "furnace/furnace.gltf",
            scene: furnace(1.0, FURNACE_REFLECTANCE, FURNACE_EXITANCE)?.scene,
        },
        Stored {
            path: "concentric-spheres/concentric-spheres.glb",
            scene: concentric_spheres(INNER_SPHERE, OUTER_SPHERE, 4)?.scene,
        },
        Stored { path: "reading-room/reading-room.glb", scene: reading_room()?.scene },
        Stored { path: "airplane-cabin/airplane-cabin.glb", scene: airplane_cabin()?.scene },
        Stored { path: "museum-stairs/museum-stairs.glb", scene: museum_stairs()?.scene },
        Stored { path: "office/office.glb", scene: office()?.scene },
    ])
}

/// Text file that belongs to a stored scene.
#[derive(Clone, Debug)]
pub struct StoredText {
    /// Path relative to the folder `scenes`, with `/` as separator.
    pub path: &'static str,
    /// Content.
    pub text: String,
}

/// Returns all stored text files: the photometric files of the office.
#[must_use]
pub fn stored_texts() -> Vec<StoredText> {
    vec![
        StoredText { path: "office/recessed.ldt", text: recessed_ldt() },
        StoredText { path: "office/downlight.ies", text: downlight_ies() },
        StoredText { path: "office/task.ies", text: task_ies() },
    ]
}
