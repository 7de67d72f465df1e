//! The lit glTF is the source with lightmaps.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};
use sir_geom::{LoadOptions, Rgb, Scene, Side, load};
use sir_lightmap::{Lightmap, LightmapFiles, LightmapOptions};
use sir_mesh::PatchMesh;

use crate::scenes::{GoOn, light, options, patches, solution};

const FLOAT: u32 = 5126;
const UNSIGNED_SHORT: u32 = 5123;

/// Builds glTF files for tests.
#[derive(Default)]
struct Builder {
    binary: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Builder {
    fn add(&mut self, bytes: &[u8], component: u32, kind: &str, count: usize) -> usize {
        self.views.push(json!({ "buffer": 0, "byteOffset": self.binary.len(), "byteLength": bytes.len() }));
        self.binary.extend(bytes);
        self.binary.resize(self.binary.len().next_multiple_of(4), 0);
        self.accessors.push(json!({
            "bufferView": self.views.len() - 1, "componentType": component, "type": kind, "count": count,
        }));
        self.accessors.len() - 1
    }

    fn floats<const N: usize>(&mut self, values: &[[f32; N]]) -> usize {
        let bytes: Vec<u8> = values.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
        let kind = if N == 1 { "SCALAR".to_owned() } else { format!("VEC{N}") };
        self.add(&bytes, FLOAT, &kind, values.len())
    }

    fn indices(&mut self, values: &[u16]) -> usize {
        let bytes: Vec<u8> = values.iter().flat_map(|x| x.to_le_bytes()).collect();
        self.add(&bytes, UNSIGNED_SHORT, "SCALAR", values.len())
    }

    fn write(self, folder: &Path, rest: Value) -> PathBuf {
        fs::write(folder.join("room.bin"), &self.binary).unwrap();
        let mut json = rest;
        json["asset"] = json!({ "version": "2.0", "copyright": "nobody" });
        json["buffers"] = json!([{ "uri": "room.bin", "byteLength": self.binary.len() }]);
        json["bufferViews"] = json!(self.views);
        json["accessors"] = json!(self.accessors);
        let path = folder.join("room.gltf");
        fs::write(&path, json.to_string()).unwrap();
        path
    }
}

/// Positions and indices of the outside of a cube of 1 m, with four vertices for each face.
fn cube(inward: bool) -> (Vec<[f32; 3]>, Vec<[f32; 3]>, Vec<u16>) {
    let (mut positions, mut normals, mut indices) = (Vec::new(), Vec::new(), Vec::new());
    for axis in 0..3 {
        for sign in [0.0, 1.0f32] {
            let first = positions.len() as u16;
            for (u, v) in [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0f32)] {
                let mut p = [0.0; 3];
                (p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3]) = (sign, u, v);
                positions.push(p);
                let mut n = [0.0; 3];
                n[axis] = (2.0 * sign - 1.0) * if inward { -1.0 } else { 1.0 };
                normals.push(n);
            }
            let order: [u16; 6] =
                if (sign == 1.0) != inward { [0, 1, 2, 0, 2, 3] } else { [0, 2, 1, 0, 3, 2] };
            indices.extend(order.map(|i| i + first));
        }
    }
    (positions, normals, indices)
}

