//! glTF files that claim more data than they have, contain cycles, or refer to files outside their folder.

use std::fs;

use serde_json::{Value, json};

use crate::bounded::{alone, load_hostile, load_within_bounds, refused};
use crate::files::{Gltf, encoded, png, warnings};

/// Asserts that the file of a triangle is rejected after `change` was applied to its JSON.
fn refused_after(change: impl FnOnce(&mut Value), words: &[&str]) -> String {
    let mut gltf = Gltf::triangle();
    change(&mut gltf.json);
    refused(&[("a.glb", &gltf.glb())], words)
}

#[test]
fn counts_that_no_data_backs_are_refused() {
    let _alone = alone();
    let too_many = |json: &mut Value, count: u64| json["accessors"][0]["count"] = json!(count);
    for count in [4, 1 << 33, u64::MAX] {
        refused_after(|j| too_many(j, count), &["accessor 0", &count.to_string()]);
        refused_after(
            |j| {
                too_many(j, count.max(1 << 30));
                j["accessors"][0].as_object_mut().unwrap().remove("bufferView");
            },
            &["accessor 0", "no data"],
        );
        let sparse = json!({"count": count, "indices": {"bufferView": 0, "componentType": 5125, "byteOffset": 0},
            "values": {"bufferView": 0, "byteOffset": 0}});
        refused_after(|j| j["accessors"][0]["sparse"] = sparse, &["accessor 0", "changes"]);
        refused_after(
            |j| j["bufferViews"][0]["byteLength"] = json!(count.saturating_mul(12)),
            &["buffer view 0", "36 bytes"],
        );
        refused_after(
            |j| j["bufferViews"][0]["byteStride"] = json!(count.saturating_mul(9)),
            &["accessor 0", "36 bytes"],
        );
        let place = json!(count.saturating_mul(9));
        refused_after(|j| j["accessors"][0]["byteOffset"] = place.clone(), &["accessor 0", "36 bytes"]);
        refused_after(|j| j["bufferViews"][0]["byteOffset"] = place, &["buffer view 0", "36 bytes"]);
    }
}

/// Zeros that cost the file nothing, used in every possible way.
#[test]
fn accessors_without_data_are_small_all_together() {
    let _alone = alone();
    let with = |count: usize, primitives: usize| {
        let mut gltf = Gltf::triangle();
        for _ in 0..primitives {
            let [positions, colors] = ["VEC3", "VEC4"].map(|kind| {
                let accessors = gltf.json["accessors"].as_array_mut().unwrap();
                accessors.push(json!({"componentType": 5126, "type": kind, "count": count}));
                accessors.len() - 1
            });
            gltf.primitive(json!({"attributes": {"POSITION": positions, "COLOR_0": colors}, "mode": 5}));
        }
        gltf.glb()
    };
    assert_eq!(load_hostile(&[("a.glb", &with(30_000, 1))]).unwrap().scene.triangles().len(), 1);
    for (count, primitives) in [(1 << 16, 1), (1_000, 33)] {
        refused(&[("a.glb", &with(count, primitives))], &["accessor", &count.to_string(), "no data"]);
    }
}

#[test]
fn indices_beyond_their_lists_are_refused() {
    let _alone = alone();
    for (place, words) in [
        ("/nodes/0/mesh", "mesh 77"),
        ("/scenes/0/nodes/0", "node 77"),
        ("/scene", "scene 77"),
        ("/meshes/0/primitives/0/attributes/POSITION", "accessor 77"),
        ("/accessors/0/bufferView", "buffer view 77"),
        ("/bufferViews/0/buffer", "buffer 77"),
    ] {
        refused_after(|json| *json.pointer_mut(place).unwrap() = json!(77), &[words]);
    }
    let mut gltf = Gltf::triangle();
    let indices = gltf.indices(&[0, 1, 3]);
    gltf.json["meshes"][0]["primitives"][0]["indices"] = json!(indices);
    refused(&[("a.glb", &gltf.glb())], &["mesh 0, primitive 0", "index 3"]);
}

