//! Writer of scenes in glTF 2.0 (Khronos Group, <https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html>).
//!
//! One mesh holds all triangles. It has one primitive per material, in the order of the materials, with the triangles
//! in the order of the scene. All primitives share one list of positions. Equal scenes give equal bytes.

use std::{fs, path::Path};

use base64::{Engine, prelude::BASE64_STANDARD};
use glam::{DMat3, DQuat, DVec3};
use serde_json::{Value, json};
use sir_geom::{Camera, Material, MaterialId, Projection, Scene, Sides};

use crate::error::Error;

/// `componentType` of 16-bit indices.
const UNSIGNED_SHORT: u32 = 5123;
/// `componentType` of 32-bit indices.
const UNSIGNED_INT: u32 = 5125;
/// `componentType` of coordinates.
const FLOAT: u32 = 5126;
/// `target` of a buffer view of coordinates.
const ARRAY_BUFFER: u32 = 34962;
/// `target` of a buffer view of indices.
const ELEMENT_ARRAY_BUFFER: u32 = 34963;
/// Distance of the near clipping plane for viewers \[m\]; a radiosity picture needs none.
const NEAR: f64 = 0.01;

/// Writes a scene to a glTF file: as text with embedded geometry if `path` ends in `.gltf`, in binary form if it ends
/// in `.glb`.
///
/// Positions, reflectances and emissions become 32-bit floats. A material's exitance `M` is stored as the radiance `M /
/// π` with the extension `KHR_materials_emissive_strength`. Materials without triangles are stored too, so that
/// material indices do not change. Partial opacity becomes `alphaMode: BLEND`; textures are left out. The vertical
/// field of view of a camera must be below π. The file cannot distinguish a surface that reflects on both sides but
/// emits on one from a surface that emits on both.
///
/// # Errors
///
/// If a coordinate exceeds the range of 32-bit floats, the file name extension is unknown, or the file cannot be
/// written.
pub fn write_gltf(scene: &Scene, path: &Path) -> Result<(), Error> {
    let extension = path.extension().and_then(|e| e.to_str()).unwrap_or_default();
    let bytes = match extension {
        "gltf" => text(scene)?,
        "glb" => binary(scene)?,
        _ => return Err(Error::Extension { path: path.to_owned() }),
    };
    fs::write(path, bytes).map_err(|source| Error::Write { path: path.to_owned(), source })
}

/// Returns the content of a `.gltf` file.
fn text(scene: &Scene) -> Result<Vec<u8>, Error> {
    let geometry = Geometry::of(scene)?;
    let uri = format!("data:application/octet-stream;base64,{}", BASE64_STANDARD.encode(&geometry.bytes));
    let mut root = document(scene, &geometry);
    root["buffers"][0]["uri"] = json!(uri);
    Ok(format!("{root:#}\n").into_bytes())
}

/// Returns the content of a `.glb` file: a header, a JSON chunk and a binary chunk, both padded to four bytes.
fn binary(scene: &Scene) -> Result<Vec<u8>, Error> {
    let geometry = Geometry::of(scene)?;
    let mut text = document(scene, &geometry).to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let mut numbers = geometry.bytes;
    numbers.resize(numbers.len().next_multiple_of(4), 0);

    let mut file = Vec::with_capacity(28 + text.len() + numbers.len());
    file.extend(b"glTF");
    file.extend(2u32.to_le_bytes());
    file.extend((28 + text.len() as u32 + numbers.len() as u32).to_le_bytes());
    for (kind, chunk) in [(b"JSON", text), (b"BIN\0", numbers)] {
        file.extend((chunk.len() as u32).to_le_bytes());
        file.extend(kind);
        file.extend(chunk);
    }
    Ok(file)
}

/// Positions and indices as bytes, and the glTF objects that describe them.
struct Geometry {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
    primitives: Vec<Value>,
}

impl Geometry {
    fn of(scene: &Scene) -> Result<Self, Error> {
        let mut g =
            Self { bytes: Vec::new(), views: Vec::new(), accessors: Vec::new(), primitives: Vec::new() };
        g.add_positions(scene)?;
        for material in (0..scene.materials().len()).map(MaterialId::new) {
            let indices: Vec<u32> = scene
                .triangles()
                .iter()
                .filter(|t| t.material == material)
                .flat_map(|t| t.vertices.map(|v| v.0))
                .collect();
            if !indices.is_empty() {
                let accessor = g.add_indices(&indices, scene.vertices().len());
                g.primitives.push(json!({
                    "attributes": { "POSITION": 0 },
                    "indices": accessor,
                    "material": material.0,
                }));
            }
        }
        Ok(g)
    }

    fn add_positions(&mut self, scene: &Scene) -> Result<(), Error> {
        let (mut min, mut max) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
        for (vertex, position) in scene.vertices().iter().enumerate() {
            let single = position.as_vec3().to_array();
            if single.iter().any(|x| !x.is_finite()) {
                return Err(Error::Position { vertex, position: position.to_array() });
            }
            for axis in 0..3 {
                min[axis] = min[axis].min(single[axis]);
                max[axis] = max[axis].max(single[axis]);
                self.bytes.extend(single[axis].to_le_bytes());
            }
        }
        self.add_view(0, ARRAY_BUFFER);
        self.accessors.push(json!({
            "bufferView": 0,
            "componentType": FLOAT,
            "count": scene.vertices().len(),
            "type": "VEC3",
            "min": min,
            "max": max,
        }));
        Ok(())
    }