/// Writes a room with a two-sided curtain, two blocks that share a mesh (one of them mirrored), three posts that are
/// instances, and much that a scene does not have.
fn room(folder: &Path) -> PathBuf {
    let mut b = Builder::default();
    let (positions, normals, indices) = cube(true);
    let room = [b.floats(&positions), b.floats(&normals), b.indices(&indices)];
    let (positions, normals, indices) = cube(false);
    let block = [b.floats(&positions), b.floats(&normals), b.indices(&indices)];
    let curtain = b.floats(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]]);
    let curtain_normals = b.floats(&[[0.0, 0.0, 1.0]; 4]);
    let strip = b.indices(&[0, 1, 3, 2]);
    let places = b.floats(&[[0.2, 0.0, 0.2], [0.2, 0.0, 0.5], [0.2, 0.0, 0.8]]);
    let times = b.floats(&[[0.0], [1.0]]);
    let turns = b.floats(&[[0.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 0.0]]);
    let primitive = |[positions, normals, indices]: [usize; 3], material: usize| {
        json!({
            "attributes": { "POSITION": positions, "NORMAL": normals }, "indices": indices, "material": material,
            "extras": { "own": material },
        })
    };
    b.write(
        folder,
        json!({
            "extensionsUsed": ["EXT_mesh_gpu_instancing", "KHR_lights_punctual"],
            "extensions": { "KHR_lights_punctual": { "lights": [{ "type": "point", "name": "bulb" }] } },
            "scene": 0,
            "scenes": [{ "name": "all", "nodes": [0, 5] }],
            "nodes": [
                { "name": "root", "scale": [4.0, 3.0, 5.0], "children": [1, 2, 3, 4, 6], "extras": { "tag": 7 } },
                { "name": "walls", "mesh": 0 },
                { "name": "block", "mesh": 1, "translation": [0.5, 0.0, 0.5], "scale": [0.2, 0.2, 0.2] },
                { "name": "mirrored", "mesh": 1, "translation": [0.9, 0.0, 0.2], "scale": [-0.1, 0.4, 0.1] },
                { "name": "curtain", "mesh": 2, "translation": [0.1, 0.3, 0.9], "scale": [0.5, 0.5, 0.5] },
                { "name": "bulb", "extensions": { "KHR_lights_punctual": { "light": 0 } }, "translation": [2, 2, 2] },
                { "name": "posts", "mesh": 3, "extensions": {
                    "EXT_mesh_gpu_instancing": { "attributes": { "TRANSLATION": places } },
                } },
            ],
            "meshes": [
                { "name": "walls", "primitives": [primitive(room, 0)] },
                { "name": "block", "primitives": [primitive(block, 1)], "extras": { "kept": true } },
                { "primitives": [{
                    "attributes": { "POSITION": curtain, "NORMAL": curtain_normals },
                    "indices": strip, "mode": 5, "material": 2,
                }] },
                { "name": "post", "primitives": [primitive(block, 1)] },
            ],
            "materials": [
                { "name": "white", "pbrMetallicRoughness": { "baseColorFactor": [0.8, 0.8, 0.8, 1.0] } },
                { "name": "red", "pbrMetallicRoughness": { "baseColorFactor": [0.8, 0.1, 0.1, 1.0] } },
                { "name": "cloth", "doubleSided": true },
                { "name": "unused" },
            ],
            "animations": [{ "name": "turn", "channels": [{ "sampler": 0, "target": { "node": 2, "path": "rotation" } }],
                "samplers": [{ "input": times, "output": turns }] }],
            "cameras": [{ "type": "perspective", "perspective": { "yfov": 0.7, "znear": 0.1 } }],
        }),
    )
}

/// Bakes a scene with random light, and writes all files. Returns the JSON of the lit scene and the manifest.
fn write(
    source: &Path,
    scene: &Scene,
    mesh: &PatchMesh,
    options: LightmapOptions,
    to: &Path,
) -> (Value, Value) {
    let light = light(mesh);
    let errors: Vec<Rgb> = light.iter().map(|e| 0.1 * *e).collect();
    let lightmap = Lightmap::new(solution(scene, mesh, &light, &errors, source), options, &GoOn).unwrap();
    let files = LightmapFiles { combined: true, rgbm: true, unit: "W/m²", ..LightmapFiles::default() };
    let written = lightmap.write(to, files, &GoOn).unwrap();
    assert!(written.iter().all(|file| file.is_file()) && written.last().unwrap() == to);
    let manifest = fs::read_to_string(to.with_extension("json")).unwrap();
    (json_of(to), serde_json::from_str(&manifest).unwrap())
}

fn json_of(glb: &Path) -> Value {
    let bytes = fs::read(glb).unwrap();
    let length = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
    serde_json::from_slice(&bytes[20..20 + length]).unwrap()
}

/// Returns all triangles, each with its corners in a fixed order, and the name of its material.
fn triangles(scene: &Scene) -> Vec<(Vec<[i64; 3]>, String)> {
    let rounded = |p: glam::DVec3| (1e5 * p).round().to_array().map(|x| x as i64);
    let of = |t| {
        let mut corners: Vec<_> = scene.corners(t).map(rounded).to_vec();
        let first = (0..3).min_by_key(|&i| corners[i]).unwrap();
        corners.rotate_left(first);
        (corners, scene.material(t).name.clone())
    };
    let mut all: Vec<_> = scene.triangle_ids().map(of).collect();
    all.sort();
    all
}

