//! glTF: containers, nodes, triangles, cameras, and invalid files.

use glam::DVec3;
use serde_json::{Value, json};
use sir_geom::{Built, LoadError, Projection, Warning};

use crate::files::{Gltf, chain, corners, load_from, warnings};

const FRONT: [[f64; 3]; 3] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

#[test]
fn containers_agree() {
    let gltf = Gltf::triangle();
    let by = |name: &str, bytes: Vec<u8>| {
        let built = load_from(name, &[(name, &bytes), ("a folder/b.bin", &gltf.bytes)]).unwrap();
        corners(&built.scene)
    };
    assert_eq!(by("scene.GLTF", gltf.embedded()), [FRONT]);
    assert_eq!(by("scene.gltf", gltf.text("a%20folder/b.bin")), [FRONT]);
    assert_eq!(by("scene.glb", gltf.glb()), [FRONT]);
    assert_eq!(by("text inside.glb", gltf.embedded()), [FRONT]);
}

#[test]
fn every_mode_keeps_fronts() {
    let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let cases: [(u32, &[u16], usize); 6] = [
        (4, &[0, 1, 2, 0, 2, 3], 2),
        (4, &[0, 1, 2, 0, 2, 3, 1, 2], 2),
        (5, &[0, 1, 3, 2], 2),
        (5, &[3, 0, 2, 1], 2),
        (6, &[0, 1, 2, 3], 2),
        (6, &[2, 3, 0, 1], 2),
    ];
    for (mode, indices, count) in cases {
        let mut gltf = Gltf::new();
        let (positions, indices) = (gltf.positions(&square), gltf.indices(indices));
        gltf.primitive(json!({"attributes": {"POSITION": positions}, "indices": indices, "mode": mode}));
        let scene = gltf.load().unwrap().scene;
        assert_eq!(scene.triangles().len(), count, "mode {mode}");
        assert!((scene.total_area() - 1.0).abs() < 1e-15);
        assert!(scene.triangle_ids().all(|t| scene.normal(t) == DVec3::Z), "mode {mode}");
    }
}

#[test]
fn indices_have_three_sizes_or_are_absent() {
    for (component, bytes) in
        [(5121, &[2, 0, 1][..]), (5123, &[2, 0, 0, 0, 1, 0]), (5125, &[2, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0])]
    {
        let mut gltf = Gltf::triangle();
        let indices = gltf.accessor(bytes, component, "SCALAR", 3);
        gltf.json["meshes"][0]["primitives"][0]["indices"] = json!(indices);
        assert_eq!(corners(&gltf.load().unwrap().scene), [[FRONT[2], FRONT[0], FRONT[1]]]);
    }
    assert_eq!(corners(&Gltf::triangle().load().unwrap().scene), [FRONT]);
}

#[test]
fn points_and_lines_are_one_warning() {
    let mut gltf = Gltf::triangle();
    for mode in [0, 1, 2, 3] {
        gltf.primitive(json!({"attributes": {"POSITION": 0}, "mode": mode}));
    }
    let built = gltf.load().unwrap();
    assert_eq!(built.scene.triangles().len(), 1);
    assert!(warnings(&built).contains(&"4 mesh primitives of points or lines were skipped".to_owned()));
}

/// The square root of one half, in single precision.
const R: f32 = std::f32::consts::FRAC_1_SQRT_2;

