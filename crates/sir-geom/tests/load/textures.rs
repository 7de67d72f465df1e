//! Textures, masks and vertex colors, in both formats.

use glam::{DVec2, DVec3};
use image::{Rgba, RgbaImage};
use serde_json::{Value, json};
use sir_geom::{Barycentric, Built, Opacity, Rgb, Scene, TextureSums, TriangleId, Wrap};

use crate::files::{Gltf, encoded, load_from, warnings};

/// Returns an image of 2 × 2 texels: red, green; blue, white. Alpha 255, 128; 0, 51.
fn four() -> Vec<u8> {
    let texels = [[255, 0, 0, 255], [0, 255, 0, 128], [0, 0, 255, 0], [255, 255, 255, 51]];
    encoded(RgbaImage::from_fn(2, 2, |x, y| Rgba(texels[(2 * y + x) as usize])))
}

const PLACES: [[f32; 2]; 3] = [[0.0, 0.0], [0.5, 0.0], [0.0, 0.5]];

fn floats(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|x| x.to_le_bytes()).collect()
}

/// Returns a triangle over the upper left texel, with a base color texture and further members of the material.
fn textured(info: &Value, material: &Value) -> Gltf {
    let mut whole = json!({"pbrMetallicRoughness": {"baseColorTexture": info}});
    for (name, value) in material.as_object().unwrap() {
        whole[name] = value.clone();
    }
    let mut gltf = Gltf::with_material(whole);
    let accessor = gltf.accessor(&floats(PLACES.as_flattened()), 5126, "VEC2", 3);
    gltf.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = json!(accessor);
    let view = gltf.view(&four());
    gltf.json["images"] = json!([{"bufferView": view, "mimeType": "image/png"}]);
    gltf.json["textures"] = json!([{"source": 0}]);
    gltf
}

/// Returns the coordinates at the corners of the first triangle for its reflectance.
fn places(scene: &Scene) -> [DVec2; 3] {
    let map = scene.materials()[0].reflectance_map.unwrap().map;
    scene.texture_on(TriangleId(0), &map).unwrap().1
}

/// Returns the mean reflectance of the first triangle.
fn mean(scene: &Scene) -> Rgb {
    let color = scene.materials()[0].reflectance_map.unwrap();
    let (texture, corners) = scene.texture_on(TriangleId(0), &color.map).unwrap();
    color.factor * TextureSums::new(texture, color.map.wrap, |_| 1.0).mean(corners).color
}

fn near(a: Rgb, b: Rgb) -> bool {
    a.distance(b) < 1e-6
}

#[test]
fn a_triangle_has_the_part_of_its_texture_that_its_coordinates_say() {
    let built = textured(
        &json!({"index": 0}),
        &json!({"emissiveFactor": [1, 0, 0], "emissiveTexture": {"index": 0}}),
    )
    .load()
    .unwrap();
    let scene = &built.scene;
    assert_eq!(mean(scene), Rgb::X);
    assert!(near(scene.materials()[0].reflectance, Rgb::splat(0.5)));
    assert_eq!(scene.textures().len(), 1);
    assert_eq!(scene.materials()[0].coordinate_sets(), 1);
    assert!(scene.materials()[0].opacity.is_full());
    assert!(warnings(&built).is_empty(), "{:?}", built.warnings);
}

#[test]
fn mirror_images_keep_coordinates_at_their_corners() {
    let mut gltf = textured(&json!({"index": 0}), &json!({}));
    gltf.json["nodes"][0]["scale"] = json!([-1, 1, 1]);
    let scene = gltf.load().unwrap().scene;
    for (corner, place) in scene.corners(TriangleId(0)).into_iter().zip(places(&scene)) {
        assert_eq!(corner, DVec3::new(-2.0 * place.x, 2.0 * place.y, 0.0));
    }
}

