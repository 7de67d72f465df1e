//! Tests `sir info` with small scenes whose properties are known.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use std::path::{Path, PathBuf};

use sir_pipeline::ErrorKind;
use sir_pipeline::info::{Info, inspect};
use sir_pipeline::plan::Pipeline;

/// Returns the corners of a box from the origin, numbered by bits: x, y, z.
fn corners(size: [f64; 3]) -> Vec<[f64; 3]> {
    let at = |i: usize, axis: usize| if i >> axis & 1 == 1 { size[axis] } else { 0.0 };
    (0..8).map(|i| [at(i, 0), at(i, 1), at(i, 2)]).collect()
}

/// Walls of a box, counterclockwise as seen from inside: floor, ceiling, and four walls.
const WALLS: [[usize; 4]; 6] =
    [[0, 4, 5, 1], [2, 3, 7, 6], [0, 1, 3, 2], [4, 6, 7, 5], [0, 2, 6, 4], [1, 5, 7, 3]];

fn turned(wall: [usize; 4]) -> [usize; 4] {
    let [a, b, c, d] = wall;
    // Split along the same diagonal as the original.
    [a, d, c, b]
}

/// Writes an OBJ file of quadrilaterals, the first of which emits if `lit`.
fn obj(folder: &Path, corners: &[[f64; 3]], walls: &[[usize; 4]], lit: bool) -> PathBuf {
    let mut text = String::from("mtllib room.mtl\n");
    corners.iter().for_each(|[x, y, z]| text += &format!("v {x} {y} {z}\n"));
    for (number, wall) in walls.iter().enumerate() {
        let material = if lit && number == 0 { "lamp" } else { "gray" };
        let [a, b, c, d] = wall.map(|corner| corner + 1);
        text += &format!("o wall{number}\nusemtl {material}\nf {a} {b} {c} {d}\n");
    }
    let materials = "newmtl gray\nKd .5 .4 .3\nnewmtl lamp\nKd 0 0 0\nKe 2 1 0\n";
    std::fs::write(folder.join("room.mtl"), materials).unwrap();
    std::fs::write(folder.join("room.obj"), text).unwrap();
    folder.join("room.obj")
}

/// Writes a glTF file of one-sided quadrilaterals.
fn gltf(folder: &Path, corners: &[[f64; 3]], walls: &[[usize; 4]]) -> PathBuf {
    let mut bytes: Vec<u8> = Vec::new();
    corners.iter().flatten().for_each(|x| bytes.extend((*x as f32).to_le_bytes()));
    let points = bytes.len();
    let indices = walls.iter().flat_map(|&[a, b, c, d]| [a, b, c, a, c, d]);
    indices.for_each(|i| bytes.extend((i as u32).to_le_bytes()));
    std::fs::write(folder.join("room.bin"), &bytes).unwrap();
    let text = format!(
        r#"{{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0]}}], "nodes": [{{"mesh": 0, "name": "walls"}}],
        "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}, "indices": 1}}]}}],
        "accessors": [
            {{"bufferView": 0, "componentType": 5126, "count": {}, "type": "VEC3", "min": [0, 0, 0], "max": [9, 9, 9]}},
            {{"bufferView": 1, "componentType": 5125, "count": {}, "type": "SCALAR"}}
        ],
        "bufferViews": [
            {{"buffer": 0, "byteLength": {points}}},
            {{"buffer": 0, "byteOffset": {points}, "byteLength": {}}}
        ],
        "buffers": [{{"byteLength": {}, "uri": "room.bin"}}]}}"#,
        corners.len(),
        6 * walls.len(),
        bytes.len() - points,
        bytes.len()
    );
    std::fs::write(folder.join("room.gltf"), text).unwrap();
    folder.join("room.gltf")
}

/// Inspects a room of 4 m × 3 m × 5 m, modified by `change`.
fn room(lit: bool, change: impl FnOnce(&mut Vec<[f64; 3]>, &mut Vec<[usize; 4]>)) -> Info {
    let folder = tempfile::tempdir().unwrap();
    let (mut corners, mut walls) = (corners([4.0, 3.0, 5.0]), WALLS.to_vec());
    change(&mut corners, &mut walls);
    inspect(&obj(folder.path(), &corners, &walls, lit)).unwrap()
}

/// Inspects the same room with one-sided walls.
fn one_sided(change: impl FnOnce(&mut Vec<[usize; 4]>)) -> Info {
    let folder = tempfile::tempdir().unwrap();
    let mut walls = WALLS.to_vec();
    change(&mut walls);
    inspect(&gltf(folder.path(), &corners([4.0, 3.0, 5.0]), &walls)).unwrap()
}