#[test]
fn coordinates_that_are_no_numbers_are_left_out() {
    let _alone = alone();
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let mut gltf = Gltf::new();
        let good = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let all = gltf.positions(&[&good[..], &[[bad, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]].concat());
        gltf.primitive(json!({"attributes": {"POSITION": all}}));
        let built = load_hostile(&[("a.glb", &gltf.glb())]).unwrap();
        assert_eq!(built.scene.triangles().len(), 1);
        assert!(warnings(&built)[1].contains("infinite"), "{:?}", built.warnings);
    }
}

#[test]
fn trees_that_are_none_are_refused() {
    let _alone = alone();
    refused_after(|j| j["nodes"][0]["children"] = json!([0]), &["node 0", "its own descendant"]);
    refused_after(
        |j| j["nodes"] = json!([{"children": [1]}, {"children": [2]}, {"children": [1], "mesh": 0}]),
        &["node 1", "its own descendant"],
    );
    // Each level would double what is below it.
    let doubling: Vec<Value> =
        (1..60).map(|i| json!({"children": [i, i]})).chain([json!({"mesh": 0})]).collect();
    refused_after(|j| j["nodes"] = json!(doubling), &["node", "two parents"]);
}

#[test]
fn a_deep_tree_is_no_problem() {
    let _alone = alone();
    let mut gltf = Gltf::triangle();
    let last = json!({"mesh": 0});
    gltf.json["nodes"] = (1..100_000).map(|i| json!({"children": [i]})).chain([last]).collect();
    assert_eq!(load_hostile(&[("a.glb", &gltf.glb())]).unwrap().scene.triangles().len(), 1);
    refused(&[("a.gltf", "[".repeat(100_000).as_bytes())], &["recursion limit"]);
}

#[test]
fn many_instances_of_much_are_refused_early() {
    let _alone = alone();
    // Points add nothing to a scene, but each takes time.
    let mut gltf = Gltf::triangle();
    let points = json!({"attributes": {"POSITION": 0}, "mode": 0});
    gltf.json["meshes"] = json!([{"primitives": vec![points; 20_000]}]);
    gltf.json["nodes"] = json!(vec![json!({"mesh": 0}); 20_000]);
    gltf.json["scenes"] = json!([{"nodes": (0..20_000).collect::<Vec<_>>()}]);
    refused(&[("a.glb", &gltf.glb())], &["mesh primitives"]);
    // So do instances of an empty mesh.
    gltf.json["accessors"][0] = json!({"componentType": 5121, "type": "SCALAR", "count": 1u64 << 40});
    gltf.json["meshes"] = json!([{"primitives": []}]);
    gltf.json["nodes"][0]["extensions"] = json!({"EXT_mesh_gpu_instancing": {"attributes": {"_ID": 0}}});
    refused(&[("a.glb", &gltf.glb())], &["mesh primitives"]);
}

#[test]
fn empty_elements_take_no_memory_without_bound() {
    let _alone = alone();
    let mut gltf = Gltf::triangle();
    gltf.json["nodes"] = json!([vec![json!({"mesh": 0})], vec![json!({}); 200_000]].concat());
    assert_eq!(load_hostile(&[("a.glb", &gltf.glb())]).unwrap().scene.triangles().len(), 1);
}

#[test]
fn a_file_that_many_buffers_name_is_in_memory_once() {
    let _alone = alone();
    let gltf = Gltf::triangle();
    let mut json = gltf.json.clone();
    let mut data = gltf.bytes.clone();
    data.resize(1 << 20, 0);
    json["buffers"] = (0..5000)
        .map(|i| json!({"byteLength": 1 << 20, "uri": format!("{}data.bin", "./".repeat(i % 3))}))
        .collect();
    let text = serde_json::to_vec(&json).unwrap();
    assert!(load_hostile(&[("a.gltf", &text), ("data.bin", &data)]).is_ok());
}

