//! glTF: extensions that are read, and what is said about the others.

use std::fs;
use std::path::Path;

use glam::DVec3;
use serde_json::{Value, json};
use sir_geom::{LoadError, Scene};

use crate::files::{Gltf, corners, warnings};

/// Half of the square root of two, as in the quaternion of a quarter turn.
const R: f32 = std::f32::consts::FRAC_1_SQRT_2;

fn bytes(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|x| x.to_le_bytes()).collect()
}

/// Returns a triangle whose node has instances with these attributes.
fn instanced(attributes: impl FnOnce(&mut Gltf) -> Value) -> Gltf {
    let mut gltf = Gltf::triangle();
    let attributes = attributes(&mut gltf);
    gltf.json["extensionsUsed"] = json!(["EXT_mesh_gpu_instancing"]);
    gltf.json["extensionsRequired"] = json!(["EXT_mesh_gpu_instancing"]);
    gltf.json["nodes"][0]["extensions"] = json!({"EXT_mesh_gpu_instancing": {"attributes": attributes}});
    gltf
}

/// Returns the first corners of all triangles, rounded.
fn first_corners(scene: &Scene) -> Vec<[f64; 3]> {
    corners(scene).iter().map(|triangle| triangle[0].map(|x| (x * 1e6).round() / 1e6 + 0.0)).collect()
}

#[test]
fn instances_replace_the_mesh_of_their_node() {
    let mut gltf = instanced(|gltf| {
        let places = gltf.positions(&[[1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 3.0]]);
        json!({"TRANSLATION": places, "_ID": 0})
    });
    // The transform of the node comes after those of the instances.
    gltf.json["nodes"][0]["scale"] = json!([2, 2, 2]);
    gltf.json["nodes"][0]["translation"] = json!([10, 0, 0]);
    let built = gltf.load().unwrap();
    assert_eq!(first_corners(&built.scene), [[12.0, 0.0, 0.0], [10.0, 4.0, 0.0], [10.0, 0.0, 6.0]]);
    assert!((built.scene.total_area() - 6.0).abs() < 1e-12);
    assert_eq!(warnings(&built), ["3 mesh primitives have no material, and are made gray"]);
    assert_eq!(built.scene.vertices().len(), 9);
}

#[test]
fn instances_are_scaled_then_turned_then_moved() {
    for component in [5126, 5120, 5122] {
        let gltf = instanced(|gltf| {
            let (turn, count) = match component {
                5120 => ([0i8, 0, 90, 90].map(|x| x as u8).to_vec(), 1),
                5122 => ([0i16, 0, 23170, 23170].iter().flat_map(|x| x.to_le_bytes()).collect(), 1),
                _ => (bytes(&[0.0, 0.0, R, R]), 1),
            };
            let rotation = gltf.accessor(&turn, component, "VEC4", count);
            gltf.json["accessors"][rotation]["normalized"] = json!(component != 5126);
            let scale = gltf.positions(&[[2.0, 3.0, -1.0]]);
            json!({"TRANSLATION": gltf.positions(&[[5.0, 0.0, 0.0]]), "ROTATION": rotation, "SCALE": scale})
        });
        let scene = gltf.load().unwrap().scene;
        let found = corners(&scene)[0].map(DVec3::from_array);
        // The scale is a reflection, so two corners are exchanged.
        let expected = [[5.0, 0.0, 0.0], [2.0, 0.0, 0.0], [5.0, 2.0, 0.0]].map(DVec3::from_array);
        assert!(found.iter().zip(expected).all(|(a, b)| a.distance(b) < 1e-6), "{component}: {found:?}");
        assert!(scene.normal(scene.triangle_ids().next().unwrap()).z < -0.999, "{component}");
    }
}

