//! Geometry as exported by other software: instances, reflections, stitched strips, odd normals, concave polygons,
//! lines only.

use glam::DVec3;
use serde_json::{Value, json};
use sir_geom::{Built, Scene, SceneError, Warning};

use crate::files::{Gltf, chain, load_from, warnings};

fn obj(text: &str) -> Built {
    load_from("a.obj", &[("a.obj", text.as_bytes())]).unwrap()
}

/// Returns a box from the origin with its fronts outside, as a mesh of 12 triangles.
fn cuboid(size: [f32; 3]) -> Gltf {
    let mut gltf = Gltf::new();
    let corners: [[f32; 3]; 8] =
        std::array::from_fn(|i| std::array::from_fn(|k| if i >> k & 1 == 0 { 0.0 } else { size[k] }));
    let positions = gltf.positions(&corners);
    let faces: [[u16; 4]; 6] =
        [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let indices: Vec<u16> = faces.iter().flat_map(|&[a, b, c, d]| [a, b, c, a, c, d]).collect();
    let indices = gltf.indices(&indices);
    gltf.primitive(json!({"attributes": {"POSITION": positions}, "indices": indices}));
    gltf
}

/// Returns six times the volume that the fronts enclose, positive if they are outside.
fn volume(scene: &Scene) -> f64 {
    let parts = scene.triangle_ids().map(|t| {
        let [a, b, c] = scene.corners(t);
        a.dot(b.cross(c))
    });
    parts.sum::<f64>() / 6.0
}

/// The volume covers everything: where the boxes are, how large, and on which side their fronts are.
#[test]
fn instances_and_mirror_images_of_a_box_have_their_fronts_outside() {
    let mut gltf = cuboid([1.0, 2.0, 3.0]);
    let mut nodes: Vec<Value> = vec![json!({"children": []})];
    let scales = [[1, 1, 1], [-1, 1, 1], [1, -2, 1], [-1, -1, 1], [-1, -1, -1], [3, 1, -1]];
    let mut exact = 0.0;
    for i in 0..600 {
        let scale: [i32; 3] = scales[i % scales.len()];
        exact += 6.0 * f64::from(scale.iter().product::<i32>().abs());
        nodes.push(
            json!({"mesh": 0, "scale": scale, "translation": [10 * i, 0, 0], "rotation": [0.6, 0, 0, 0.8]}),
        );
    }
    nodes[0]["children"] = json!((1..=600).collect::<Vec<_>>());
    for mirror in [json!([1, 1, 1]), json!([1, 1, -1])] {
        nodes[0]["scale"] = mirror;
        gltf.json["nodes"] = json!(nodes);
        let scene = gltf.load().unwrap().scene;
        assert_eq!(scene.triangles().len(), 600 * 12);
        assert_eq!(scene.vertices().len(), 600 * 8);
        assert!((volume(&scene) / exact - 1.0).abs() < 1e-9, "{} of {exact}", volume(&scene));
        assert!((scene.bounding_box().max.x - 5990.0).abs() <= 3.0);
    }
}

#[test]
fn a_mirror_in_a_matrix_and_one_below_another_are_seen() {
    let mut gltf = cuboid([1.0, 1.0, 1.0]);
    // The matrix exchanges x and y.
    let matrix = json!([0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]);
    gltf.json["nodes"] = json!([
        {"mesh": 0, "matrix": matrix, "children": [1]},
        {"mesh": 0, "translation": [3, 0, 0], "scale": [1, -1, 1], "children": [2]},
        {"mesh": 0, "translation": [3, 0, 0], "scale": [1, 1, -2]},
    ]);
    assert!((volume(&gltf.load().unwrap().scene) - 4.0).abs() < 1e-12);
}

/// A mesh of strips or fans is reflected as one of single triangles is.
#[test]
fn mirrored_strips_and_fans_keep_their_fronts() {
    let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
    for (mode, order) in [(5, [0, 1, 2, 3]), (6, [0, 1, 3, 2])] {
        for indexed in [true, false] {
            for (scale, expected) in
                [([1, 1, 1], DVec3::Z), ([-1, 1, 1], DVec3::Z), ([1, 1, -1], DVec3::NEG_Z)]
            {
                let mut gltf = Gltf::new();
                let mut primitive = json!({"mode": mode});
                if indexed {
                    primitive["attributes"] = json!({"POSITION": gltf.positions(&square)});
                    primitive["indices"] = json!(gltf.indices(&order));
                } else {
                    let places = order.map(|i| square[i as usize]);
                    primitive["attributes"] = json!({"POSITION": gltf.positions(&places)});
                }
                gltf.primitive(primitive);
                gltf.json["nodes"][0]["scale"] = json!(scale);
                let scene = gltf.load().unwrap().scene;
                assert!((scene.total_area() - 1.0).abs() < 1e-15);
                assert!(scene.triangle_ids().all(|t| scene.normal(t) == expected), "{mode} {scale:?}");
            }
        }
    }
}

/// Exporters join strips by repeating corners: the triangles in between have no area, which must not cause alarming
/// warnings.
#[test]
fn stitched_strips_keep_their_fronts() {
    let mut gltf = Gltf::new();
    let row = |y: f32| [[0.0, y, 0.0], [1.0, y, 0.0], [0.0, y + 1.0, 0.0], [1.0, y + 1.0, 0.0]];
    let positions = gltf.positions(&[row(0.0), row(5.0)].concat());
    let indices = gltf.indices(&[0, 1, 2, 3, 3, 4, 4, 5, 6, 7]);
    gltf.primitive(json!({"attributes": {"POSITION": positions}, "indices": indices, "mode": 5}));
    let built = gltf.load().unwrap();
    assert_eq!(built.scene.triangles().len(), 4);
    assert!(built.scene.triangle_ids().all(|t| built.scene.normal(t) == DVec3::Z));
    assert!(built.warnings.contains(&Warning::DroppedTriangles { count: 4 }), "{:?}", built.warnings);
}

/// Fronts follow from the order of corners, as the specification states, whatever the shading normals are.
#[test]
fn normals_for_shading_decide_nothing() {
    let mut gltf = Gltf::triangle();
    let down = gltf.positions(&[[0.0, 0.0, -1.0]; 3]);
    gltf.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = json!(down);
    let scene = gltf.load().unwrap().scene;
    assert_eq!(scene.normal(scene.triangle_ids().next().unwrap()), DVec3::Z);
    let scene = obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 -1\ns off\nf 1//1 2//1 3//1\n").scene;
    assert_eq!(scene.normal(scene.triangle_ids().next().unwrap()), DVec3::Z);
}

/// The same triangle three times, once reversed, and once with its corners elsewhere in the file: all are kept, and
/// share their vertices.
#[test]
fn doubled_triangles_are_kept() {
    let scene =
        obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 4 5 6\nf 3 2 1\n").scene;
    assert_eq!((scene.triangles().len(), scene.vertices().len()), (3, 3));
    assert!((scene.total_area() - 1.5).abs() < 1e-15);
}

#[test]
fn a_scene_of_points_and_lines_says_that_they_were_passed_over() {
    let mut gltf = Gltf::new();
    let positions = gltf.positions(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    for mode in [0, 1, 3] {
        gltf.primitive(json!({"attributes": {"POSITION": positions}, "mode": mode}));
    }
    gltf.primitive(json!({"attributes": {}}));
    let text = chain(&gltf.load().unwrap_err());
    assert!(
        text.ends_with(
            "scene.gltf: no scene can be built from this file (3 mesh primitives of points or lines were skipped and \
             1 mesh primitives without positions were skipped): it has no triangles; add meshes of triangles to the scene"
        ),
        "{text}"
    );
    let cloud = "v 0 0 0\nv 1 0 0\nv 0 1 0\np 1 2 3\nl 1 2\n";
    let error = load_from("a.obj", &[("a.obj", cloud.as_bytes())]).unwrap_err();
    assert!(chain(&error).contains("(2 points and lines were skipped): it has no triangles"), "{error}");
    let nothing = load_from("a.obj", &[("a.obj", b"v 0 0 0\n")]).unwrap_err();
    assert!(chain(&nothing).contains("from this file: it has no triangles"), "{nothing}");
    assert!(matches!(nothing, sir_geom::LoadError::Scene { source: SceneError::Empty { dropped: 0 }, .. }));
}

/// Negative indices count back from their line, not from the end of the file.
#[test]
fn corners_count_back_from_their_line() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 0 0 5\nv 1 0 5\nv 0 1 5\nf -3 -2 -1\nf -6 -5 -4\nf 1 -2 -1\n";
    for text in [text.to_owned(), text.replace('\n', "\r\n")] {
        let scene = obj(&text).scene;
        let heights: Vec<[f64; 3]> = scene.triangle_ids().map(|t| scene.corners(t).map(|p| p.z)).collect();
        assert_eq!(heights, [[0.0; 3], [5.0; 3], [0.0; 3], [0.0, 5.0, 5.0]]);
    }
}

/// A U in a plane that is not perpendicular to an axis: a fan from any of its corners except two lies outside it.
#[test]
fn concave_polygons_have_their_area_and_one_front() {
    let (right, up) = (DVec3::new(0.6, 0.0, 0.8), DVec3::new(-0.48, 0.8, 0.36));
    let u = [(0, 0), (3, 0), (3, 2), (2, 2), (2, 1), (1, 1), (1, 2), (0, 2)];
    for first in 0..u.len() {
        let mut u = u;
        u.rotate_left(first);
        let mut text = String::new();
        for (x, y) in u {
            let p = f64::from(x) * right + f64::from(y) * up;
            text += &format!("v {} {} {}\n", p.x, p.y, p.z);
        }
        let built = obj(&(text + "f 1 2 3 4 5 6 7 8\n"));
        let scene = &built.scene;
        assert_eq!(scene.triangles().len(), 6);
        assert!((scene.total_area() - 5.0).abs() < 1e-9, "from corner {first}: {}", scene.total_area());
        assert!(scene.triangle_ids().all(|t| scene.normal(t).dot(right.cross(up)) > 0.999_999));
        assert!(scene.triangles().iter().all(|t| t.face == scene.triangles()[0].face));
        assert_eq!(warnings(&built), ["1 faces have no known material, and are made gray"]);
    }
}

#[test]
fn polygons_that_cross_themselves_are_one_warning() {
    let square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
    let built = obj(&format!("{square}f 1 2 4 3\nf 1 3 2 4\nf 1 2 3 4\n"));
    assert_eq!(built.scene.triangles().len(), 6);
    let warning = Warning::CrossedPolygons { count: 2, place: DVec3::ZERO };
    assert!(built.warnings.contains(&warning), "{:?}", built.warnings);
}

/// Walls with a window, as some exporters write them: the outline goes to the hole and back, so two corners occur
/// twice.
#[test]
fn a_wall_with_a_window_has_no_glass() {
    let text =
        "v 0 0 0\nv 4 0 0\nv 4 3 0\nv 0 3 0\nv 1 1 0\nv 1 2 0\nv 3 2 0\nv 3 1 0\nf 1 2 3 4 1 5 6 7 8 5\n";
    let built = obj(text);
    assert!((built.scene.total_area() - 10.0).abs() < 1e-12, "{}", built.scene.total_area());
    for t in built.scene.triangle_ids() {
        let [a, b, c] = built.scene.corners(t);
        let middle = (a + b + c) / 3.0;
        let in_window = (1.0..3.0).contains(&middle.x) && (1.0..2.0).contains(&middle.y);
        assert!(!in_window && built.scene.normal(t) == DVec3::Z, "{a} {b} {c}");
    }
}

/// The cost of polygons with many corners is limited: a comb of 4,096 corners is triangulated, one of 20,000 is not.
#[test]
fn combs_of_many_teeth_end() {
    for (teeth, right) in [(2047, true), (10_000, false)] {
        let mut text = String::new();
        for i in 0..teeth {
            text += &format!("v {} 0 0\nv {}.5 1 0\n", teeth - i, teeth - i);
        }
        text += &format!("v 0 -1 0\nv {teeth}.5 -1 0\n");
        let corners: Vec<String> = (1..=2 * teeth + 2).map(|i| i.to_string()).collect();
        let built = obj(&format!("{text}f {}\n", corners.join(" ")));
        let crossed = built.warnings.iter().any(|w| matches!(w, Warning::CrossedPolygons { count: 1, .. }));
        assert_eq!(crossed, !right);
        if right {
            let scene = &built.scene;
            assert!(scene.triangle_ids().all(|t| scene.normal(t) == DVec3::Z));
            assert_eq!(scene.triangles().len(), corners.len() - 2);
        }
    }
}
