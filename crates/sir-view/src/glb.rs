//! The lit scene as one GLB file, for viewers and modeling programs.
//!
//! The format is glTF 2.0 (Khronos 2021). The light is in the vertex colors, and `KHR_materials_unlit` tells viewers to
//! show them unchanged. The attribute `_RADIOSITY` holds the unclamped radiosity.

use std::io::Write;
use std::path::Path;

use glam::{DQuat, DVec3, Vec3};
use serde_json::{Value, json};
use sir_geom::{Barycentric, Camera, Projection, TriangleId, median_extent};
use sir_mesh::PatchId;

use crate::atomic_file::write_atomically;
use crate::camera_rays::camera_axes;
use crate::display::DisplayMesh;
use crate::error::ViewError;
use crate::exposure::Exposure;
use crate::tone::{rgb, tone_map};

const ARRAY_BUFFER: u32 = 34_962;
const ELEMENT_ARRAY_BUFFER: u32 = 34_963;
const FLOAT: u32 = 5126;
const UNSIGNED_INT: u32 = 5125;

/// Writes the display mesh and the given cameras as GLB, with one primitive per material, under its name.
///
/// The vertices have two attributes:
///
/// * `COLOR_0`: linear Rec. 709 in `[0, 1]`, after exposure and tone mapping;
/// * `_RADIOSITY`: radiosity `B` \[W/m²\] in three linear bands, as computed.
///
/// Textures are baked into the vertex colors, each the mean over about one patch. Surfaces with gaps are written
/// without the gaps, except that patches that are all gap are left out. `up` is the scene direction that becomes +y, as
/// glTF requires: the root node rotates everything, and the positions in the file are those of the scene.
///
/// # Errors
///
/// If the file cannot be written or would exceed 4 GiB.
pub fn write_glb(
    path: &Path,
    display: &DisplayMesh<'_>,
    exposure: Exposure,
    cameras: &[Camera],
    up: DVec3,
) -> Result<(), ViewError> {
    let factor = exposure.factor_for_mesh(display);
    let mut file = Contents::default();
    file.add_mesh(display, factor);
    let near = 1e-3 * median_extent(display.scene.vertices()).1;
    file.add_cameras(cameras, near);
    let json = file.json(up);
    write_glb_file(path, &json, &file.binary)
}

/// Returns the point of a patch that is nearest to a position in its plane.
fn nearest_point(
    display: &DisplayMesh<'_>,
    (triangle, patch): (TriangleId, PatchId),
    position: DVec3,
) -> (TriangleId, Barycentric) {
    let mut nearest = (f64::INFINITY, triangle, Barycentric { v: 0.0, w: 0.0 });
    for piece in display.mesh.pieces(triangle, patch) {
        let corners = display.scene.corners(piece.triangle);
        let point = nearest_in_triangle(corners, position);
        let distance = point.point(corners).distance_squared(position);
        if distance < nearest.0 {
            nearest = (distance, piece.triangle, point);
        }
    }
    (nearest.1, nearest.2)
}

/// Returns the barycentric coordinates of a position on a triangle, clamped to the triangle.
fn nearest_in_triangle([a, b, c]: [DVec3; 3], position: DVec3) -> Barycentric {
    let normal = (b - a).cross(c - a);
    let v = (position - a).cross(c - a).dot(normal) / normal.length_squared();
    let w = (b - a).cross(position - a).dot(normal) / normal.length_squared();
    let v = v.clamp(0.0, 1.0);
    Barycentric { v, w: w.clamp(0.0, 1.0 - v) }
}

#[derive(Default)]
struct Contents {
    binary: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
    materials: Vec<Value>,
    primitives: Vec<Value>,
    cameras: Vec<Value>,
    camera_nodes: Vec<Value>,
}