#[test]
fn whatever_is_cut_off_is_noticed() {
    let _alone = alone();
    let gltf = Gltf::triangle();
    let whole = gltf.glb();
    for length in [0, 3, 4, 11, 12, 19, 20, 60, whole.len() - 37, whole.len() - 36, whole.len() - 1] {
        refused(&[("a.glb", &whole[..length])], &["a.glb: not valid glTF 2.0"]);
    }
    let text = gltf.embedded();
    for length in [1, 60, text.len() - 1] {
        refused(&[("a.gltf", &text[..length])], &["not complete, valid JSON"]);
    }
    let embedded = String::from_utf8(text).unwrap();
    let cut = embedded.replace("AAAA\"", "\"");
    refused(&[("a.gltf", cut.as_bytes())], &["buffer 0 should have 36 bytes"]);
    refused(&[("a.gltf", embedded.replace("AAAA\"", "AAA!\"").as_bytes())], &["buffer 0", "base64"]);
    refused(&[("a.gltf", &gltf.text("data.bin")), ("data.bin", &gltf.bytes[..35])], &["buffer 0", "35"]);
    refused(&[("a.gltf", &gltf.text("data.bin"))], &["a.gltf: buffer 0", "data.bin", "add this file"]);
}

#[test]
fn references_out_of_the_folder_are_refused() {
    let _alone = alone();
    let gltf = Gltf::triangle();
    for uri in ["../../etc/passwd", "%2e%2e%2fsecret", "a/%2E%2E/../secret", "..%5csecret"] {
        refused(
            &[("a.gltf", &gltf.text(uri)), ("../secret", &gltf.bytes)],
            &["buffer 0", "leads outside the scene's folder"],
        );
    }
    for uri in ["/etc/passwd", "%2Fetc/passwd", "file:///etc/passwd", "C:\\a", "c:a"] {
        refused(&[("a.gltf", &gltf.text(uri))], &["buffer 0", "it is an absolute path or address"]);
    }
    refused(&[("a.gltf", &gltf.text("http://localhost/a"))], &["buffer 0", "on the web"]);
    for uri in ["%00", "a%1b[2J", &"x".repeat(100_000)] {
        refused(&[("a.gltf", &gltf.text(uri))], &["cannot be the name of a file"]);
    }
    refused(&[("a.gltf", &gltf.text("folder")), ("folder/x", b"")], &["buffer 0", "not a regular file"]);
}

#[test]
fn long_and_strange_names_do_not_flood_the_screen() {
    let _alone = alone();
    let names: Vec<String> = (0..10_000).map(|i| format!("EXT_{i}\u{1b}[2J{}", "x".repeat(200))).collect();
    refused_after(|j| j["extensionsRequired"] = json!(names), &["extensions EXT_0"]);
    refused_after(|j| j["asset"]["version"] = json!("1\n".repeat(1000)), &["version"]);
    refused_after(|j| j["accessors"][0]["count"] = json!("\u{7}x".repeat(10_000)), &["accessors[0].count"]);
    let mut gltf = Gltf::with_material(json!({"name": "\u{1b}x".repeat(999), "emissiveFactor": [-1, 0, 0]}));
    gltf.json["materials"][0]["extras"] = json!({"a": 1});
    refused(&[("a.glb", &gltf.glb())], &["material", "exitance"]);
}

/// Returns a PNG image of two colors, so that a single color cannot replace it.
fn two_colors() -> Vec<u8> {
    encoded(image::RgbImage::from_fn(2, 1, |x, _| image::Rgb([255 * x as u8, 80, 9])))
}

/// Returns a PNG header that claims a size, and the start of its data.
fn huge_png(side: u32) -> Vec<u8> {
    let mut bytes = png([1, 2, 3]);
    bytes[16..20].copy_from_slice(&side.to_be_bytes());
    bytes[20..24].copy_from_slice(&side.to_be_bytes());
    let crc = bytes[12..29].iter().fold(u32::MAX, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |c, _| if c & 1 == 1 { 0xedb8_8320 ^ (c >> 1) } else { c >> 1 })
    });
    bytes[29..33].copy_from_slice(&(!crc).to_be_bytes());
    bytes
}

