//! glTF: materials and textures.

use std::f64::consts::PI;

use glam::DVec3;
use serde_json::json;
use sir_geom::{LoadOptions, Material, Sides, SidesPolicy};

use crate::files::{Gltf, load_from, load_with, png, warnings};

/// The linear value of 128 in sRGB (IEC 61966-2-1).
const HALF: f64 = 0.215_860_500_113_899_26;

fn only_material(gltf: &Gltf) -> Material {
    let scene = gltf.load().unwrap().scene;
    let [material] = scene.materials() else { panic!("{:?}", scene.materials()) };
    material.clone()
}

#[test]
fn factors_become_reflectance_and_exitance() {
    let material = only_material(&Gltf::with_material(json!({
        "name": "lamp",
        "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 0.125, 0.1], "metallicFactor": 1},
        "emissiveFactor": [1, 0.5, 0],
        "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 8}},
    })));
    assert_eq!(material.name, "lamp");
    assert_eq!(material.reflectance, DVec3::new(0.5, 0.25, 0.125));
    assert_eq!(material.exitance, PI * DVec3::new(8.0, 4.0, 0.0));
    assert_eq!((material.sides, material.back_emits), (Sides::Front, false));
}

#[test]
fn two_sided_materials_emit_from_both_sides() {
    let material = only_material(&Gltf::with_material(json!({"doubleSided": true})));
    assert_eq!((material.sides, material.back_emits), (Sides::Both, true));
}

#[test]
fn the_default_material_is_gray_with_a_warning() {
    let built = Gltf::triangle().load().unwrap();
    assert_eq!(built.scene.materials()[0].reflectance, DVec3::splat(0.5));
    assert_eq!(warnings(&built), ["1 mesh primitives have no material, and are made gray"]);
}

#[test]
fn sides_are_a_matter_of_policy() {
    for (double_sided, policy, expected) in [
        (false, SidesPolicy::AsAuthored, (Sides::Front, false)),
        (false, SidesPolicy::Both, (Sides::Both, false)),
        (false, SidesPolicy::Front, (Sides::Front, false)),
        (true, SidesPolicy::AsAuthored, (Sides::Both, true)),
        (true, SidesPolicy::Both, (Sides::Both, true)),
        (true, SidesPolicy::Front, (Sides::Front, false)),
    ] {
        let file = Gltf::with_material(json!({"doubleSided": double_sided})).embedded();
        let built = load_with(
            "s.gltf",
            &[("s.gltf", &file)],
            &LoadOptions { sides: policy, ..LoadOptions::default() },
        )
        .unwrap();
        let material = &built.scene.materials()[0];
        assert_eq!((material.sides, material.back_emits), expected, "{double_sided} {policy:?}");
    }
}

/// Returns a material whose reflectance and emission come from texture 0.
fn textured(image: serde_json::Value) -> Gltf {
    let mut gltf = Gltf::with_material(json!({
        "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.5, 0.5, 1], "baseColorTexture": {"index": 0}},
        "emissiveFactor": [1, 1, 1],
        "emissiveTexture": {"index": 1},
    }));
    gltf.json["textures"] = json!([{"source": 0}, {"source": 0}]);
    gltf.json["images"] = json!([image]);
    gltf
}

#[test]
fn textures_count_with_their_mean_wherever_they_are() {
    use base64::Engine as _;
    let image = png([128, 0, 255]);
    let mean = DVec3::new(HALF, 0.0, 1.0);
    let data = base64::engine::general_purpose::STANDARD.encode(&image);
    let mut files = vec![
        textured(json!({"uri": "wood%20.png"})),
        textured(json!({"uri": format!("data:image/png;base64,{data}")})),
    ];
    let mut in_view = textured(json!({"mimeType": "image/png"}));
    in_view.json["images"][0]["bufferView"] = json!(in_view.view(&image));
    files.push(in_view);
    for gltf in files {
        let built = load_from("s.glb", &[("s.glb", &gltf.glb()), ("wood .png", &image)]).unwrap();
        let material = &built.scene.materials()[0];
        assert!(material.reflectance.distance(0.5 * mean) < 1e-14, "{material:?}");
        assert!(material.exitance.distance(PI * mean) < 1e-14, "{material:?}");
        assert!(built.warnings.is_empty(), "{:?}", built.warnings);
    }
}

#[test]
fn textures_that_cannot_be_read_are_one_warning_and_leave_the_factor() {
    for (image, expected) in [
        (json!({"uri": "absent.png"}), "absent.png"),
        (json!({"uri": "../up.png"}), "leads outside the scene's folder"),
        (json!({"uri": "data:image/png;base64,AAAA"}), "image 0"),
        (json!({"bufferView": 8}), "buffer view 8 does not exist"),
        (json!({"mimeType": "image/webp", "bufferView": 0}), "image 0"),
        (json!({}), "it has no data"),
    ] {
        let built = textured(image).load().unwrap();
        let material = &built.scene.materials()[0];
        assert_eq!(material.reflectance, DVec3::splat(0.5));
        assert_eq!(material.exitance, DVec3::splat(PI));
        let [warning] = &warnings(&built)[..] else { panic!("{:?}", built.warnings) };
        assert!(warning.starts_with("1 textures cannot be read") && warning.contains(expected), "{warning}");
    }
    // An image in a format that only an extension supports has no source.
    let mut webp = textured(json!({}));
    webp.json["textures"] = json!([{}, {}]);
    assert_eq!(warnings(&webp.load().unwrap()).len(), 1);
}

#[test]
fn a_reference_to_an_absent_texture_is_an_error() {
    let mut gltf = textured(json!({"uri": "absent.png"}));
    gltf.json["textures"] = json!([]);
    assert!(gltf.load().unwrap_err().to_string().contains("a material: texture 0 does not exist"));
}

#[test]
fn impossible_colors_are_refused() {
    let gltf = Gltf::with_material(json!({"pbrMetallicRoughness": {"baseColorFactor": [-1, 0, 0, 1]}}));
    let error = crate::files::chain(&gltf.load().unwrap_err());
    assert!(error.contains("reflectance") && error.contains("s"), "{error}");
}

#[test]
fn many_clamped_materials_are_a_few_lines() {
    let mut gltf = Gltf::triangle();
    gltf.json["materials"] = json!(vec![json!({"name": "white"}); 40]);
    for i in 0..40 {
        gltf.primitive(json!({"attributes": {"POSITION": 0}, "material": i}));
    }
    let warnings = warnings(&gltf.load().unwrap());
    assert!(warnings.len() < 10, "{warnings:?}");
    assert!(warnings.iter().any(|w| w.starts_with("35 more materials reflect all")), "{warnings:?}");
}