#[test]
fn instances_are_counted_by_any_attribute() {
    let gltf = instanced(|gltf| json!({"_ID": gltf.accessor(&[1, 2], 5121, "SCALAR", 2)}));
    assert_eq!(gltf.load().unwrap().scene.triangles().len(), 2);
    let mut gltf = instanced(|_| json!({}));
    assert_eq!(gltf.load().unwrap().scene.triangles().len(), 1);
    // A node without a mesh has no instances; nodes below it do not inherit them.
    gltf.json["nodes"] =
        json!([{"children": [1], "extensions": gltf.json["nodes"][0]["extensions"]}, {"mesh": 0}]);
    assert_eq!(gltf.load().unwrap().scene.triangles().len(), 1);
    let mut colored = instanced(|gltf| json!({"TRANSLATION": 0, "_COLOR_0": gltf.positions(&[[1.0; 3]; 3])}));
    let built = colored.load().unwrap();
    let colors = "1 nodes have instances with colors, which were ignored".to_owned();
    assert!(warnings(&built).contains(&colors), "{:?}", built.warnings);
    colored.json["accessors"][0]["count"] = json!(0);
    colored.json["accessors"][1]["count"] = json!(0);
    assert!(colored.load().unwrap_err().to_string().contains("no scene can be built"));
}

#[test]
fn invalid_instances_are_errors_that_name_their_node() {
    for (attributes, expected) in [
        (json!({"TRANSLATION": 9}), "node 0, instances: accessor 9 does not exist"),
        (json!({"ROTATION": 0}), "node 0, instances: accessor 0 has a type that is not allowed"),
        (json!({"TRANSLATION": 0, "SCALE": 1}), "node 0, instances: attributes have 2 and 3 elements"),
        (json!({"TRANSLATION": "x"}), "nodes[0]: TRANSLATION of its instances is not an accessor"),
    ] {
        let gltf = instanced(|gltf| {
            gltf.positions(&[[0.0; 3]; 2]);
            attributes
        });
        let error = gltf.load().unwrap_err().to_string();
        assert!(error.contains(expected), "{error}");
    }
    // Zeros that cost the file nothing.
    let mut gltf = instanced(|gltf| json!({"_ID": gltf.accessor(&[1], 5121, "SCALAR", 1)}));
    gltf.json["accessors"][1]["count"] = json!(u64::MAX);
    let error = gltf.load().unwrap_err();
    assert!(matches!(error, LoadError::TooLarge { what: "mesh primitives", .. }), "{error}");
}