#[test]
fn everything_of_the_author_is_kept() {
    let folder = tempfile::tempdir().unwrap();
    let source = room(folder.path());
    let scene = load(&source, &LoadOptions::default()).unwrap().scene;
    let mesh = patches(&scene, 2_000, true);
    for expand in [false, true] {
        let lit = folder.path().join("lit.glb");
        let (json, manifest) =
            write(&source, &scene, &mesh, LightmapOptions { expand, ..options(512) }, &lit);
        let before: Value = serde_json::from_str(&fs::read_to_string(&source).unwrap()).unwrap();
        assert!(json["scenes"][0]["extras"]["lightmap"]["exposure"].is_f64());
        assert_eq!(json["scenes"][0]["nodes"], before["scenes"][0]["nodes"]);
        for list in ["cameras", "extensions", "asset"] {
            assert_eq!(json[list], before[list], "{list}");
        }
        // Accessors have other numbers.
        let samplers = &json["animations"][0]["samplers"][0];
        let of = |name: &str| &json["accessors"][samplers[name].as_u64().unwrap() as usize];
        assert_eq!((&of("input")["type"], &of("output")["type"]), (&json!("SCALAR"), &json!("VEC4")));
        assert_eq!(json["animations"][0]["channels"], before["animations"][0]["channels"]);
        for (i, node) in before["nodes"].as_array().unwrap().iter().enumerate() {
            for member in ["name", "translation", "scale"] {
                assert_eq!(json["nodes"][i][member], node[member]);
            }
        }
        assert_eq!(json["nodes"][0]["extras"]["tag"], 7);
        assert_eq!(json["meshes"][1]["extras"]["kept"], true);
        assert_eq!(json["meshes"][0]["primitives"][0]["extras"]["own"], 0);
        let names = |json: &Value| -> Vec<String> {
            let all = json["materials"].as_array().unwrap().iter();
            let mut all: Vec<String> = all.map(|m| m["name"].as_str().unwrap().to_owned()).collect();
            all.sort();
            all.dedup();
            all
        };
        assert_eq!(names(&json), names(&before));
        // The instances became nodes, and are at the same places.
        assert!(!json["extensionsUsed"].to_string().contains("instancing"));
        let built = load(&lit, &LoadOptions::default()).unwrap().scene;
        let (old, mut new) = (triangles(&scene), triangles(&built));
        // The curtain has a front and a back now.
        assert_eq!(new.len(), old.len() + 2);
        new.retain(|triangle| old.contains(triangle));
        assert_eq!(new, old);
        assert_eq!(built.lights().len(), 1);
        let objects = manifest["objects"].as_array().unwrap();
        assert_eq!(objects.len(), 7, "{objects:?}");
        let is_whole = |object: &&Value| object["uv_rect"] == json!([0.0, 0.0, 1.0, 1.0]);
        assert_eq!(objects.iter().filter(is_whole).count(), if expand { 7 } else { 2 });
        for object in objects {
            let node = &json["nodes"][object["node"].as_u64().unwrap() as usize];
            let place = &node["extras"]["lightmap"];
            assert_eq!(place["uv_rect"], object["uv_rect"]);
            let texture = &json["textures"][place["index"].as_u64().unwrap() as usize];
            assert_eq!(texture["name"], "lightmap 0");
            assert!(place["intensity"].as_f64().unwrap() > 0.0);
            assert_eq!(node["mesh"], object["mesh"]);
            let mesh = &json["meshes"][object["mesh"].as_u64().unwrap() as usize];
            for primitive in mesh["primitives"].as_array().unwrap() {
                assert!(primitive["attributes"]["TEXCOORD_1"].is_u64());
                let material = &json["materials"][primitive["material"].as_u64().unwrap() as usize];
                let refers = material["extensions"]["MOZ_lightmap"]["texCoord"] == 1;
                assert_eq!(refers, is_whole(&object));
            }
        }
        let combined = load(&folder.path().join("lit-combined.glb"), &LoadOptions::default()).unwrap().scene;
        assert_eq!(combined.triangles().len(), built.triangles().len());
    }
}

#[test]
fn both_sides_of_a_curtain_have_their_own_light() {
    let folder = tempfile::tempdir().unwrap();
    let source = room(folder.path());
    let scene = load(&source, &LoadOptions::default()).unwrap().scene;
    let mesh = patches(&scene, 2_000, true);
    let mut light = vec![Rgb::ZERO; mesh.side_count()];
    mesh.for_each_side(|_, _, side, id| {
        light[id.index()] = Rgb::splat(if side == Side::Front { 1.0 } else { 2.0 })
    });
    let of = solution(&scene, &mesh, &light, &light, &source);
    let lightmap = Lightmap::new(of, options(512), &GoOn).unwrap();
    let ([width, height], _) = lightmap.size();
    let curtain = scene.triangle_ids().find(|&t| scene.material(t).name == "cloth").unwrap();
    for (side, expected) in [(Side::Front, 1.0), (Side::Back, 2.0)] {
        let (page, corners) = lightmap.place(curtain, side).unwrap();
        let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
        let row = page as usize * height as usize + middle.y as usize;
        assert_eq!(lightmap.irradiance()[row * width as usize + middle.x as usize][0], expected);
    }
    // The light of an image is found at the same place through the lit scene.
    let lit = folder.path().join("lit.glb");
    lightmap.write(&lit, LightmapFiles::default(), &GoOn).unwrap();
    let json = json_of(&lit);
    let curtain = &json["meshes"][2]["primitives"];
    assert_eq!(curtain.as_array().unwrap().len(), 2);
    for primitive in curtain.as_array().unwrap() {
        let material = &json["materials"][primitive["material"].as_u64().unwrap() as usize];
        assert_eq!((material["name"].as_str(), material.get("doubleSided")), (Some("cloth"), None));
        assert!(primitive.get("mode").is_none(), "strips are triangles now");
    }
}

