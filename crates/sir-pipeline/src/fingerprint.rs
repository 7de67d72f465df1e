//! Hashes that identify scenes, pipelines and programs.

use sha2::{Digest, Sha256};
use sir_geom::{Scene, Triangle};
use sir_radiosity::{Grouping, Model, ViewFactorSettings};

use crate::plan::{Action, Pipeline};
use crate::prepare::prepared::Prepared;

/// Version of this program: that of the package and, if it was built from a checkout, the hash of its sources.
pub const PROGRAM_VERSION: &str = env!("SIR_VERSION");

/// Name and version of this program. Programs that may give different results differ in it.
pub const PROGRAM: &str = concat!("sir ", env!("SIR_VERSION"));

/// SHA-256 hash.
pub type Fingerprint = [u8; 32];

/// Returns the hash of everything that determines the result of a run: equal hashes mean equal output files.
pub(crate) fn of_run(pipeline: &Pipeline, seed: u64, prepared: &Prepared) -> Fingerprint {
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
    // `{:?}` writes all digits of a number.
    hash.update(format!("{:?}", prepared.up));
    hash.update(of_model(&prepared.model));
    hash.finalize().into()
}

/// Returns the hash of a scene and its patches: of all that reaches an output file, which includes names and cameras.
pub(crate) fn of_model(model: &Model) -> Fingerprint {
    let mut hash = Sha256::new();
    hash.update(of_scene(&model.scene));
    hash.update((model.mesh.patch_count() as u64).to_le_bytes());
    hash.finalize().into()
}

/// Returns the hash of a scene: of its geometry, textures, materials, lights, names and cameras.
pub fn of_scene(scene: &Scene) -> Fingerprint {
    let mut hash = Sha256::new();
    let mut number = |n: u64| hash.update(n.to_le_bytes());
    number(scene.vertices().len() as u64);
    for vertex in scene.vertices() {
        vertex.to_array().iter().for_each(|x| number(x.to_bits()));
    }
    number(scene.triangles().len() as u64);
    for triangle in scene.triangles() {
        triangle.vertices.iter().for_each(|v| number(v.0.into()));
        let Triangle { material, face, group, source, .. } = *triangle;
        [material.0, face.0, group.0, source].iter().for_each(|&n| number(n.into()));
    }
    scene.hash_appearance(&mut number);
    // `{:?}` writes all fields, and all digits of a number.
    hash.update(format!("{:?} {:?} {:?}", scene.materials(), scene.groups(), scene.cameras()));
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
    hash.update(of_model(model));
    hash.finalize().into()
}

/// Returns a fingerprint in hexadecimal.
#[must_use]
pub fn hex(fingerprint: Fingerprint) -> String {
    fingerprint.iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::prepare::prepared::prepare;
    use crate::progress::NoProgress;

    /// A lit floor and a camera in glTF with everything inline.
    const SCENE: &str = r#"{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
        "nodes": [{"mesh": 0, "name": "floor"}, {"camera": 0, "translation": [0, 1, 5]}],
        "cameras": [{"type": "perspective", "name": "front", "perspective": {"yfov": 0.7, "znear": 0.1}}],
        "materials": [{"name": "glow", "emissiveFactor": [1, 1, 1]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
            "min": [0, 0, 0], "max": [1, 0, 1]}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "buffers": [{"byteLength": 36,
            "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAAAAAAAAAAAAAIA/AACAPwAAAAAAAAAA"}]}"#;
    const PIPELINE: &str =
        r#"(stages: [Load(path: "x.gltf"), FirstShot(lines: 1), Save([Image(path: "a.png")])])"#;

    fn of(scene: &str, text: &str, seed: u64) -> Fingerprint {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("x.gltf"), scene).unwrap();
        let pipeline = Pipeline::parse(text, &folder.path().join("x.ron")).unwrap();
        of_run(&pipeline, seed, &prepare(&pipeline, &NoProgress).unwrap())
    }

    #[test]
    fn all_that_reaches_an_output_file_counts() {
        let first = of(SCENE, PIPELINE, 1);
        assert_eq!(of(SCENE, PIPELINE, 1), first);
        assert_eq!(of(&SCENE.replace("\n", " "), PIPELINE, 1), first, "only the content counts");
        assert_ne!(of(SCENE, PIPELINE, 2), first);
        let camera =
            PIPELINE.replace("\"a.png\"", "\"a.png\", camera: Camera(eye: (0, 1, 4), target: (0, 0, 0))");
        assert_ne!(of(SCENE, &camera, 1), first);
        // Of the camera: its place, its angle, its name; of the material: its name, which result.glb has, and its light.
        for (from, to) in [
            ("[0, 1, 5]", "[0, 1, 6]"),
            ("0.7", "0.8"),
            ("front", "back"),
            ("glow", "gleam"),
            ("[1, 1, 1]", "[1, 1, 2]"),
            ("\"znear\"", "\"aspectRatio\": 2, \"znear\""),
        ] {
            assert!(SCENE.contains(from));
            assert_ne!(of(&SCENE.replacen(from, to, 1), PIPELINE, 1), first, "{from}");
        }
    }
}