/// Returns all suggested settings in one line. Each must be valid in a pipeline.
fn settings(info: &Info) -> String {
    let folder = tempfile::tempdir().unwrap();
    obj(folder.path(), &corners([1.0; 3]), &WALLS, true);
    let path = folder.path().join("x.ron");
    for setting in &info.settings {
        let set = setting.set.replace(&info.scene, "room.obj");
        let load = if set.starts_with("Load") { "" } else { "Load(path: \"room.obj\")," };
        let (units, set) = if set.starts_with("units") {
            (format!("{set},"), String::new())
        } else {
            (String::new(), format!("{set},"))
        };
        let text = format!("Pipeline({units} stages: [{load} {set} FirstShot(lines: 1000)])");
        Pipeline::parse(&text, &path).unwrap_or_else(|problems| panic!("{problems}"));
    }
    let settings: Vec<&str> = info.settings.iter().map(|setting| setting.set.as_str()).collect();
    settings.join(" ")
}

fn close(found: f64, expected: f64) {
    // Five standard errors of a share of 100,000 lines.
    assert!((found - expected).abs() < 0.008, "{found}, but expected {expected}");
}

#[test]
fn a_closed_room_is_counted_and_found_closed() {
    let info = room(true, |_, _| {});
    assert_eq!((info.triangles, info.vertices, info.polygons, info.dropped_triangles), (12, 8, 6, 0));
    assert_eq!(info.groups.len(), 6);
    assert!((info.area - 94.0).abs() < 1e-9);
    assert!((info.largest_triangle - 10.0 / 94.0).abs() < 1e-9);
    let names: Vec<_> = info.materials.iter().map(|m| (m.name.as_str(), m.triangles, m.two_sided)).collect();
    assert_eq!(names, [("gray", 10, true), ("lamp", 2, true)]);
    assert_eq!(info.materials[0].reflectance, [0.5, 0.4, 0.3]);
    let pi = std::f64::consts::PI;
    let power = [40.0 * pi, 20.0 * pi, 0.0];
    let off = |found: [f64; 3]| (0..3).map(|i| (found[i] - power[i]).abs()).fold(0.0, f64::max);
    assert!(off(info.sources[0].power) < 1e-9 && off(info.materials[1].power) < 1e-9);
    assert_eq!(info.sources[0].what, "2 triangle sides");

    let lines = info.lines;
    assert_eq!((lines.global.met, lines.global.odd, lines.global.mixed), (100_000, 0.0, 0.0));
    assert_eq!((lines.from_fronts.front, lines.from_backs.escaped), (1.0, 1.0));
    assert_eq!(lines.from_emitters.map(|fates| fates.front), Some(1.0));
    assert_eq!(info.findings, [""; 0]);
    let settings = settings(&info);
    assert!(
        settings.contains("sides: Front") && settings.contains("Subdivide(patches: 20_000)"),
        "{settings}"
    );
    assert!(!settings.contains("Light"), "{settings}");
}

#[test]
fn what_leaves_through_a_missing_wall_is_the_view_factor_to_it() {
    let folder = tempfile::tempdir().unwrap();
    let info = inspect(&obj(folder.path(), &corners([1.0; 3]), &WALLS[..5], true)).unwrap();
    // By reciprocity, one fifth of the lines that leave the five walls would arrive at the sixth.
    close(info.lines.from_fronts.escaped, 0.2);
    // View factor from the floor to a perpendicular wall: Howell's catalog, C-14.
    close(info.lines.from_emitters.unwrap().escaped, 0.200_04);
    // A line through a cube crosses two of its six sides.
    close(info.lines.global.odd, 1.0 / 3.0);
}

#[test]
fn a_dark_room_gets_a_lamp_and_an_open_one_the_sky() {
    let closed = settings(&room(false, |_, _| {}));
    // 500 lumens for each of 20 square meters.
    let lamp = "Light([Panel(corner: (1.5, 2.7, 1.875), edges: ((1, 0, 0), (0, 0, 1.25)), power: 10_000)])";
    assert!(closed.contains(lamp) && closed.contains("units: Photometric"), "{closed}");
    assert!(!closed.contains("Sky"), "{closed}");
    let open = room(false, |_, walls| walls.truncate(5));
    let light = open.settings.iter().find(|setting| setting.set.starts_with("Light")).unwrap();
    assert!(light.set.contains("Sky(") && light.doubt.as_ref().unwrap().contains("Panel("), "{light:?}");
}

#[test]
fn walls_that_face_each_other_wrongly_are_found() {
    let info = one_sided(|walls| walls[0] = turned(walls[0]));
    assert!(info.lines.from_fronts.absorbed > 0.1 && info.lines.global.mixed > 0.1, "{:?}", info.lines);
    assert!(info.findings.iter().any(|f| f.contains("falls on backs")), "{:?}", info.findings);
    assert!(settings(&info).contains("room.gltf\", sides: Both)"), "{:?}", info.settings);
    // All walls face inward: the setting is not suggested.
    assert!(!settings(&one_sided(|_| {})).contains("sides"));
}

