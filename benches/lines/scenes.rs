//! Scenes of the benchmark.

use std::path::{Path, PathBuf};

use glam::DVec3;
use sir::geom::{LoadOptions, Material, Rgb, Scene, SceneBuilder, load, shapes};

/// Loads a scene, or returns `None` if its file does not exist.
type Source = fn() -> Option<Scene>;

/// Scenes by name. Third-party scenes are skipped if their files do not exist.
pub(crate) const ALL: [(&str, Source); 6] = [
    ("reading-room", || own("reading-room")),
    ("museum-stairs", || own("museum-stairs")),
    ("airplane-cabin", || own("airplane-cabin")),
    ("soda", || third_party("mgf-soda/soda.obj")),
    ("staircase", || third_party("staircase/staircase.obj")),
    ("living-room-2", || third_party("living-room-2/living-room-2.obj")),
];

/// Loads one of the project's own scenes.
fn own(name: &str) -> Option<Scene> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(name).join(format!("{name}.glb"));
    Some(load(&path, &LoadOptions::default()).unwrap().scene)
}

/// Loads a third-party scene from the folder in `SIR_TEST_DATA`, or from the folder `shared` next to the repository.
fn third_party(path: &str) -> Option<Scene> {
    let data = std::env::var_os("SIR_TEST_DATA")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared"), PathBuf::from);
    let path = data.join("scenes").join(path);
    if !path.is_file() {
        println!("skipped: no file {}", path.display());
        return None;
    }
    Some(load(&path, &LoadOptions::default()).unwrap().scene)
}

/// Returns a room with sixty-four balls of `20 · 4^level` triangles each.
pub(crate) fn balls(level: u32) -> Scene {
    let mut builder = SceneBuilder::new();
    let gray = builder.add_material(Material::diffuse("gray", Rgb::splat(0.5)));
    shapes::cuboid(&mut builder, DVec3::ZERO, DVec3::splat(4.0), [gray; 6], shapes::Facing::Inward);
    for i in 0..64 {
        let place = DVec3::new(f64::from(i % 4), f64::from(i / 4 % 4), f64::from(i / 16));
        let jitter = DVec3::new(0.05 * f64::from(i % 3), 0.04 * f64::from(i % 5), 0.03 * f64::from(i % 7));
        let radius = 0.2 + 0.02 * f64::from(i % 6);
        shapes::sphere(&mut builder, place + 0.4 + jitter, radius, level, shapes::Facing::Outward, |_| gray);
    }
    builder.build().unwrap().scene
}
