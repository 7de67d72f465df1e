//! Hashes that identify scenes, pipelines and programs.

use sha2::{Digest, Sha256};
use sir_geom::{Material, Sides};
use sir_radiosity::{Grouping, Model, ViewFactorSettings};

use crate::plan::{Action, Pipeline};

/// Name and version of this program.
pub const PROGRAM: &str = concat!("sir ", env!("CARGO_PKG_VERSION"));

/// SHA-256 hash.
pub type Fingerprint = [u8; 32];

/// Returns the hash of everything that determines the result of a run: equal hashes mean equal results.
pub(crate) fn of_run(pipeline: &Pipeline, seed: u64, model: &Model) -> Fingerprint {
    let mut hash = Sha256::new();
    hash.update(PROGRAM);
    hash.update(seed.to_le_bytes());
    hash.update((pipeline.text.len() as u64).to_le_bytes());
    hash.update(&pipeline.text);
    // The text has only the names of files of points, not their contents.
    for stage in &pipeline.stages {
        if let Action::Sensors(sensors) = &stage.action
            && let Some(sensors) = sensors.at.value.listed()
        {
            let numbers =
                sensors.iter().flat_map(|s| [s.position(), s.direction()]).flat_map(|v| v.to_array());
            numbers.for_each(|x| hash.update(x.to_bits().to_le_bytes()));
        }
    }
    hash.update(of_scene(model));
    hash.finalize().into()
}

/// Returns the hash of the surfaces of a scene, their patches, and its lights.
pub(crate) fn of_scene(model: &Model) -> Fingerprint {
    let Model { scene, mesh, .. } = model;
    let mut hash = Sha256::new();
    let mut number = |n: u64| hash.update(n.to_le_bytes());
    number(scene.vertices().len() as u64);
    for vertex in scene.vertices() {
        vertex.to_array().iter().for_each(|x| number(x.to_bits()));
    }
    for triangle in scene.triangles() {
        triangle.vertices.iter().for_each(|v| number(v.0.into()));
        number(triangle.material.0.into());
    }
    for material in scene.materials() {
        let colors = [material.reflectance, material.exitance];
        colors.iter().flat_map(|c| c.to_array()).for_each(|x| number(x.to_bits()));
        number(u64::from(material.sides == Sides::Both) + 2 * u64::from(material.back_emits));
    }
    scene.hash_appearance(&mut number);
    number(mesh.patch_count() as u64);
    // Only materials with maps or opacity are hashed here: scenes without them keep their hash.
    for Material { reflectance_map, exitance_map, opacity, .. } in
        scene.materials().iter().filter(|m| !m.is_plain())
    {
        hash.update(format!("{reflectance_map:?} {exitance_map:?} {opacity:?}"));
    }
    // `{:?}` writes all digits of a number.
    hash.update(format!("{:?} {:?}", scene.lights(), scene.sky()));
    hash.finalize().into()
}

/// Returns the hash of everything that determines the view factors of a scene.
pub(crate) fn of_view_factors(
    model: &Model,
    grouping: &Grouping,
    settings: &ViewFactorSettings,
) -> Fingerprint {
    let mut hash = Sha256::new();
    hash.update(PROGRAM);
    hash.update(format!("{settings:?}{:?}", grouping.names()));
    model.scene.triangle_ids().for_each(|t| hash.update((grouping.group_of(t) as u64).to_le_bytes()));
    hash.update(of_scene(model));
    hash.finalize().into()
}

/// Returns a fingerprint in hexadecimal.
#[must_use]
pub fn hex(fingerprint: Fingerprint) -> String {
    fingerprint.iter().map(|byte| format!("{byte:02x}")).collect()
}
