//! Pages, read back as a browser does.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a step that fails is a test that fails")]

use std::collections::BTreeSet;
use std::fs;
use std::io::Read as _;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use flate2::read::ZlibDecoder;
use glam::DVec3;
use serde_json::{Value, json};
use sha2::{Digest, Sha256};
use sir_geom::shapes::{Facing, cuboid};
use sir_geom::{Material, Rgb, Scene, SceneBuilder, Sides, luminance};
use sir_mesh::{PatchMesh, PatchSize, Subdivision};
use sir_report::{Light, LogScale, View, write_page};
use sir_view::DisplayMesh;

const HOSTILE: &str = "</script><img src=x onerror=alert(1)> \"quoted\" & 💡";

fn scene() -> Scene {
    let mut builder = SceneBuilder::new();
    let wall =
        builder.add_material(Material::diffuse(HOSTILE, Rgb::new(0.8, 0.5, 0.1)).with_sides(Sides::Both));
    let lamp = builder.add_material(Material::diffuse("lamp", Rgb::ZERO).emitting(Rgb::splat(100.0)));
    builder.begin_group(&"long ".repeat(100_000));
    cuboid(
        &mut builder,
        DVec3::new(-3.0, 1.0, 20.0),
        DVec3::new(-1.0, 2.0, 23.0),
        [wall, wall, wall, lamp, wall, wall],
        Facing::Inward,
    );
    builder.build().unwrap().scene
}

/// Returns the text of an element of a page.
fn element<'a>(page: &'a str, start: &str, end: &str) -> &'a str {
    let (_, rest) = page.split_once(start).unwrap();
    rest.split_once(end).unwrap().0
}

/// Coded arrays of a page.
struct Coded {
    header: Value,
    bytes: Vec<u8>,
}

impl Coded {
    fn of(page: &str) -> Self {
        let deflated = STANDARD.decode(element(page, "id=\"mesh\">", "</script>").trim()).unwrap();
        let mut bytes = Vec::new();
        ZlibDecoder::new(&deflated[..]).read_to_end(&mut bytes).unwrap();
        let length = u32::from_le_bytes(bytes[..4].try_into().unwrap()) as usize;
        let header = serde_json::from_slice(&bytes[4..4 + length]).unwrap();
        Self { header, bytes: bytes.split_off(4 + length) }
    }

    /// Returns the elements of an array, component by component.
    fn array(&self, name: &str) -> Vec<Vec<u32>> {
        let description = &self.header["arrays"][name];
        let number = |field: &str| description[field].as_u64().unwrap() as usize;
        let [mut offset, width, stride, count] = ["offset", "bytes", "stride", "count"].map(number);
        let mut components = Vec::new();
        for _ in 0..stride {
            let mut elements = vec![0_u32; count];
            for byte in 0..width {
                for (element, &code) in elements.iter_mut().zip(&self.bytes[offset..offset + count]) {
                    *element |= u32::from(code) << (8 * byte);
                }
                offset += count;
            }
            if description.get("plain").is_none() {
                let mut sum = 0_u32;
                for element in &mut elements {
                    let difference = (*element >> 1) ^ (*element & 1).wrapping_neg();
                    sum = sum.wrapping_add(difference) & (u32::MAX >> (32 - 8 * width as u32));
                    *element = sum;
                }
            }
            components.push(elements);
        }
        components
    }

    /// Returns numbers of light with three bands.
    fn bands(&self, name: &str, log: &str) -> Vec<Rgb> {
        let scale = self.scale(log);
        let [g, r, b] = &self.array(name)[..] else { panic!("three bands") };
        let number = |code: u32| scale.number(code as u16);
        let one = |i: usize| Rgb::new(number(r[i] + g[i]), number(g[i]), number(b[i] + g[i]));
        (0..g.len()).map(one).collect()
    }

    fn scale(&self, log: &str) -> LogScale {
        let log = &self.header["logs"][log];
        LogScale { low: log["low"].as_f64().unwrap(), step: log["step"].as_f64().unwrap() }
    }
}

/// Returns the page of a scene whose light varies from patch to patch, with the light.
fn page(mesh: &PatchMesh, scene: &Scene) -> (String, Vec<Rgb>, Vec<Rgb>) {
    let value = |i: usize| Rgb::new(1.0, 2.0, 0.05) * (1.0 + (0.3 * i as f64).sin().abs() * 50.0);
    let irradiance: Vec<Rgb> = (0..mesh.side_count()).map(value).collect();
    let error: Vec<Rgb> = irradiance.iter().map(|e| 0.02 * *e).collect();
    let light = Light { irradiance: &irradiance, error: &error, direct: Some(&error) };
    let view = View::new(&DisplayMesh::new(scene, mesh, &irradiance), light);
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("page.html");
    write_page(&path, HOSTILE, &view, &json!({ "title": HOSTILE, "cameras": [] })).unwrap();
    (fs::read_to_string(path).unwrap(), irradiance, error)
}