#[test]
fn transforms_are_composed_down_the_tree() {
    let mut gltf = Gltf::triangle();
    // Scaled by two, then rotated by 90° about z, then translated; below it the same mesh translated by one along x.
    gltf.json["nodes"] = json!([
        {"mesh": 0, "children": [1], "translation": [10, 0, 0], "rotation": [0, 0, R, R], "scale": [2, 2, 2]},
        {"mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 1]},
    ]);
    let scene = gltf.load().unwrap().scene;
    let expected = [
        [[10.0, 0.0, 0.0], [10.0, 2.0, 0.0], [8.0, 0.0, 0.0]],
        [[10.0, 2.0, 0.0], [10.0, 4.0, 0.0], [8.0, 2.0, 0.0]],
    ];
    for (found, expected) in corners(&scene).as_flattened().iter().zip(expected.as_flattened()) {
        let off = DVec3::from_array(*found).distance(DVec3::from_array(*expected));
        assert!(off < 1e-14, "{found:?} is {off} off");
    }
    // Single-precision rotations must not scale: the area is exact in double precision.
    assert!((scene.total_area() - 4.0).abs() < 1e-14);
}

#[test]
fn groups_are_named_by_nodes_or_else_by_meshes() {
    let mut gltf = Gltf::triangle();
    gltf.json["nodes"] = json!([{"mesh": 0, "name": "left"}, {"mesh": 0}, {"mesh": 0, "name": "left"}]);
    gltf.json["scenes"] = json!([{"nodes": [0, 1, 2]}]);
    let names = |gltf: &Gltf| -> Vec<String> {
        let scene = gltf.load().unwrap().scene;
        scene.triangles().iter().map(|t| scene.groups()[t.group.index()].clone()).collect()
    };
    assert_eq!(names(&gltf), ["left", "", "left"]);
    gltf.json["meshes"][0]["name"] = json!("tile");
    assert_eq!(names(&gltf), ["left", "tile", "left"]);
}

#[test]
fn mirror_images_keep_their_fronts() {
    for (scale, expected) in [([1, 1, -1], DVec3::NEG_Z), ([-1, 1, 1], DVec3::Z), ([-1, -1, 1], DVec3::Z)] {
        let mut gltf = Gltf::triangle();
        gltf.json["nodes"][0]["scale"] = json!(scale);
        let scene = gltf.load().unwrap().scene;
        let t = scene.triangle_ids().next().unwrap();
        assert_eq!(scene.normal(t), expected, "{scale:?}");
    }
}

#[test]
fn the_scene_is_the_default_the_first_or_all_roots() {
    let mut gltf = Gltf::triangle();
    gltf.json["nodes"] = json!([
        {"mesh": 0},
        {"mesh": 0, "translation": [5, 0, 0], "children": [2]},
        {"mesh": 0, "translation": [1, 0, 0]},
    ]);
    gltf.json["scenes"] = json!([{"nodes": [0]}, {"nodes": [1]}, {}]);
    let first_x = |gltf: &Gltf| -> Vec<f64> {
        corners(&gltf.load().unwrap().scene).iter().map(|triangle| triangle[0][0]).collect()
    };
    gltf.json["scene"] = json!(1);
    assert_eq!(first_x(&gltf), [5.0, 6.0]);
    let members = gltf.json.as_object_mut().unwrap();
    members.remove("scene");
    assert_eq!(first_x(&gltf), [0.0]);
    gltf.json.as_object_mut().unwrap().remove("scenes");
    assert_eq!(first_x(&gltf), [0.0, 5.0, 6.0]);
}

#[test]
fn a_very_deep_tree_is_walked() {
    let mut gltf = Gltf::triangle();
    let depth = 200_000;
    let mut nodes: Vec<Value> = (1..depth).map(|i| json!({"children": [i]})).collect();
    nodes.push(json!({"mesh": 0}));
    gltf.json["nodes"] = json!(nodes);
    assert_eq!(corners(&gltf.load().unwrap().scene), [FRONT]);
}

#[test]
fn sparse_accessors_replace_elements() {
    for base in [true, false] {
        let mut gltf = Gltf::triangle();
        let places = gltf.view(&[1, 0, 2, 0]);
        let values: Vec<u8> =
            [3.0f32, 0.0, 0.0, 0.0, 4.0, 0.0].iter().flat_map(|x| x.to_le_bytes()).collect();
        let values = gltf.view(&values);
        let accessor = &mut gltf.json["accessors"][0];
        accessor["sparse"] = json!({
            "count": 2,
            "indices": {"bufferView": places, "componentType": 5123},
            "values": {"bufferView": values},
        });
        if !base {
            accessor.as_object_mut().unwrap().remove("bufferView");
        }
        let found = corners(&gltf.load().unwrap().scene);
        assert_eq!(found, [[[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [0.0, 4.0, 0.0]]]);
    }
}

#[test]
fn positions_may_be_strided_and_quantized() {
    let mut gltf = Gltf::new();
    let bytes = [0u8, 0, 0, 9, 127, 0, 0, 9, 0, 127, 0, 9, 99, 99];
    let positions = gltf.accessor(&bytes, 5120, "VEC3", 3);
    gltf.json["accessors"][positions]["normalized"] = json!(true);
    gltf.json["bufferViews"][0]["byteStride"] = json!(4);
    gltf.json["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
    gltf.primitive(json!({"attributes": {"POSITION": positions, "_CUSTOM": 0}}));
    assert_eq!(corners(&gltf.load().unwrap().scene), [FRONT]);
}

#[test]
fn cameras_stand_where_their_nodes_are() {
    let mut gltf = Gltf::triangle();
    gltf.json["cameras"] = json!([
        {"type": "perspective", "name": "eye", "perspective": {"yfov": 0.5, "znear": 0.1, "aspectRatio": 2.0}},
        {"type": "orthographic", "orthographic": {"xmag": 3, "ymag": 1.5, "znear": 0, "zfar": 9}},
        {"type": "perspective", "perspective": {"yfov": 0.0, "znear": 0.1}},
        {"type": "perspective", "orthographic": {"xmag": 3, "ymag": 1.5, "znear": 0, "zfar": 9}},
    ]);
    gltf.json["nodes"] = json!([
        {"mesh": 0, "children": [1, 2, 3, 4], "translation": [0, 0, 7], "scale": [3, 3, 3]},
        {"camera": 0, "rotation": [0, R, 0, R], "translation": [1, 0, 0]},
        {"camera": 1, "name": "plan", "rotation": [-R, 0, 0, R]},
        {"camera": 2, "name": "shut"},
        {"camera": 3, "name": "odd"},
    ]);
    let built = gltf.load().unwrap();
    let [eye, plan] = built.scene.cameras() else { panic!("{:?}", built.scene.cameras()) };
    assert_eq!((&*eye.name, eye.eye, eye.aspect), ("eye", DVec3::new(3.0, 0.0, 7.0), Some(2.0)));
    assert!(eye.forward.distance(DVec3::NEG_X) < 1e-15 && eye.up.distance(DVec3::Y) < 1e-15);
    assert_eq!(eye.projection, Projection::Perspective { vertical_fov: 0.5 });
    assert_eq!((&*plan.name, plan.aspect), ("plan", Some(2.0)));
    assert!(plan.forward.distance(DVec3::NEG_Y) < 1e-15 && plan.up.distance(DVec3::NEG_Z) < 1e-15);
    assert_eq!(plan.projection, Projection::Orthographic { height: 3.0 });
    assert!(warnings(&built).contains(
        &"2 cameras have no valid projection or orientation and were ignored: \"shut\", \"odd\"".to_owned()
    ));
}

#[test]
fn what_is_ignored_is_named_once() {
    let mut gltf = Gltf::triangle();
    gltf.json["extensionsUsed"] = json!(["KHR_materials_sheen", "KHR_texture_transform", "EXT_mine"]);
    gltf.json["extensions"] = json!({"EXT_mine": {"lights": [{"type": "point"}]}});
    gltf.json["extras"] = json!(42);
    gltf.json["animations"] = json!([{"channels": [{"target": {"path": "scale"}}]}]);
    gltf.json["skins"] = json!([{}]);
    gltf.json["nodes"][0]["skin"] = json!(0);
    for _ in 0..2 {
        gltf.primitive(
            json!({"attributes": {"POSITION": 0, "COLOR_0": 0, "COLOR_1": 0}, "targets": [{"POSITION": 0}]}),
        );
    }
    assert_eq!(
        warnings(&gltf.load().unwrap()),
        [
            "1 glTF extensions describe gloss, which diffuse surfaces do not have, and were ignored: KHR_materials_sheen",
            "1 glTF extensions are unknown and were ignored: if they add or remove surfaces or light, the scene is wrong: EXT_mine",
            "1 animations are not played: the scene is read in its state at rest",
            "1 skinned meshes are read in the pose of their nodes",
            "1 mesh primitives have no material, and are made gray",
            "2 mesh primitives have morph targets, which were ignored",
            "2 mesh primitives have more than one set of colors; only the first is used",
        ]
    );
}

#[test]
fn unknown_required_extensions_are_refused_by_name() {
    let mut gltf = Gltf::triangle();
    gltf.json["extensionsRequired"] = json!(["KHR_mesh_quantization", "EXT_meshopt_compression"]);
    let error = gltf.load().unwrap_err();
    assert!(
        matches!(&error, LoadError::RequiredExtensions { names, .. } if names == &["EXT_meshopt_compression"])
    );
}

#[test]
fn coordinates_that_are_no_numbers_drop_their_triangles() {
    let mut gltf = Gltf::triangle();
    let positions = gltf.positions(&[[0.0, 0.0, f32::NAN], [1.0, 0.0, 0.0], [f32::INFINITY, 1.0, 0.0]]);
    gltf.primitive(json!({"attributes": {"POSITION": positions}}));
    let built = gltf.load().unwrap();
    assert_eq!(built.scene.triangles().len(), 1);
    assert!(built.warnings.contains(&Warning::DroppedTriangles { count: 1 }));
}

/// Reads a triangle in which the value at a JSON pointer was replaced.
fn with(pointer: &str, value: Value) -> Result<Built, LoadError> {
    let mut gltf = Gltf::triangle();
    let indices = gltf.indices(&[0, 1, 2]);
    gltf.json["meshes"][0]["primitives"][0]["indices"] = json!(indices);
    gltf.json["meshes"][0]["primitives"][0]["mode"] = json!(4);
    gltf.json["accessors"][0]["byteOffset"] = json!(0);
    let (parent, member) = pointer.rsplit_once('/').unwrap();
    gltf.json.pointer_mut(parent).unwrap()[member] = value;
    gltf.load()
}

#[test]
fn faults_are_errors_that_say_where() {
    let cases = [
        ("/scene", json!(7), "scene 7 does not exist"),
        ("/scenes/0/nodes", json!([3]), "node 3 does not exist"),
        ("/scenes/0/nodes", json!([0, 0]), "node 0 has two parents"),
        ("/nodes/0/children", json!([0]), "node 0 has two parents or is its own descendant"),
        ("/nodes/0/mesh", json!(1), "mesh 1 does not exist"),
        ("/nodes/0/camera", json!(0), "camera 0 does not exist"),
        ("/meshes/0/primitives/0/material", json!(0), "material 0 does not exist"),
        ("/meshes/0/primitives/0/indices", json!(9), "mesh 0, primitive 0: accessor 9 does not exist"),
        ("/meshes/0/primitives/0/indices", json!(0), "accessor 0 has a type that is not allowed here"),
        ("/meshes/0/primitives/0/attributes", json!({"POSITION": 9}), "accessor 9 does not exist"),
        ("/meshes/0/primitives/0/attributes", json!({"POSITION": 1}), "accessor 1 has a type"),
        ("/meshes/0/primitives/0/mode", json!(7), "unknown mode"),
        ("/accessors/0/bufferView", json!(5), "buffer view 5 does not exist"),
        (
            "/accessors/0/count",
            json!(4),
            "accessor 0 has 4 elements, more than the 36 bytes of buffer view 0",
        ),
        ("/accessors/0/count", json!(u64::MAX), "more than the 36 bytes"),
        ("/accessors/0/byteOffset", json!(1), "more than the 36 bytes"),
        ("/accessors/0/byteOffset", json!(u64::MAX), "more than the 36 bytes"),
        ("/accessors/0/bufferView", Value::Null, ""),
        ("/accessors/0/componentType", json!(5125), "accessor 0 has a type"),
        ("/accessors/0/componentType", json!(1), "accessor 0 has a type"),
        ("/accessors/1/componentType", json!(5125), "accessor 1 has 3 elements, more than the 6 bytes"),
        ("/accessors/0/type", json!("VEC9"), "accessor 0 has a type"),
        ("/bufferViews/0/buffer", json!(3), "beyond buffer 3, which has 0 bytes"),
        ("/bufferViews/0/byteLength", json!(1_000), "reaches beyond buffer 0, which has 42 bytes"),
        ("/bufferViews/0/byteOffset", json!(u64::MAX), "reaches beyond buffer 0"),
        ("/bufferViews/0/byteStride", json!(1u64 << 40), "more than the 36 bytes"),
    ];
    for (pointer, value, expected) in cases {
        let error = with(pointer, value.clone()).expect_err(&format!("{pointer} = {value}"));
        let text = chain(&error);
        assert!(text.contains(expected) && text.contains("scene.gltf"), "{pointer} = {value}: {text}");
    }
    // A stride of zero, and an index beyond the vertices.
    assert_eq!(corners(&with("/bufferViews/0/byteStride", json!(0)).unwrap().scene), [FRONT]);
    let error = with("/accessors/0/count", json!(2)).unwrap_err();
    assert!(error.to_string().contains("mesh 0, primitive 0: index 2 is beyond its 2 vertices"), "{error}");
}

#[test]
fn buffers_are_whole_and_beside_the_scene() {
    let gltf = Gltf::triangle();
    let cut =
        load_from("s.gltf", &[("s.gltf", &gltf.text("b.bin")), ("b.bin", &gltf.bytes[..35])]).unwrap_err();
    assert!(cut.to_string().contains("buffer 0 should have 36 bytes, but there are 35"), "{cut}");
    let absent = load_from("s.gltf", &[("s.gltf", &gltf.text("b.bin"))]).unwrap_err();
    assert!(matches!(&absent, LoadError::Missing { path, .. } if path.ends_with("b.bin")), "{absent}");
    let mut gone = gltf.json.clone();
    gone["buffers"] = json!([{"byteLength": 36}]);
    let gone = load_from("s.gltf", &[("s.gltf", &serde_json::to_vec(&gone).unwrap())]).unwrap_err();
    assert!(gone.to_string().contains("buffer 0 has no data"), "{gone}");
    for uri in ["../b.bin", "/b.bin", "file:///b.bin", "https://example.org/b.bin", "data:nothing"] {
        let error =
            load_from("s/s.gltf", &[("s/s.gltf", &gltf.text(uri)), ("b.bin", &gltf.bytes)]).unwrap_err();
        assert!(
            matches!(&error, LoadError::Reference { element, .. } if element == "buffer 0"),
            "{uri}: {error}"
        );
    }
    let glb = gltf.glb();
    for end in 0..glb.len() {
        assert!(load_from("s.glb", &[("s.glb", &glb[..end])]).is_err(), "{end} bytes");
    }
}

#[test]
fn what_costs_a_file_nothing_has_a_limit() {
    let mut gltf = Gltf::triangle();
    gltf.json["accessors"][0].as_object_mut().unwrap().remove("bufferView");
    gltf.json["accessors"][0]["count"] = json!(3_000_000_000u64);
    let error = gltf.load().unwrap_err();
    assert!(error.to_string().contains("accessor 0 has 3000000000 elements, but no data"), "{error}");
}
