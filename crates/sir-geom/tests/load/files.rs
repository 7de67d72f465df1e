//! Files that the tests create.

use std::fs;
use std::path::Path;

use base64::Engine as _;
use serde_json::{Value, json};
use sir_geom::{Built, LoadError, LoadOptions, Scene, load};

/// Reads `name` from a folder with the given files.
pub(crate) fn load_from(name: &str, files: &[(&str, &[u8])]) -> Result<Built, LoadError> {
    load_with(name, files, &LoadOptions::default())
}

/// Does the same with options.
pub(crate) fn load_with(
    name: &str,
    files: &[(&str, &[u8])],
    options: &LoadOptions,
) -> Result<Built, LoadError> {
    let folder = tempfile::tempdir().unwrap();
    for (file, bytes) in files {
        let path = folder.path().join(file);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, bytes).unwrap();
    }
    load(&folder.path().join(name), options)
}

/// Returns the warnings of a reader.
pub(crate) fn warnings(built: &Built) -> Vec<String> {
    built.warnings.iter().map(ToString::to_string).collect()
}

/// Returns the corners of all triangles.
pub(crate) fn corners(scene: &Scene) -> Vec<[[f64; 3]; 3]> {
    scene.triangle_ids().map(|t| scene.corners(t).map(|p| p.to_array())).collect()
}

/// Returns an error with its whole chain of sources, as a program prints it.
pub(crate) fn chain(error: &dyn std::error::Error) -> String {
    let mut text = error.to_string();
    let mut source = error.source();
    while let Some(cause) = source {
        text = format!("{text}: {cause}");
        source = cause.source();
    }
    text
}

/// Returns a PNG image of one color.
pub(crate) fn png(rgb: [u8; 3]) -> Vec<u8> {
    encoded(image::RgbImage::from_pixel(3, 2, image::Rgb(rgb)))
}

/// Encodes an image as PNG.
pub(crate) fn encoded(image: impl Into<image::DynamicImage>) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    image.into().write_to(&mut bytes, image::ImageFormat::Png).unwrap();
    bytes.into_inner()
}

/// Builder of a glTF file: one scene with one node with one mesh, and one buffer.
pub(crate) struct Gltf {
    pub(crate) json: Value,
    pub(crate) bytes: Vec<u8>,
}

impl Gltf {
    pub(crate) fn new() -> Self {
        let json = json!({
            "asset": {"version": "2.0"},
            "scene": 0,
            "scenes": [{"nodes": [0]}],
            "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": []}],
            "accessors": [],
            "bufferViews": [],
        });
        Self { json, bytes: Vec::new() }
    }

    /// Returns one triangle in the plane z = 0 whose front faces +z.
    pub(crate) fn triangle() -> Self {
        let mut gltf = Self::new();
        let positions = gltf.positions(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
        gltf.primitive(json!({"attributes": {"POSITION": positions}}));
        gltf
    }

    /// Returns a triangle with the given material.
    pub(crate) fn with_material(material: Value) -> Self {
        let mut gltf = Self::triangle();
        gltf.json["materials"] = json!([material]);
        gltf.json["meshes"][0]["primitives"][0]["material"] = json!(0);
        gltf
    }

    fn push(&mut self, list: &str, element: Value) -> usize {
        let list = self.json[list].as_array_mut().unwrap();
        list.push(element);
        list.len() - 1
    }

    pub(crate) fn view(&mut self, bytes: &[u8]) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let view = json!({"buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len()});
        self.bytes.extend(bytes);
        self.push("bufferViews", view)
    }

    pub(crate) fn accessor(&mut self, bytes: &[u8], component: u32, kind: &str, count: usize) -> usize {
        let view = self.view(bytes);
        let accessor = json!({"bufferView": view, "componentType": component, "type": kind, "count": count});
        self.push("accessors", accessor)
    }

    pub(crate) fn positions(&mut self, positions: &[[f32; 3]]) -> usize {
        let bytes: Vec<u8> = positions.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect();
        self.accessor(&bytes, 5126, "VEC3", positions.len())
    }

    pub(crate) fn indices(&mut self, indices: &[u16]) -> usize {
        let bytes: Vec<u8> = indices.iter().flat_map(|i| i.to_le_bytes()).collect();
        self.accessor(&bytes, 5123, "SCALAR", indices.len())
    }

    pub(crate) fn primitive(&mut self, primitive: Value) {
        self.json["meshes"][0]["primitives"].as_array_mut().unwrap().push(primitive);
    }

    /// Returns the text with a reference to the buffer.
    pub(crate) fn text(&self, uri: &str) -> Vec<u8> {
        let mut json = self.json.clone();
        json["buffers"] = json!([{"byteLength": self.bytes.len(), "uri": uri}]);
        serde_json::to_vec(&json).unwrap()
    }

    /// Returns the text with the buffer embedded.
    pub(crate) fn embedded(&self) -> Vec<u8> {
        let data = base64::engine::general_purpose::STANDARD.encode(&self.bytes);
        self.text(&format!("data:application/octet-stream;base64,{data}"))
    }

    pub(crate) fn glb(&self) -> Vec<u8> {
        let mut json = self.json.clone();
        json["buffers"] = json!([{"byteLength": self.bytes.len()}]);
        let mut body = Vec::new();
        for (kind, mut data, pad) in
            [(b"JSON", serde_json::to_vec(&json).unwrap(), b' '), (b"BIN\0", self.bytes.clone(), 0)]
        {
            data.resize(data.len().next_multiple_of(4), pad);
            body.extend((data.len() as u32).to_le_bytes());
            body.extend(kind);
            body.extend(data);
        }
        [&b"glTF"[..], &2u32.to_le_bytes(), &(12 + body.len() as u32).to_le_bytes(), &body].concat()
    }

    pub(crate) fn load(&self) -> Result<Built, LoadError> {
        load_from("scene.gltf", &[("scene.gltf", &self.embedded())])
    }
}

/// Returns the folder with third-party data.
pub(crate) fn third_party_data() -> std::path::PathBuf {
    let folder = std::env::var_os("SIR_TEST_DATA")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared"), Into::into);
    let is_complete = folder.join("scenes").is_dir() && folder.join("corpus").is_dir();
    assert!(is_complete, "no test data in {}; set SIR_TEST_DATA to its folder", folder.display());
    folder
}
