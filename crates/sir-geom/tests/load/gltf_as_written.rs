//! glTF as programs write it: numbers, versions, references, and messages about what is wrong.

use image::{Rgba, RgbaImage};
use serde_json::{Value, json};
use sir_geom::LoadError;

use crate::files::{Gltf, corners, encoded, load_from, warnings};

/// Reads a text as a glTF file.
fn error_of(text: &[u8]) -> String {
    load_from("a.gltf", &[("a.gltf", text)]).unwrap_err().to_string()
}

/// Writes all whole numbers of a document as floats, in turn as `3.0`, `30e-1` and `0.3E1`.
fn as_floats(value: &Value, count: &mut usize) -> String {
    match value {
        Value::Number(number) if number.is_u64() => {
            *count += 1;
            match *count % 3 {
                0 => format!("{number}.0"),
                1 if *number != 0.into() => format!("{number}0e-1"),
                _ => format!("{}E1", number.as_f64().unwrap() / 10.0),
            }
        }
        Value::Array(list) => {
            format!("[{}]", list.iter().map(|v| as_floats(v, count)).collect::<Vec<_>>().join(","))
        }
        Value::Object(members) => {
            let all = members.iter().map(|(name, v)| format!("{name:?}:{}", as_floats(v, count)));
            format!("{{{}}}", all.collect::<Vec<_>>().join(","))
        }
        other => other.to_string(),
    }
}