#[test]
fn samplers_say_what_is_outside() {
    for (s, t, expected) in [
        (33071, 33648, [Wrap::Clamp, Wrap::Mirror]),
        (10497, 33071, [Wrap::Repeat, Wrap::Clamp]),
        (1, 10497, [Wrap::Repeat; 2]),
    ] {
        let mut gltf = textured(&json!({"index": 0}), &json!({}));
        gltf.json["samplers"] = json!([{"wrapS": s, "wrapT": t, "magFilter": "nonsense"}]);
        gltf.json["textures"][0]["sampler"] = json!(0);
        let scene = gltf.load().unwrap().scene;
        assert_eq!(scene.materials()[0].reflectance_map.unwrap().map.wrap, expected);
    }
}

#[test]
fn coordinates_are_scaled_turned_and_moved() {
    let turn = std::f32::consts::FRAC_PI_2;
    // A quarter turn takes (1, 0) to (0, −1), which is up.
    for (transform, expected) in [
        (json!({"offset": [0.5, 0.25]}), [[0.5, 0.25], [1.0, 0.25], [0.5, 0.75]]),
        (json!({"scale": [2, 4]}), [[0.0, 0.0], [1.0, 0.0], [0.0, 2.0]]),
        (json!({"rotation": turn}), [[0.0, 0.0], [0.0, -0.5], [0.5, 0.0]]),
        (json!({"rotation": turn, "scale": [2, 4], "offset": [1, 1]}), [[1.0, 1.0], [1.0, 0.0], [3.0, 1.0]]),
    ] {
        let info = json!({"index": 0, "texCoord": 5, "extensions": {"KHR_texture_transform": transform}});
        let mut gltf = textured(&info, &json!({}));
        let attributes = &mut gltf.json["meshes"][0]["primitives"][0]["attributes"];
        attributes["TEXCOORD_5"] = attributes["TEXCOORD_0"].take();
        attributes.as_object_mut().unwrap().remove("TEXCOORD_0");
        let found = places(&gltf.load().unwrap().scene);
        for (place, expected) in found.into_iter().zip(expected) {
            assert!(place.distance(DVec2::from_array(expected)) < 1e-6, "{transform}: {found:?}");
        }
    }
}

#[test]
fn coordinates_may_be_whole_numbers_of_either_set() {
    let info = json!({"index": 0, "texCoord": 0, "extensions": {"KHR_texture_transform": {"texCoord": 1}}});
    for (bytes, component) in [
        (vec![255, 255, 0, 0, 51, 255, 0, 0, 255, 0, 0, 0], 5121),
        ([65535u16, 65535, 13107, 65535, 65535, 0].iter().flat_map(|x| x.to_le_bytes()).collect(), 5123),
    ] {
        let mut gltf = textured(&info, &json!({}));
        let accessor = gltf.accessor(&bytes, component, "VEC2", 3);
        gltf.json["accessors"][accessor]["normalized"] = json!(true);
        if component == 5121 {
            let view = gltf.json["accessors"][accessor]["bufferView"].as_u64().unwrap() as usize;
            gltf.json["bufferViews"][view]["byteStride"] = json!(4);
        }
        gltf.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"] = json!(accessor);
        let expected =
            [[1.0, 1.0], [0.2, 1.0], [1.0, 0.0]].map(|p: [f32; 2]| glam::Vec2::from_array(p).as_dvec2());
        assert_eq!(places(&gltf.load().unwrap().scene), expected);
    }
}

#[test]
fn without_coordinates_there_is_the_mean_and_a_warning() {
    let mut gltf = textured(&json!({"index": 0, "texCoord": 3}), &json!({"alphaMode": "MASK"}));
    gltf.json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = json!([0.5, 1, 1, 1]);
    let built = gltf.load().unwrap();
    let middle = Barycentric { v: 0.25, w: 0.25 };
    assert!(near(built.scene.reflectance_at(TriangleId(0), middle), Rgb::new(0.25, 0.5, 0.5)));
    assert_eq!(built.scene.opacity_at(TriangleId(0), middle), 1.0);
    assert_eq!(
        warnings(&built),
        ["1 mesh primitives lack coordinates for a texture and have its mean color"]
    );
}