#[test]
fn hidden_nodes_hide_what_is_below_them_except_cameras() {
    let mut gltf = Gltf::triangle();
    let at = |x: i32| json!([x, 0, 0]);
    let light = json!({"KHR_lights_punctual": {"light": 0}});
    gltf.json["extensionsRequired"] = json!(["KHR_node_visibility", "KHR_lights_punctual"]);
    gltf.json["extensions"] = json!({"KHR_lights_punctual": {"lights": [{"type": "point"}]}});
    gltf.json["cameras"] = json!([{"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.1}}]);
    let visible = |is: bool| json!({"KHR_node_visibility": {"visible": is}});
    gltf.json["scenes"] = json!([{"nodes": [0, 4, 6]}]);
    gltf.json["nodes"] = json!([
        {"name": "night only", "mesh": 0, "children": [1, 2], "extensions": visible(false)},
        {"mesh": 0, "camera": 0, "children": [3], "extensions": visible(true)},
        {"extensions": light},
        {"mesh": 0, "extensions": visible(false)},
        {"mesh": 0, "translation": at(4), "children": [5], "extensions": {"KHR_node_visibility": {}}},
        {"mesh": 0, "translation": at(1), "extensions": visible(true)},
        {"extensions": light, "translation": at(6)},
    ]);
    let built = gltf.load().unwrap();
    assert_eq!(first_corners(&built.scene), [[4.0, 0.0, 0.0], [5.0, 0.0, 0.0]]);
    assert_eq!((built.scene.lights().len(), built.scene.cameras().len()), (1, 1));
    assert_eq!(
        warnings(&built)[0],
        "1 nodes are hidden; they and the meshes and lights below them were skipped: \"night only\""
    );
    gltf.json["scenes"] = json!([{"nodes": [0]}]);
    let error = gltf.load().unwrap_err().to_string();
    assert!(
        error.contains("(1 nodes are hidden; they and the meshes and lights below them were skipped)"),
        "{error}"
    );
    gltf.json["nodes"][0]["extensions"] = json!({"KHR_node_visibility": {"visible": "no"}});
    let error = gltf.load().unwrap_err().to_string();
    assert!(error.contains("nodes[0]: `visible` is neither true nor false"), "{error}");
}

/// Compressed geometry without a plain copy is named as what it is, not as missing data.
#[test]
fn compressed_geometry_without_a_copy_is_named() {
    let mut draco = Gltf::triangle();
    draco.json["extensionsUsed"] = json!(["KHR_draco_mesh_compression"]);
    draco.json["meshes"][0]["primitives"][0]["extensions"] =
        json!({"KHR_draco_mesh_compression": {"bufferView": 0, "attributes": {"POSITION": 0}}});
    let built = draco.load().unwrap();
    assert_eq!(warnings(&built), ["1 mesh primitives have no material, and are made gray"]);
    draco.json["accessors"][0].as_object_mut().unwrap().remove("bufferView");
    let error = draco.load().unwrap_err().to_string();
    assert!(error.contains("accessor 0 has no data that is not compressed with KHR_draco"), "{error}");
    let mut meshopt = Gltf::triangle();
    meshopt.json["bufferViews"][0]["buffer"] = json!(1);
    meshopt.json["bufferViews"][0]["extensions"] =
        json!({"EXT_meshopt_compression": {"buffer": 0, "byteLength": 9, "byteStride": 12, "count": 3}});
    let mut text: Value = serde_json::from_slice(&meshopt.embedded()).unwrap();
    let fallback = json!({"byteLength": 36, "extensions": {"EXT_meshopt_compression": {"fallback": true}}});
    text["buffers"].as_array_mut().unwrap().push(fallback);
    let file = serde_json::to_vec(&text).unwrap();
    let error = crate::files::load_from("a.gltf", &[("a.gltf", &file)]).unwrap_err().to_string();
    assert!(error.contains("buffer 1 has no data: its views are compressed with EXT_meshopt"), "{error}");
}

/// Extensions that a file uses without listing them are found.
#[test]
fn extensions_are_noticed_wherever_they_are() {
    let mut gltf = Gltf::triangle();
    gltf.json["nodes"][0]["extensions"] = json!({"EXT_lights_area": {"light": 0}});
    let built = gltf.load().unwrap();
    let expected = "1 glTF extensions describe light sources and are not supported: their light is missing; add it \
                    with `Light`: EXT_lights_area";
    assert_eq!(warnings(&built)[0], expected);
}

/// The table of the documentation: what it says about each extension is what the reader does.
#[test]
fn the_documentation_knows_what_becomes_of_extensions() {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/formats.md");
    let docs = fs::read_to_string(docs).unwrap();
    let rows = [
        ("read", true, None),
        ("nothing is missing", true, None),
        ("alternatives", true, Some("offer alternatives")),
        ("encodings", false, None),
        ("gloss", true, Some("describe gloss")),
        ("transmission", false, Some("describe transmission")),
        ("colors", false, Some("change colors")),
        ("geometry", false, Some("change geometry")),
        ("light", false, Some("their light is missing")),
        ("any other", false, Some("are unknown")),
    ];
    for (row, loads_if_required, said) in rows {
        let line = docs
            .lines()
            .find(|line| line.starts_with(&format!("| **{row}** |")))
            .unwrap_or_else(|| panic!("{row}"));
        let cell = line.rsplit('|').nth(1).unwrap();
        let names: Vec<&str> = if row == "any other" {
            vec!["ACME_surprise"]
        } else {
            cell.split('`').skip(1).step_by(2).collect()
        };
        assert!(!names.is_empty(), "{row}");
        for name in names {
            let mut gltf = Gltf::triangle();
            gltf.json["extensionsUsed"] = json!([name]);
            let all = warnings(&gltf.load().unwrap());
            match said {
                None => assert_eq!(all.len(), 1, "{name}: {all:?}"),
                Some(said) => assert!(all[0].contains(said) && all[0].ends_with(name), "{name}: {all:?}"),
            }
            gltf.json["extensionsRequired"] = json!([name]);
            match gltf.load() {
                Ok(_) => assert!(loads_if_required, "{name}"),
                Err(LoadError::RequiredExtensions { names, .. }) => {
                    assert!(!loads_if_required && names == [name], "{names:?}");
                }
                Err(other) => panic!("{name}: {other}"),
            }
        }
    }
}