#[test]
fn a_picture_that_claims_to_be_huge_is_not_made() {
    let _alone = alone();
    for side in [60_000, i32::MAX as u32] {
        let mut gltf =
            Gltf::with_material(json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}));
        let view = gltf.view(&huge_png(side));
        gltf.json["images"] = json!([{"bufferView": view, "mimeType": "image/png"}]);
        gltf.json["textures"] = json!([{"source": 0}]);
        let built = load_hostile(&[("a.glb", &gltf.glb())]).unwrap();
        assert!(warnings(&built)[0].contains("textures cannot be read"), "{:?}", built.warnings);
    }
}

/// The largest memory per byte: a strip has a triangle per index of one byte, and all values that corners can have.
#[test]
fn a_dense_strip_with_all_that_corners_can_have() {
    let _alone = alone();
    let mut gltf = Gltf::with_material(json!({
        "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}},
        "emissiveTexture": {"index": 0, "texCoord": 1},
        "emissiveFactor": [1, 1, 1],
        "alphaMode": "BLEND",
    }));
    let view = gltf.view(&two_colors());
    gltf.json["images"] = json!([{"bufferView": view, "mimeType": "image/png"}]);
    gltf.json["textures"] = json!([{"source": 0}]);
    let turn = |i: f32| [i.cos(), i.sin(), 0.3 * i];
    let positions: Vec<[f32; 3]> = (0..256_u16).map(|i| turn(f32::from(i))).collect();
    let positions = gltf.positions(&positions);
    let bytes: Vec<u8> = (0..=255).collect();
    let places = gltf.accessor(&bytes.repeat(2), 5121, "VEC2", 256);
    let others = gltf.accessor(&bytes.repeat(2), 5121, "VEC2", 256);
    let colors = gltf.accessor(&bytes.repeat(4), 5121, "VEC4", 256);
    for accessor in [places, others, colors] {
        gltf.json["accessors"][accessor]["normalized"] = json!(true);
    }
    const INDICES: usize = 1_050_000;
    let indices: Vec<u8> = (0..INDICES).map(|i| (i % 251) as u8).collect();
    let indices = gltf.accessor(&indices, 5121, "SCALAR", INDICES);
    gltf.json["meshes"][0]["primitives"] = json!([{
        "attributes": {"POSITION": positions, "TEXCOORD_0": places, "TEXCOORD_1": others, "COLOR_0": colors},
        "indices": indices, "mode": 5, "material": 0,
    }]);
    let built = load_hostile(&[("a.glb", &gltf.glb())]).unwrap();
    assert_eq!(built.scene.triangles().len(), INDICES - 2);
    assert!(built.scene.appearance_bytes() > 95 * INDICES, "{}", built.scene.appearance_bytes());
}

#[test]
fn encodings_and_things_that_are_no_files() {
    let _alone = alone();
    let text = Gltf::triangle().embedded();
    let marked = [b"\xef\xbb\xbf", &text[..]].concat();
    assert!(load_hostile(&[("a.gltf", &marked)]).is_ok());
    let lines = String::from_utf8(text).unwrap().replace(',', ",\r\n");
    assert!(
        load_hostile(&[(
            "a.gltf",
            lines.replace("octet-stream;base64,\r\n", "octet-stream;base64,").as_bytes()
        )])
        .is_ok()
    );
    refused(&[("a.gltf", b"")], &["the file is empty"]);
    refused(&[("a.gltf", b"\xff\xfe{\0}\0")], &["UTF-16"]);
    let folder = tempfile::tempdir().unwrap();
    for name in ["a.gltf", "a.glb", "a.obj"] {
        let path = folder.path().join(name);
        fs::create_dir(&path).unwrap();
        assert!(load_within_bounds(&path, 0).is_err());
    }
    assert!(load_within_bounds(&folder.path().join("none.obj"), 0).is_err());
}