/// Returns the opacity at the upper right texel, of alpha 128/255, and at the lower right one, of 51/255.
fn opacities(alpha: &Value, factor: f64) -> [f64; 2] {
    let mut gltf = textured(&json!({"index": 0}), alpha);
    gltf.json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = json!([1, 1, 1, factor]);
    let places = floats(&[0.5, 0.0, 1.0, 0.0, 0.5, 1.0]);
    let accessor = gltf.accessor(&places, 5126, "VEC2", 3);
    gltf.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = json!(accessor);
    let scene = gltf.load().unwrap().scene;
    [0.1, 0.8].map(|w| scene.opacity_at(TriangleId(0), Barycentric { v: 0.1, w }))
}

#[test]
fn alpha_counts_as_its_mode_says() {
    let half = 128.0 / 255.0;
    assert_eq!(opacities(&json!({}), 0.5), [1.0, 1.0]);
    assert_eq!(opacities(&json!({"alphaMode": "BLEND"}), 0.5), [half / 2.0, 0.1]);
    assert_eq!(opacities(&json!({"alphaMode": "MASK"}), 1.0), [1.0, 0.0]);
    // An alpha equal to the threshold suffices.
    assert_eq!(opacities(&json!({"alphaMode": "MASK", "alphaCutoff": 0.2}), 1.0), [1.0, 1.0]);
    assert_eq!(opacities(&json!({"alphaMode": "MASK", "alphaCutoff": 0.2}), 0.99), [1.0, 0.0]);
    assert_eq!(opacities(&json!({"alphaMode": "MASK", "alphaCutoff": 1.1}), 1.0), [0.0, 0.0]);
}

