//! Reading any file ends in a scene or an error.

use proptest::prelude::*;
use serde_json::{Value, json};

use crate::files::{Gltf, load_from, png};

/// Returns a file that uses most supported features.
fn rich_gltf() -> Gltf {
    let mut gltf = Gltf::with_material(json!({
        "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.5, 0.5, 1], "baseColorTexture": {"index": 0}},
        "emissiveFactor": [1, 1, 1],
    }));
    let image = gltf.view(&png([1, 2, 3]));
    gltf.json["images"] = json!([{"bufferView": image, "mimeType": "image/png"}]);
    gltf.json["textures"] = json!([{"source": 0}]);
    gltf.json["cameras"] = json!([{"type": "perspective", "perspective": {"yfov": 1.0, "znear": 0.1}}]);
    gltf.json["nodes"] = json!([
        {"mesh": 0, "children": [1, 2], "translation": [1, 2, 3], "rotation": [0, 0, 0, 1], "scale": [1, 1, 1]},
        {"camera": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]},
        {"mesh": 0},
    ]);
    let indices = gltf.indices(&[0, 1, 2, 1]);
    let places = gltf.view(&[1, 0]);
    let values = gltf.view(&[[0, 0, 0, 64], [0; 4], [0; 4]].concat());
    gltf.json["accessors"][0]["sparse"] = json!({
        "count": 1,
        "indices": {"bufferView": places, "componentType": 5123, "byteOffset": 0},
        "values": {"bufferView": values, "byteOffset": 0},
    });
    gltf.json["accessors"][0]["byteOffset"] = json!(0);
    gltf.json["bufferViews"][0]["byteStride"] = json!(12);
    gltf.primitive(json!({"attributes": {"POSITION": 0}, "indices": indices, "mode": 5, "material": 0}));
    gltf
}

const OBJ: &str = "mtllib a.mtl\nv 0 0 0\nv 1 0 0 # c\nv 1 1 0\nv 0 1 0 1 1 1\nvt 0 0\nusemtl a\nf 1/1 2/1 3/1\n\
                   g x\nf -4 -3 -2 -1\nl 1 2 3\nusemtl b\nf 1 2 \\\n 4\n";
const MTL: &str =
    "newmtl a\nKd 0.5 0.5 0.5\nKe 1 1 1\nmap_Kd -s 1 1 1 t.png\nnewmtl b\nKd 0.5\nmap_Ke t.png\n";

/// Reads a file and ignores the result.
fn survive(name: &str, bytes: &[u8]) {
    let image = png([9, 9, 9]);
    let result = load_from(name, &[("a.mtl", MTL.as_bytes()), ("t.png", &image), (name, bytes)]);
    if let Err(error) = result {
        assert!(!crate::files::chain(&error).is_empty());
    }
}

fn mutate(bytes: &[u8], changes: &[(usize, u8)], cut: usize) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    for &(place, value) in changes {
        let place = place % bytes.len();
        bytes[place] = value;
    }
    bytes.truncate(bytes.len() - cut % 8);
    bytes
}

/// Replaces leaf number `n` (modulo the number of leaves) of a JSON tree.
fn replace_leaf(tree: &mut Value, n: usize, value: &Value) {
    fn leaves<'a>(tree: &'a mut Value, found: &mut Vec<&'a mut Value>) {
        match tree {
            Value::Array(list) => list.iter_mut().for_each(|v| leaves(v, found)),
            Value::Object(members) => members.values_mut().for_each(|v| leaves(v, found)),
            leaf => found.push(leaf),
        }
    }
    let mut found = Vec::new();
    leaves(tree, &mut found);
    let n = n % found.len();
    *found[n] = value.clone();
}

fn odd_values() -> impl Strategy<Value = Value> {
    prop_oneof![
        (0u64..12).prop_map(|n| json!(n)),
        prop_oneof![
            Just(255u64),
            Just(1 << 31),
            Just((1 << 32) - 1),
            Just(1 << 32),
            Just(1 << 62),
            Just(u64::MAX)
        ]
        .prop_map(|n| json!(n)),
        prop_oneof![Just(-1.0), Just(1e-40), Just(1e38), Just(1e300), Just(0.5)].prop_map(|x: f64| json!(x)),
        prop_oneof![
            Just(json!(null)),
            Just(json!("x")),
            Just(json!([])),
            Just(json!({})),
            Just(json!([0, 0, 0]))
        ],
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn random_bytes(bytes in proptest::collection::vec(any::<u8>(), 0..300)) {
        for name in ["a.gltf", "a.glb", "a.obj"] {
            survive(name, &bytes);
        }
        let obj = format!("{OBJ}mtllib b.mtl\n");
        let _ = load_from("a.obj", &[("a.obj", obj.as_bytes()), ("b.mtl", &bytes), ("a.mtl", &bytes), ("t.png", &bytes)]);
    }

    #[test]
    fn random_statements(words in proptest::collection::vec(
        prop_oneof!["v|f|l|p|g|usemtl|mtllib|newmtl|Kd|Ke|map_Kd|map_Ke|#|\\\\|\n|\n|\t", "-?[0-9]{1,20}", "[0-9]/[0-9]/-?[0-9]", "[ab]"], 0..80
    )) {
        let text = words.join(" ");
        survive("a.obj", format!("{OBJ}{text}").as_bytes());
        let _ = load_from("a.obj", &[("a.obj", OBJ.as_bytes()), ("a.mtl", format!("newmtl a\n{text}").as_bytes())]);
    }

    #[test]
    fn changed_bytes(changes in proptest::collection::vec((any::<usize>(), any::<u8>()), 1..6), cut: usize) {
        let gltf = rich_gltf();
        survive("a.gltf", &mutate(&gltf.embedded(), &changes, cut));
        survive("a.glb", &mutate(&gltf.glb(), &changes, cut));
        survive("a.obj", &mutate(OBJ.as_bytes(), &changes, cut));
        let mtl = mutate(MTL.as_bytes(), &changes, cut);
        let image = mutate(&png([7, 8, 9]), &changes, cut);
        let _ = load_from("a.obj", &[("a.obj", OBJ.as_bytes()), ("a.mtl", &mtl), ("t.png", &image)]);
    }

    #[test]
    fn changed_json(changes in proptest::collection::vec((any::<usize>(), odd_values()), 1..4)) {
        let mut gltf = rich_gltf();
        for (n, value) in &changes {
            replace_leaf(&mut gltf.json, *n, value);
        }
        survive("a.glb", &gltf.glb());
    }
}

#[test]
fn the_files_that_are_changed_are_whole_at_first() {
    assert_eq!(rich_gltf().load().unwrap().scene.cameras().len(), 1);
    let image = png([9, 9, 9]);
    let files: [(&str, &[u8]); 3] = [("a.obj", OBJ.as_bytes()), ("a.mtl", MTL.as_bytes()), ("t.png", &image)];
    assert_eq!(load_from("a.obj", &files).unwrap().scene.triangles().len(), 4);
}

#[test]
fn many_continued_lines_take_no_square_time() {
    survive("a.obj", "\\\n".repeat(2_000_000).as_bytes());
}