impl Contents {
    fn add_mesh(&mut self, display: &DisplayMesh<'_>, factor: f64) {
        let scene = display.scene;
        let mut order: Vec<TriangleId> = scene.triangle_ids().collect();
        order.sort_by_key(|&t| scene.triangle(t).material);
        // Last owner of each vertex, and the number under which it was written. The owner is a material, or a single
        // triangle if it is textured, because its neighbor may have another color at a shared vertex.
        let mut numbers = vec![None; display.vertices().len()];
        for of_material in order.chunk_by(|&s, &t| scene.triangle(s).material == scene.triangle(t).material) {
            let material = scene.material(of_material[0]);
            let material_index = self.materials.len() as u32;
            let (mut positions, mut colors, mut radiosities) = (Vec::new(), Vec::new(), Vec::new());
            let mut indices: Vec<u32> = Vec::new();
            for piece in of_material.iter().flat_map(|&t| display.pieces_of(t)) {
                let t = piece.triangle;
                let patch = display.mesh.patch_of_side(t, piece.id);
                if display.mesh.covered_area(t, patch) == 0.0 {
                    continue;
                }
                let is_varied = display.mesh.is_varied(t);
                let owner = (material_index, is_varied.then_some(t));
                let width = display.mesh.patch_area(t, patch).sqrt();
                for &v in piece.triangles.iter().flatten() {
                    let number = match numbers[v as usize] {
                        Some((last, number)) if last == owner => number,
                        _ => {
                            let vertex = display.vertices()[v as usize];
                            let e = rgb(&vertex.irradiance);
                            let position = display.positions()[vertex.position as usize];
                            let b = if is_varied {
                                let (t, point) = nearest_point(display, (t, patch), position);
                                display.radiosity_at(t, point, piece.side, e, width)
                            } else {
                                display.radiosity_of(&piece, e)
                            };
                            positions.push(position.as_vec3());
                            colors.push(tone_map(factor / std::f64::consts::PI * b).as_vec3());
                            radiosities.push(b.as_vec3());
                            numbers[v as usize] = Some((owner, positions.len() as u32 - 1));
                            positions.len() as u32 - 1
                        }
                    };
                    indices.push(number);
                }
            }
            if indices.is_empty() {
                continue;
            }
            let primitive = json!({
                "attributes": {
                    "POSITION": self.add_vectors(&positions, true),
                    "COLOR_0": self.add_vectors(&colors, false),
                    "_RADIOSITY": self.add_vectors(&radiosities, false),
                },
                "indices": self.add_indices(&indices),
                "material": material_index,
            });
            self.primitives.push(primitive);
            let mut json = json!({
                "pbrMetallicRoughness": { "metallicFactor": 0.0 },
                "extensions": { "KHR_materials_unlit": {} },
            });
            if !material.name.is_empty() {
                json["name"] = json!(material.name);
            }
            self.materials.push(json);
        }
    }

    fn add_view(&mut self, target: u32, bytes: impl Iterator<Item = [u8; 4]>) -> usize {
        let start = self.binary.len();
        self.binary.extend(bytes.flatten());
        self.views.push(json!({
            "buffer": 0, "byteOffset": start, "byteLength": self.binary.len() - start, "target": target,
        }));
        self.views.len() - 1
    }