#[test]
fn colors_of_vertices_multiply_and_are_linear() {
    let half = |alpha: f32| floats(&[1.0, 0.5, 0.0, alpha].repeat(3));
    let bytes = [255, 51, 0, 51].repeat(3);
    for (data, component, kind, expected, alpha) in [
        (half(0.5), 5126, "VEC4", Rgb::new(0.5, 0.25, 0.0), 0.5),
        (floats(&[1.0, 0.5, 0.0].repeat(3)), 5126, "VEC3", Rgb::new(0.5, 0.25, 0.0), 1.0),
        (bytes, 5121, "VEC4", Rgb::new(0.5, 0.1, 0.0), 0.2),
    ] {
        for mode in ["OPAQUE", "BLEND"] {
            let mut gltf = Gltf::with_material(json!({"alphaMode": mode,
                "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.5, 0.5, 1]}}));
            let colors = gltf.accessor(&data, component, kind, 3);
            gltf.json["accessors"][colors]["normalized"] = json!(component != 5126);
            gltf.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = json!(colors);
            let built = gltf.load().unwrap();
            let middle = Barycentric { v: 0.25, w: 0.5 };
            assert!(near(built.scene.reflectance_at(TriangleId(0), middle), expected), "{kind}");
            let opacity = if mode == "BLEND" { alpha } else { 1.0 };
            assert!((built.scene.opacity_at(TriangleId(0), middle) - opacity).abs() < 1e-6, "{kind} {mode}");
            assert!(built.warnings.is_empty(), "{:?}", built.warnings);
        }
    }
}

#[test]
fn broken_coordinates_are_errors_that_name_their_primitive() {
    let mut gltf = textured(&json!({"index": 0}), &json!({}));
    let short = gltf.accessor(&floats(&[0.0; 4]), 5126, "VEC2", 2);
    gltf.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = json!(short);
    let error = gltf.load().unwrap_err().to_string();
    assert!(error.contains("primitive 0, texture coordinates: there are 2 for 3 vertices"), "{error}");
    let mut gltf = textured(&json!({"index": 0}), &json!({}));
    gltf.json["textures"][0]["sampler"] = json!(4);
    assert!(gltf.load().unwrap_err().to_string().contains("sampler 4 does not exist"));
}

#[test]
fn unlit_and_glossy_materials_reflect_their_color() {
    let unlit = Gltf::with_material(json!({"name": "sky", "extensions": {"KHR_materials_unlit": {}},
        "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 0, 1]}}))
    .load()
    .unwrap();
    let material = &unlit.scene.materials()[0];
    assert_eq!((material.reflectance, material.exitance), (Rgb::new(0.5, 0.25, 0.0), Rgb::ZERO));
    assert!(warnings(&unlit)[0].contains("unlit"), "{:?}", unlit.warnings);
    for (diffuse, specular, expected) in
        [([0.5, 0.25, 0.0, 1.0], [0.1; 3], [0.5, 0.25, 0.0]), ([0.0, 0.0, 0.0, 1.0], [0.5; 3], [0.5; 3])]
    {
        let material = json!({"extensions": {"KHR_materials_pbrSpecularGlossiness":
            {"diffuseFactor": diffuse, "specularFactor": specular}}});
        let scene = Gltf::with_material(material).load().unwrap().scene;
        assert_eq!(scene.materials()[0].reflectance, Rgb::from_array(expected));
    }
}

fn obj(obj: &str, mtl: &str) -> Built {
    let files: [(&str, &[u8]); 3] =
        [("a.obj", obj.as_bytes()), ("a.mtl", mtl.as_bytes()), ("t.png", &four())];
    load_from("a.obj", &files).unwrap()
}

const SQUARE: &str =
    "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 0.5 0\nvt 0.5 0.5\nvt 0 0.5\n";

#[test]
fn obj_textures_have_their_second_axis_up() {
    let built =
        obj(&format!("{SQUARE}usemtl a\nf 1/1 2/2 3/3 4/4\n"), "newmtl a\nKd 0.5 0.5 0.5\nmap_Kd t.png\n");
    // The lower left texel.
    assert_eq!(mean(&built.scene), Rgb::Z / 2.0);
    let at = |t: u32| {
        built
            .scene
            .texture_on(TriangleId(t), &built.scene.materials()[0].reflectance_map.unwrap().map)
            .unwrap()
            .1
    };
    assert_eq!(at(0), [[0.0, 1.0], [0.5, 1.0], [0.5, 0.5]].map(DVec2::from_array));
    assert_eq!(at(1), [[0.0, 1.0], [0.5, 0.5], [0.0, 0.5]].map(DVec2::from_array));
    assert!(built.scene.materials()[0].opacity.is_full());
    assert!(built.warnings.is_empty(), "{:?}", built.warnings);
    let moved =
        obj(&format!("{SQUARE}usemtl a\nf 1/1 2/2 3/3\n"), "newmtl a\nmap_Kd -o 0.5 0.5 -s 1 1 t.png\n");
    assert_eq!(mean(&moved.scene), Rgb::Y);
}

#[test]
fn obj_values_stay_with_their_faces_when_materials_alternate() {
    let built = obj(
        &format!(
            "{SQUARE}usemtl a\nf 1/1 2/2 3/3\nusemtl b\nf 1 2 3\no x\nusemtl a\nf 3/3 4/4 1/1\nf 1 2 3 4\n"
        ),
        "newmtl a\nmap_Kd t.png\nnewmtl b\nKd 0.1\n",
    );
    let map = built.scene.materials()[0].reflectance_map.unwrap().map;
    let first = |t: u32| built.scene.texture_on(TriangleId(t), &map).map(|(_, corners)| corners[0]);
    let found: Vec<_> = (0..5).map(first).collect();
    assert_eq!(found, [Some(DVec2::new(0.0, 1.0)), None, Some(DVec2::new(0.5, 0.5)), None, None]);
    assert_eq!(warnings(&built), ["1 faces lack coordinates for a texture and have its mean color"]);
}

#[test]
fn obj_opacity_is_d_or_what_tr_leaves() {
    for (lines, factor, warned) in [
        ("d 0.25", 0.25, 0),
        ("Tr 0.25", 0.75, 0),
        ("Tr 1\nd 1", 1.0, 0),
        ("d 0.5\nTr 0.9", 0.5, 0),
        ("Tr 1.000", 1.0, 1),
        ("d -halo 0.5", 0.5, 0),
        ("d 7", 1.0, 0),
        ("", 1.0, 0),
    ] {
        let built = obj(&format!("{SQUARE}usemtl a\nf 1 2 3\n"), &format!("newmtl a\nKd 1 0 0\n{lines}\n"));
        assert_eq!(built.scene.materials()[0].opacity, Opacity { factor, ..Opacity::default() }, "{lines}");
        assert_eq!(
            built.warnings.iter().filter(|w| w.to_string().contains("Tr 1")).count(),
            warned,
            "{lines}"
        );
    }
}

#[test]
fn obj_masks_are_alpha_or_brightness() {
    let text = format!("{SQUARE}usemtl a\nf 1/1 2/2 3/3\n");
    let alpha = obj(&text, "newmtl a\nmap_Kd t.png\nmap_d t.png\nd 0.5\n");
    let material = &alpha.scene.materials()[0];
    assert_eq!(material.opacity.map, material.reflectance_map.map(|color| color.map));
    assert_eq!((material.opacity.factor, alpha.scene.textures().len()), (0.5, 1));
    let gray =
        encoded(RgbaImage::from_fn(2, 1, |x, _| Rgba([51 * x as u8, 51 * x as u8, 51 * x as u8, 255])));
    let files: [(&str, &[u8]); 3] =
        [("a.obj", text.as_bytes()), ("a.mtl", b"newmtl a\nKd 1 0 0\nmap_d t.png\n"), ("t.png", &gray)];
    let bright = load_from("a.obj", &files).unwrap().scene;
    let [texture] = bright.textures() else { panic!("{:?}", bright.textures()) };
    assert_eq!(texture.texels().iter().map(|texel| texel[3]).collect::<Vec<_>>(), [0, 51]);
}

#[test]
fn obj_colors_of_vertices_are_decoded() {
    let text = "v 0 0 0 1 0.5 0\nv 1 0 0 1 0.5 0\nv 1 1 0 1 0.5 0\nv 0 1 0\nf 1 2 3\nf 2 3 4\n";
    let built = obj(text, "");
    let at = |t: u32| built.scene.reflectance_at(TriangleId(t), Barycentric { v: 0.0, w: 1.0 });
    assert!(near(at(0), 0.999 * Rgb::new(1.0, 0.214_041_14, 0.0)), "{}", at(0));
    assert!(near(at(1), Rgb::splat(0.999)));
}

/// Colors that rounding or a filter has carried above 1 do not turn a whole scan dark.
#[test]
fn obj_colors_range_to_255_only_if_the_whole_file_does() {
    let second = |color: &str| {
        let text = format!("v 0 0 0 {color}\nv 1 0 0 0.2 0.2 0.2\nv 1 1 0\nf 1 2 3\n");
        let built = obj(&text, "");
        (built.scene.reflectance_at(TriangleId(0), Barycentric { v: 1.0, w: 0.0 }), warnings(&built))
    };
    let (fifth, none) = second("1 1 1");
    assert!(near(fifth, Rgb::splat(0.999 * 0.033_104_766)) && none.is_empty(), "{fifth} {none:?}");
    for (color, range) in
        [("1.0039 1 1", "0.2 to 1.0039"), ("1.000001 -0.5 0", "-0.5 to 1.000001"), ("255 0 0", "0 to 255")]
    {
        let (same, texts) = second(color);
        assert_eq!(same, fifth, "{color}");
        let clamped = "1 vertex colors are outside 0 to 1 and were clamped: values range from";
        assert!(texts.len() == 1 && texts[0].starts_with(&format!("{clamped} {range};")), "{texts:?}");
    }
    let text = "v 0 0 0 255 0 1\nv 1 0 0 51 51 51.0\nv 1 1 0\nf 1 2 3\n";
    let built = obj(text, "");
    assert!(near(built.scene.reflectance_at(TriangleId(0), Barycentric { v: 1.0, w: 0.0 }), fifth));
    assert_eq!(
        warnings(&built),
        ["2 vertex colors are taken as 0 to 255, because all values are whole numbers and most exceed 1"]
    );
}