    /// Adds the vertex indices of one primitive and returns the index of their accessor.
    fn add_indices(&mut self, indices: &[u32], vertices: usize) -> usize {
        let start = self.bytes.len();
        // The largest value of an index type is the primitive restart value, which is not a valid index.
        let component = if vertices <= usize::from(u16::MAX) {
            self.bytes.extend(indices.iter().flat_map(|&i| (i as u16).to_le_bytes()));
            UNSIGNED_SHORT
        } else {
            self.bytes.extend(indices.iter().flat_map(|i| i.to_le_bytes()));
            UNSIGNED_INT
        };
        let view = self.add_view(start, ELEMENT_ARRAY_BUFFER);
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.accessors.push(json!({
            "bufferView": view,
            "componentType": component,
            "count": indices.len(),
            "type": "SCALAR",
        }));
        self.accessors.len() - 1
    }

    fn add_view(&mut self, start: usize, target: u32) -> usize {
        self.views.push(json!({
            "buffer": 0,
            "byteOffset": start,
            "byteLength": self.bytes.len() - start,
            "target": target,
        }));
        self.views.len() - 1
    }
}

/// Returns the whole JSON document except the `uri` of the buffer.
fn document(scene: &Scene, geometry: &Geometry) -> Value {
    let mut nodes = vec![json!({ "mesh": 0, "name": "scene" })];
    nodes.extend(scene.cameras().iter().enumerate().map(|(i, c)| camera_node(c, i)));
    let mut root = json!({
        "asset": { "version": "2.0", "generator": "SIR" },
        "scene": 0,
        "scenes": [{ "nodes": (0..nodes.len()).collect::<Vec<_>>() }],
        "nodes": nodes,
        "meshes": [{ "primitives": geometry.primitives }],
        "materials": scene.materials().iter().map(material).collect::<Vec<_>>(),
        "accessors": geometry.accessors,
        "bufferViews": geometry.views,
        "buffers": [{ "byteLength": geometry.bytes.len() }],
    });
    if !scene.cameras().is_empty() {
        root["cameras"] = scene.cameras().iter().map(camera).collect();
    }
    if scene.materials().iter().any(|m| strength(m) > 1.0) {
        root["extensionsUsed"] = json!(["KHR_materials_emissive_strength"]);
    }
    root
}

/// Returns the emissive strength: the largest band of the emitted radiance, but at least one. Divided by it, the
/// radiance becomes a color.
fn strength(material: &Material) -> f32 {
    (material.exitance.max_element() / std::f64::consts::PI).max(1.0) as f32
}

fn material(material: &Material) -> Value {
    let alpha = material.opacity.factor as f32;
    let color = material.reflectance.as_vec3().extend(alpha).to_array().map(short);
    let mut value = json!({
        "name": material.name,
        "pbrMetallicRoughness": {
            "baseColorFactor": color,
            "metallicFactor": 0.0,
            "roughnessFactor": 1.0,
        },
        "doubleSided": material.sides == Sides::Both,
    });
    if alpha < 1.0 {
        value["alphaMode"] = json!("BLEND");
    }
    if material.exitance != DVec3::ZERO {
        let strength = strength(material);
        let radiance = material.exitance / std::f64::consts::PI;
        let factor = (radiance / f64::from(strength)).as_vec3().min(glam::Vec3::ONE);
        value["emissiveFactor"] = json!(factor.to_array().map(short));
        if strength > 1.0 {
            value["extensions"] =
                json!({ "KHR_materials_emissive_strength": { "emissiveStrength": short(strength) } });
        }
    }
    value
}

fn camera(camera: &Camera) -> Value {
    match camera.projection {
        Projection::Perspective { vertical_fov } => {
            let mut perspective = json!({ "yfov": short(vertical_fov as f32), "znear": NEAR });
            if let Some(aspect) = camera.aspect {
                perspective["aspectRatio"] = json!(short(aspect as f32));
            }
            json!({ "type": "perspective", "name": camera.name, "perspective": perspective })
        }
        Projection::Orthographic { height } => {
            let half = 0.5 * height;
            json!({
                "type": "orthographic",
                "name": camera.name,
                "orthographic": {
                    "xmag": short((half * camera.aspect.unwrap_or(1.0)) as f32),
                    "ymag": short(half as f32),
                    "znear": NEAR,
                    "zfar": 1e6,
                },
            })
        }
    }
}

/// Returns the node that places a camera. In its own frame, a camera looks along −z with +y up.
fn camera_node(camera: &Camera, index: usize) -> Value {
    let right = camera.forward.cross(camera.up).normalize();
    let up = right.cross(camera.forward).normalize();
    let rotation = DQuat::from_mat3(&DMat3::from_cols(right, up, -camera.forward)).normalize();
    json!({
        "camera": index,
        "name": camera.name,
        "translation": camera.eye.as_vec3().to_array().map(short),
        "rotation": rotation.as_quat().to_array().map(short),
    })
}

/// Returns the double with the shortest decimal form that rounds to this float: 0.1 instead of 0.10000000149011612.
fn short(x: f32) -> f64 {
    x.to_string().parse().unwrap_or(f64::from(x))
}