    fn add_accessor(&mut self, accessor: Value) -> usize {
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    fn add_vectors(&mut self, vectors: &[Vec3], with_bounds: bool) -> usize {
        let view =
            self.add_view(ARRAY_BUFFER, vectors.iter().flat_map(|v| v.to_array().map(f32::to_le_bytes)));
        let mut accessor =
            json!({ "bufferView": view, "componentType": FLOAT, "count": vectors.len(), "type": "VEC3" });
        if with_bounds {
            let low = vectors.iter().copied().fold(Vec3::INFINITY, Vec3::min);
            let high = vectors.iter().copied().fold(Vec3::NEG_INFINITY, Vec3::max);
            accessor["min"] = json!(low.to_array());
            accessor["max"] = json!(high.to_array());
        }
        self.add_accessor(accessor)
    }

    fn add_indices(&mut self, indices: &[u32]) -> usize {
        let view = self.add_view(ELEMENT_ARRAY_BUFFER, indices.iter().map(|i| i.to_le_bytes()));
        self.add_accessor(json!({
            "bufferView": view, "componentType": UNSIGNED_INT, "count": indices.len(), "type": "SCALAR",
        }))
    }

    fn add_cameras(&mut self, cameras: &[Camera], near: f64) {
        for camera in cameras {
            let mut json = match camera.projection {
                Projection::Perspective { vertical_fov } => {
                    let mut lens = json!({ "yfov": vertical_fov, "znear": near });
                    if let Some(aspect) = camera.aspect {
                        lens["aspectRatio"] = json!(aspect);
                    }
                    json!({ "type": "perspective", "perspective": lens })
                }
                Projection::Orthographic { height } => {
                    let half = 0.5 * height;
                    json!({ "type": "orthographic", "orthographic": {
                        "xmag": half * camera.aspect.unwrap_or(1.0), "ymag": half,
                        "znear": near, "zfar": 1e4 * near,
                    } })
                }
            };
            // The axes of a glTF camera are right, up and backward.
            let (right, up) = camera_axes(camera);
            let axes = [right, up, -camera.forward, camera.eye].map(|axis| axis.to_array());
            let matrix: Vec<f64> =
                axes.iter().zip([0.0, 0.0, 0.0, 1.0]).flat_map(|(&[x, y, z], w)| [x, y, z, w]).collect();
            let mut node = json!({ "camera": self.cameras.len(), "matrix": matrix });
            if !camera.name.is_empty() {
                json["name"] = json!(camera.name);
                node["name"] = json!(camera.name);
            }
            self.cameras.push(json);
            self.camera_nodes.push(node);
        }
    }

    fn json(&self, up: DVec3) -> Value {
        // Node 0 holds the mesh and rotates everything; the nodes after it are the cameras.
        let mut root = json!({ "name": "SIR", "mesh": 0 });
        let turn = DQuat::from_rotation_arc(up.normalize_or(DVec3::Y), DVec3::Y);
        if turn != DQuat::IDENTITY {
            root["rotation"] = json!(turn.to_array());
        }
        if !self.camera_nodes.is_empty() {
            root["children"] = (1..=self.camera_nodes.len()).collect();
        }
        let nodes: Vec<Value> = std::iter::once(root).chain(self.camera_nodes.iter().cloned()).collect();
        let mut json = json!({
            "asset": { "version": "2.0", "generator": concat!("SIR ", env!("CARGO_PKG_VERSION")) },
            "extensionsUsed": ["KHR_materials_unlit"],
            "scene": 0,
            "scenes": [{ "nodes": [0] }],
            "nodes": nodes,
            "meshes": [{ "primitives": self.primitives }],
            "materials": self.materials,
            "accessors": self.accessors,
            "bufferViews": self.views,
            "buffers": [{ "byteLength": self.binary.len() }],
        });
        if !self.cameras.is_empty() {
            json["cameras"] = json!(self.cameras);
        }
        json
    }
}

/// Writes a GLB file with this JSON document and binary chunk.
///
/// # Errors
///
/// If the file cannot be written or would exceed 4 GiB.
pub fn write_glb_file(path: &Path, json: &Value, binary: &[u8]) -> Result<(), ViewError> {
    let mut text = json.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let total = 12 + 8 + text.len() as u64 + 8 + binary.len() as u64;
    let Ok(total) = u32::try_from(total) else {
        return Err(ViewError::TooLarge { path: path.to_owned(), bytes: total });
    };
    write_atomically(path, |file| {
        file.write_all(b"glTF")?;
        for word in [2, total, text.len() as u32] {
            file.write_all(&word.to_le_bytes())?;
        }
        file.write_all(b"JSON")?;
        file.write_all(&text)?;
        file.write_all(&(binary.len() as u32).to_le_bytes())?;
        file.write_all(b"BIN\0")?;
        file.write_all(binary)
    })
}