#[test]
fn a_room_inside_out_is_found() {
    let info = one_sided(|walls| walls.iter_mut().for_each(|wall| *wall = turned(*wall)));
    assert_eq!((info.lines.from_fronts.escaped, info.lines.from_backs.absorbed), (1.0, 1.0));
    assert_eq!((info.lines.global.mixed, info.lines.reflected), (0.0, None));
    assert!(info.findings.iter().any(|f| f.contains("inside out")), "{:?}", info.findings);
    let settings = settings(&info);
    assert!(settings.contains("sides: Both") && settings.contains("Sky("), "{settings}");
    let lamp = "a lamp would be `Light([Panel(corner: (1.5, 2.7, 1.875)";
    assert!(
        info.settings.iter().any(|setting| setting.doubt.as_ref().is_some_and(|doubt| doubt.contains(lamp)))
    );
}

#[test]
fn a_lamp_that_shines_outward_is_found() {
    let info = room(true, |_, walls| walls[0] = turned(walls[0]));
    assert_eq!(info.lines.from_emitters.unwrap().escaped, 1.0);
    assert!(info.findings.iter().any(|f| f.contains("turned the wrong way")), "{:?}", info.findings);
}

#[test]
fn doubled_and_coincident_triangles_are_found() {
    let twins = |change: fn(&mut Vec<[f64; 3]>, &mut Vec<[usize; 4]>)| {
        let info = room(true, change);
        (info.twins.twins, info.twins.alike, info.lines.global.coincident)
    };
    assert_eq!(twins(|_, _| {}), (0, 0, 0.0));
    assert_eq!(twins(|_, walls| walls.push(walls[1])), (2, 2, 0.0));
    assert_eq!(twins(|_, walls| walls.push(turned(walls[1]))), (2, 0, 0.0));
    // The same wall, split along the other diagonal.
    let info = room(true, |_, walls| {
        let [a, b, c, d] = walls[1];
        walls.push([b, c, d, a]);
    });
    assert_eq!(info.twins.twins, 0);
    assert!(info.lines.global.coincident > 0.1, "{:?}", info.lines.global);
    assert!(info.findings.iter().any(|f| f.contains("coincide")), "{:?}", info.findings);
}

#[test]
fn units_places_and_planes_are_looked_at() {
    let scaled = |by: f64| {
        let info = room(true, |corners, _| corners.iter_mut().flatten().for_each(|x| *x *= by));
        info.findings.join("; ")
    };
    assert_eq!(scaled(1.0), "");
    assert!(scaled(1000.0).contains("looks like millimeters"));
    assert!(scaled(100.0).contains("looks like centimeters"));
    assert!(scaled(0.001).contains("wrong scale"));

    let far = room(true, |corners, _| corners.iter_mut().for_each(|corner| corner[0] += 1e5));
    assert!((far.distance_from_origin - 100_002.0).abs() < 1.0);
    assert!(far.findings.join("; ").contains("far from the origin"), "{:?}", far.findings);

    let ground = room(true, |corners, walls| {
        let first = corners.len();
        corners.extend([
            [-500.0, -1.0, -500.0],
            [-500.0, -1.0, 500.0],
            [500.0, -1.0, 500.0],
            [500.0, -1.0, -500.0],
        ]);
        walls.push([first, first + 1, first + 2, first + 3]);
    });
    let dominant = ground.dominant.as_ref().unwrap();
    assert!((dominant.share - 1e6 / (1e6 + 94.0)).abs() < 1e-9);
    assert_eq!(dominant.rest.max, [4.0, 3.0, 5.0]);
    assert!(ground.findings.join("; ").contains("leave it out"), "{:?}", ground.findings);
    let settings = settings(&ground);
    assert!(settings.contains("Focus(min: (0.000, 0.000, 0.000), max: (4.000, 3.000, 5.000))"), "{settings}");
}

#[test]
fn colors_of_corners_and_textures_are_counted() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.obj");
    let obj = "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nv 0 0 1\nv 1 0 1\nv 0 1 1\nf 1 2 3\nf 4 5 6\n";
    std::fs::write(&path, obj).unwrap();
    let textures = inspect(&path).unwrap().textures;
    assert_eq!((textures.images, textures.texels, textures.triangles), (0, 0, 1));
}

#[test]
fn the_same_file_gives_the_same_numbers_and_an_absent_one_an_error() {
    let json = || {
        let mut info = serde_json::to_value(room(true, |_, walls| walls.truncate(5))).unwrap();
        // The folders differ.
        info.as_object_mut().unwrap().retain(|key, _| key != "scene" && key != "settings");
        info
    };
    assert_eq!(json(), json());
    let error = inspect(Path::new("no/such.gltf")).unwrap_err();
    assert!(error.chain().contains("no/such.gltf"), "{}", error.chain());
    assert_eq!(error.kind(), ErrorKind::Failed);
    let error = inspect(Path::new("room.fbx")).unwrap_err().chain();
    assert!(error.contains("fbx") && error.contains("gltf"), "{error}");
}