#[test]
fn the_light_of_patches_is_exact_to_three_digits() {
    let scene = scene();
    let mesh = PatchMesh::new(&scene, Subdivision::Surfaces(PatchSize::Count(400))).unwrap();
    let (page, irradiance, error) = page(&mesh, &scene);
    let coded = Coded::of(&page);
    let near = |a: f64, b: f64, tolerance: f64| (a - b).abs() <= tolerance * b.abs();
    let shown = coded.bands("sideIrradiance", "irradiance");
    assert_eq!(shown.len(), mesh.side_count());
    let mut by_patch = vec![Vec::new(); mesh.patch_count()];
    mesh.for_each_side(|t, patch, side, id| {
        let radiosity = mesh.exitance(&scene, t, patch, side)
            + mesh.reflectance(&scene, t, patch) * irradiance[id.index()];
        by_patch[patch.0 as usize].push((irradiance[id.index()], error[id.index()], radiosity));
    });
    let [patches, materials] = ["patch", "material"].map(|name| coded.array(name).swap_remove(0));
    let (errors, direct) =
        (coded.array("sideError").swap_remove(0), coded.array("sideDirect").swap_remove(0));
    let [reflectance, exitance] = ["reflectance", "exitance"].map(|name| coded.bands(name, name));
    for i in 0..shown.len() {
        let found = by_patch[patches[i] as usize].iter().any(|(e, se, b)| {
            let radiosity = exitance[i] + reflectance[i] * shown[i];
            (0..3).all(|k| near(shown[i][k], e[k], 3e-4) && near(radiosity[k], b[k], 1e-3))
                && near(coded.scale("error").number(errors[i] as u16), luminance(*se), 2.5e-3)
                && near(coded.scale("direct").number(direct[i] as u16), luminance(*se), 3e-4)
        });
        assert!(found, "{i}");
        let name = coded.header["materials"][materials[i] as usize]["name"].as_str().unwrap();
        assert_eq!(name == "lamp", exitance[i] != Rgb::ZERO);
    }
    let object = coded.header["objects"][1].as_str().unwrap();
    assert!(object.starts_with("long ") && object.chars().count() == 201, "cut");
}

#[test]
fn triangles_cover_all_sides() {
    let scene = scene();
    let mesh = PatchMesh::new(&scene, Subdivision::Surfaces(PatchSize::Count(400))).unwrap();
    let coded = Coded::of(&page(&mesh, &scene).0);
    let step = coded.header["step"].as_f64().unwrap();
    let positions = coded.array("position");
    let origin = |k: usize| coded.header["origin"][k].as_f64().unwrap();
    let position =
        |i: u32| DVec3::from_array([0, 1, 2].map(|k| origin(k) + step * f64::from(positions[k][i as usize])));
    let mut next = 0;
    let indices: Vec<u32> = coded.array("index")[0]
        .iter()
        .map(|&code| {
            let index = next - code;
            next += u32::from(code == 0);
            index
        })
        .collect();
    assert_eq!(next as usize, positions[0].len());
    let counts = &coded.array("sideTriangles")[0];
    let triangles: Vec<_> = indices.chunks_exact(3).collect();
    assert_eq!(counts.iter().sum::<u32>() as usize, triangles.len());
    let area = |t: &&[u32]| {
        let [a, b, c] = [t[0], t[1], t[2]].map(position);
        0.5 * (b - a).cross(c - a).length()
    };
    let (walls, lamp) = (2.0 * (2.0 * 1.0 + 2.0 * 3.0 + 1.0 * 3.0), 2.0 * 3.0);
    let all: f64 = triangles.iter().map(area).sum();
    assert!((all - (2.0 * walls - lamp)).abs() < 1e-3, "{all}");
    assert_eq!(coded.array("vertexIrradiance")[0].len(), next as usize);
}

#[test]
fn hostile_names_stay_text() {
    let scene = scene();
    let mesh = PatchMesh::new(&scene, Subdivision::PerFace).unwrap();
    let (page, ..) = page(&mesh, &scene);
    assert!(!page.contains("<img src=x"));
    assert!(!page.contains("{{"));
    let facts: Value = serde_json::from_str(element(&page, "id=\"facts\">", "</script>")).unwrap();
    assert_eq!(facts["title"], HOSTILE);
    let policy = element(&page, "Content-Security-Policy\" content=\"", "\"");
    let hash = |text: &str| format!("'sha256-{}'", STANDARD.encode(Sha256::digest(text)));
    assert!(policy.contains(&format!("style-src {}", hash(element(&page, "<style>", "</style>")))));
    let script = page.rsplit_once("<script>").unwrap().1.split_once("</script>").unwrap().0;
    assert!(policy.contains(&format!("script-src {}", hash(script))));
    assert!(policy.starts_with("default-src 'none';"));
    // One script that runs, and two that are data.
    let kinds: BTreeSet<&str> = page.match_indices("<script").map(|(i, _)| &page[i..i + 12]).collect();
    assert_eq!((page.matches("<script").count(), kinds.len()), (3, 2));
}

#[test]
fn a_scene_without_light_has_a_page() {
    let scene = scene();
    let mesh = PatchMesh::new(&scene, Subdivision::PerFace).unwrap();
    let dark = vec![Rgb::ZERO; mesh.side_count()];
    let view = View::new(
        &DisplayMesh::new(&scene, &mesh, &dark),
        Light { irradiance: &dark, error: &dark, direct: None },
    );
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("page.html");
    write_page(&path, "dark", &view, &json!({})).unwrap();
    let coded = Coded::of(&fs::read_to_string(path).unwrap());
    assert!(coded.bands("sideIrradiance", "irradiance").iter().all(|e| *e == Rgb::ZERO));
    assert!(coded.header["arrays"].get("sideDirect").is_none());
}