#[test]
fn whole_numbers_may_be_written_as_floats() {
    let mut gltf = Gltf::triangle();
    let indices = gltf.indices(&[2, 0, 1]);
    let positions = &mut gltf.json["meshes"][0]["primitives"][0];
    positions["indices"] = json!(indices);
    positions["mode"] = json!(4);
    positions["material"] = json!(0);
    gltf.json["materials"] = json!([{"pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 1, 1]}}]);
    gltf.json["nodes"][0]["translation"] = json!([-1, 0.5, 3]);
    let plain = gltf.load().unwrap().scene;
    let json: Value = serde_json::from_slice(&gltf.embedded()).unwrap();
    let mut count = 0;
    let text = as_floats(&json, &mut count);
    assert!(count > 20 && text.contains("E1") && text.contains("e-1"), "{text}");
    let scene = load_from("a.gltf", &[("a.gltf", text.as_bytes())]).unwrap().scene;
    assert_eq!(corners(&scene), corners(&plain));
    assert_eq!(scene.materials(), plain.materials());
    // Other numbers are no indices.
    let error = error_of(text.replace("\"mesh\":", "\"mesh\":0.5,\"was\":").as_bytes());
    assert!(error.contains("nodes[0].mesh: found 0.5, expected a whole number"), "{error}");
}

#[test]
fn versions_are_named() {
    let with = |version: Value, minimum: Value| {
        let mut gltf = Gltf::triangle();
        gltf.json["asset"] = json!({});
        for (name, value) in [("version", version), ("minVersion", minimum)] {
            if !value.is_null() {
                gltf.json["asset"][name] = value;
            }
        }
        gltf.load()
    };
    for (version, minimum) in [
        (json!("2.0"), json!("2.0")),
        (json!("2.1"), json!(null)),
        (json!("2.1"), json!("2.0")),
        (json!("2"), json!(null)),
        (json!(2.0), json!(2)),
    ] {
        assert!(with(version.clone(), minimum.clone()).is_ok(), "{version} {minimum}");
    }
    for (version, minimum, named) in [
        (json!("1.0"), json!(null), "1.0"),
        (json!(1.1), json!(null), "1.1"),
        (json!("3.0"), json!("2.0"), "3.0"),
        (json!("2.1"), json!("2.1"), "2.1"),
        (json!("2.5"), json!(2.1), "2.1"),
    ] {
        let error = with(version, minimum).unwrap_err();
        assert!(
            matches!(&error, LoadError::GltfVersion { version, .. } if version == named),
            "{named}: {error}"
        );
    }
    let error = with(json!("two"), json!(null)).unwrap_err().to_string();
    assert!(error.contains("its version \"two\" is not of the form \"2.0\""), "{error}");
    let error = with(json!(null), json!(null)).unwrap_err().to_string();
    assert!(error.contains("asset: `version` is missing"), "{error}");
    // In glTF 1.0, elements have names.
    let old =
        br#"{"scene": "s", "scenes": {"s": {"nodes": ["n"]}}, "nodes": {"n": {"meshes": []}}, "meshes": {}}"#;
    assert!(error_of(old).contains("this is a file of glTF 1.0, but only glTF 2.0 is supported"));
    let binary = [&b"glTF"[..], &1u32.to_le_bytes(), &20u32.to_le_bytes(), &[0; 8]].concat();
    let error = load_from("a.glb", &[("a.glb", &binary)]).unwrap_err();
    assert!(matches!(error, LoadError::GltfVersion { .. }), "{error}");
}

#[test]
fn messages_have_no_jargon() {
    let whole = serde_json::to_string(&Gltf::triangle().json).unwrap();
    for (text, expected) in [
        ("[]", "its JSON text is not an object"),
        ("3", "its JSON text is not an object"),
        ("{}", "`asset` is missing"),
        (r#"{"asset": []}"#, "asset: found a list of length 0, expected an object"),
        (r#"{"asset": {"version": "2.0"}, "nodes": 4}"#, "nodes: found 4, expected a list"),
        (r#"{"asset": {"version": "2.0"}, "nodes": [7]}"#, "nodes[0]: found 7, expected an object"),
        (
            r#"{"asset": {"version": "2.0"}, "nodes": [{"mesh": -1}]}"#,
            "nodes[0].mesh: found -1, expected a whole",
        ),
        (
            r#"{"asset": {"version": "2.0"}, "nodes": [{"translation": [1, 2]}]}"#,
            "nodes[0].translation: found a list of length 2, expected a list of 3 numbers",
        ),
        (r#"{"asset": {"version": "2.0"}, "accessors": [{}]}"#, "accessors[0]: `count` is missing"),
        (
            r#"{"asset": {"version": "2.0"}, "extensionsUsed": "KHR_x"}"#,
            "extensionsUsed: found the text \"KHR_x\", expected a list",
        ),
        ("version https://git-lfs.github.com/spec/v1\noid sha256:0\n", "a pointer of Git LFS"),
        (&whole[..whole.len() / 2], "its text is not complete, valid JSON"),
    ] {
        let error = error_of(text.as_bytes());
        assert!(error.contains(expected), "{text}: {error}");
        for jargon in ["struct", "u32", "invalid type", "4294967295"] {
            assert!(!error.contains(jargon), "{text}: {error}");
        }
    }
    let utf16: Vec<u8> = "\u{feff}{}".encode_utf16().flat_map(u16::to_le_bytes).collect();
    assert!(error_of(&utf16).contains("UTF-16"));
}

/// Returns a triangle with a texture of these JSON objects.
fn textured(texture: Value, image: Value) -> Gltf {
    let mut gltf = Gltf::with_material(json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}));
    gltf.json["textures"] = json!([texture]);
    gltf.json["images"] = json!([image]);
    gltf
}

#[test]
fn textures_that_cannot_be_read_have_a_true_reason() {
    let png = encoded(RgbaImage::from_pixel(2, 2, Rgba([128, 128, 128, 255])));
    let webp = b"RIFF\x24\0\0\0WEBPVP8L\x18\0\0\0";
    for (texture, uri, expected) in [
        (json!({"source": 0}), "Wood.PNG", "there is wood.png, whose name differs in upper and lower case"),
        (json!({"source": 0}), "/home/me/wood.png", "it is an absolute path"),
        (json!({"source": 0}), "C:\\Users\\me\\wood.png", "it is an absolute path"),
        (json!({"source": 0}), "https://example.org/wood.png", "it is an address on the web"),
        (json!({"source": 0}), "../wood.png", "it leads outside the scene's folder"),
        (json!({"source": 0}), "wood.webp", "image 0 (it is neither a PNG nor a JPEG image)"),
        (json!({"source": 5}), "wood.png", "image 5 (it does not exist)"),
        (json!({}), "wood.png", "texture 0 (it has no image)"),
        (
            json!({"extensions": {"EXT_texture_webp": {"source": 0}}}),
            "wood.png",
            "texture 0 (it has no PNG or JPEG image, only one for EXT_texture_webp)",
        ),
    ] {
        let file = textured(texture, json!({"uri": uri})).embedded();
        let files: [(&str, &[u8]); 3] = [("a.gltf", &file), ("wood.png", &png), ("wood.webp", webp)];
        let all = warnings(&load_from("a.gltf", &files).unwrap());
        assert!(all[0].contains(expected) && !all[0].contains("4294967295"), "{uri}: {all:?}");
    }
    // Textures whose files have other names than their URIs say at first sight.
    for (uri, name) in [
        ("textures\\wood.png", "textures/wood.png"),
        (".\\wood.png", "wood.png"),
        ("a/../wood.png", "wood.png"),
        ("wood%20100%.png", "wood 100%.png"),
        ("wood%20.png", "wood%20.png"),
        ("wood.png?v=3", "wood.png"),
        ("wood#2.png", "wood#2.png"),
    ] {
        let file = textured(json!({"source": 0}), json!({"uri": uri})).embedded();
        let built = load_from("a.gltf", &[("a.gltf", &file), (name, &png)]).unwrap();
        assert!(built.warnings.is_empty(), "{uri}: {:?}", built.warnings);
    }
}

/// The memory for an image follows from its number of pixels, not from how well its file is packed: this one has 618
/// bytes for 2048 × 2048 pixels of one color with alpha 82/255.
#[test]
fn images_of_one_color_may_be_small_files() {
    let mut gltf = textured(json!({"source": 0}), json!({"uri": "palette.png"}));
    gltf.json["materials"][0]["alphaMode"] = json!("BLEND");
    let files: [(&str, &[u8]); 2] =
        [("a.gltf", &gltf.embedded()), ("palette.png", include_bytes!("palette.png"))];
    let built = load_from("a.gltf", &files).unwrap();
    let material = &built.scene.materials()[0];
    assert_eq!((material.opacity.factor, material.opacity.map), (82.0 / 255.0, None));
    // Linear value of 200 in sRGB (IEC 61966-2-1).
    assert!((material.reflectance.x - 0.577_580_44).abs() < 1e-8, "{}", material.reflectance);
    assert!(built.warnings.is_empty(), "{:?}", built.warnings);
}