#[test]
fn backs_without_light_are_left_out() {
    let folder = tempfile::tempdir().unwrap();
    let source = room(folder.path());
    let scene = load(&source, &LoadOptions::default()).unwrap().scene;
    let mesh = patches(&scene, 500, true);
    let mut light = light(&mesh);
    mesh.for_each_side(|_, _, side, id| {
        if side == Side::Back {
            light[id.index()] = Rgb::ZERO;
        }
    });
    let of = solution(&scene, &mesh, &light, &light, &source);
    let lightmap = Lightmap::new(of, options(256), &GoOn).unwrap();
    assert!(lightmap.notes().is_empty(), "{:?}", lightmap.notes());
    let lit = folder.path().join("lit.glb");
    lightmap.write(&lit, LightmapFiles::default(), &GoOn).unwrap();
    let built = load(&lit, &LoadOptions::default()).unwrap().scene;
    assert_eq!(triangles(&built), triangles(&scene));
    let cloth = built.materials().iter().find(|material| material.name == "cloth").unwrap();
    assert_eq!(cloth.sides, sir_geom::Sides::Front);
}

/// Writes a square with a second set of coordinates.
fn square(folder: &Path, set: &[[f32; 2]]) -> PathBuf {
    let mut b = Builder::default();
    let positions = b.floats(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.0, -1.0], [0.0, 0.0, -1.0]]);
    let first = b.floats(&[[0.0, 0.0], [9.0, 0.0], [9.0, 9.0], [0.0, 9.0]]);
    let second = b.floats(set);
    let indices = b.indices(&[0, 1, 2, 0, 2, 3]);
    b.write(
        folder,
        json!({
            "nodes": [{ "mesh": 0 }],
            "meshes": [{ "name": "square", "primitives": [{
                "attributes": { "POSITION": positions, "TEXCOORD_0": first, "TEXCOORD_1": second },
                "indices": indices, "material": 0,
            }] }],
            "materials": [{ "name": "white" }],
        }),
    )
}

#[test]
fn a_layout_of_the_author_is_used_if_it_is_valid() {
    let good = [[0.1, 0.1], [0.9, 0.1], [0.9, 0.9], [0.1, 0.9f32]];
    let cases: [(&[[f32; 2]; 4], Option<&str>); 5] = [
        (&good, None),
        (&[[0.1, 0.1], [1.9, 0.1], [1.9, 0.9], [0.1, 0.9]], Some("beyond the square from 0 to 1")),
        (&[[0.1, 0.1], [0.9, 0.1], [0.9, 0.9], [0.8, 0.2]], Some("triangles overlap")),
        (&[[0.1, 0.1], [0.9, 0.1], [0.9, 0.1], [0.1, 0.9]], Some("has no area in them")),
        (&[[0.1, 0.1], [0.9, f32::NAN], [0.9, 0.9], [0.1, 0.9]], Some("some are not numbers")),
    ];
    for (set, problem) in cases {
        let folder = tempfile::tempdir().unwrap();
        let source = square(folder.path(), set);
        let scene = load(&source, &LoadOptions::default()).unwrap().scene;
        let mesh = patches(&scene, 100, true);
        let (json, manifest) = write(&source, &scene, &mesh, options(64), &folder.path().join("lit.glb"));
        assert_eq!(manifest["objects"][0]["own_layout"], problem.is_none());
        assert_eq!(manifest["objects"][0]["uv_set"], 1);
        let notes = manifest["notes"].to_string();
        match problem {
            Some(problem) => {
                assert!(notes.contains("mesh \\\"square\\\"") && notes.contains(problem), "{notes}")
            }
            None => assert_eq!(notes, "[]"),
        }
        // Four vertices are enough, and the first set is as it was.
        let attributes = &json["meshes"][0]["primitives"][0]["attributes"];
        let count =
            |name: &str| json["accessors"][attributes[name].as_u64().unwrap() as usize]["count"].clone();
        assert_eq!((count("TEXCOORD_1"), count("TEXCOORD_0")), (json!(4), json!(4)));
    }
}
