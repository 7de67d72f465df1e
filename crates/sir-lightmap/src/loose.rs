//! Meshes for triangles that come from no glTF file: those of OBJ files, and panels of pipelines.

use std::collections::{BTreeMap, HashMap};

use glam::{DAffine3, DQuat, DVec3};
use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder};
use serde_json::{Value, json};
use sir_geom::{GroupId, MaterialId, Rgb, Scene, Sides, Texture, TextureMap, TriangleId, Wrap};

use crate::document::Document;
use crate::objects::{Instance, Mesh, Objects, Place, Primitive};

const CLAMP_TO_EDGE: u32 = 33_071;
const MIRRORED_REPEAT: u32 = 33_648;
const REPEAT: u32 = 10_497;

/// Adds the triangles of a scene that have no place in the document: one node with a mesh for each group, with one
/// primitive for each material. `scale` is the length of a unit of the document \[m\], and `up` the direction of the
/// scene that is up in the document, whose up is +y.
pub(crate) fn add(document: &mut Document, objects: &mut Objects, scene: &Scene, scale: f64, up: DVec3) {
    let mut groups: BTreeMap<GroupId, BTreeMap<MaterialId, Vec<TriangleId>>> = BTreeMap::new();
    for t in scene.triangle_ids() {
        if objects.places[t.index()].instance == u32::MAX {
            let triangle = scene.triangle(t);
            groups.entry(triangle.group).or_default().entry(triangle.material).or_default().push(t);
        }
    }
    let is_new = document.file().is_none();
    let mut materials = Materials::default();
    let mut nodes = Vec::new();
    for (group, of_materials) in groups {
        let name = &scene.groups()[group.index()];
        let mut mesh = Mesh { index: 0, name: name.clone(), primitives: Vec::new() };
        let (mut primitives, mut number) = (Vec::new(), 0);
        let instance = (objects.instances.len() + nodes.len()) as u32;
        for (material, triangles) in of_materials {
            for &t in &triangles {
                objects.places[t.index()] = Place { instance, triangle: number };
                number += 1;
            }
            let index = materials.add(document, scene, material);
            let (json, mut primitive) = primitive(document, scene, &triangles);
            primitive.is_two_sided = scene.materials()[material.index()].sides == Sides::Both;
            primitives.push(json.with("material", json!(index)));
            mesh.primitives.push(primitive);
        }
        mesh.index = document.add("meshes", json!({ "primitives": primitives }).named(name));
        let node = json!({ "mesh": mesh.index }).named(name);
        let to_world = DAffine3::IDENTITY;
        let area = mesh.area(&to_world);
        objects.meshes.push(mesh);
        nodes.push((node, Instance { mesh: objects.meshes.len() - 1, node: 0, of_node: 0, to_world, area }));
    }
    if nodes.is_empty() {
        return;
    }
    let mut children = Vec::new();
    for (node, instance) in nodes {
        let node = document.add("nodes", node);
        children.push(node);
        objects.instances.push(Instance { node, ..instance });
    }
    let mut root = json!({ "name": if is_new { "SIR" } else { "SIR panels" }, "children": children });
    let turn = DQuat::from_rotation_arc(up.normalize_or(DVec3::Y), DVec3::Y);
    if is_new && turn != DQuat::IDENTITY {
        root["rotation"] = json!(turn.to_array());
    }
    if !is_new && scale != 1.0 {
        root["scale"] = json!([1.0 / scale, 1.0 / scale, 1.0 / scale]);
    }
    document.add_root(root);
}

/// Returns the primitive with these triangles of one material.
fn primitive(document: &mut Document, scene: &Scene, triangles: &[TriangleId]) -> (Value, Primitive) {
    let coordinates = |t: TriangleId| {
        let material = scene.material(t);
        let maps = [material.reflectance_map.map(|color| color.map), material.opacity.map];
        let map = maps.into_iter().flatten().next().or(material.exitance_map.map(|color| color.map))?;
        scene.texture_on(t, &map).map(|(_, corners)| corners.map(|c| c.as_vec2().to_array()))
    };
    let has_coordinates = triangles.iter().any(|&t| coordinates(t).is_some());
    let corner = |i: usize| sir_geom::Barycentric { v: f64::from(i == 1), w: f64::from(i == 2) };
    let tint = |t: TriangleId, i: usize| {
        let (color, alpha) = scene.tint_at(t, corner(i)).unwrap_or((Rgb::ONE, 1.0));
        [color.x, color.y, color.z, alpha].map(|x| x as f32)
    };
    let has_tints = triangles.iter().any(|&t| scene.tint_at(t, corner(0)).is_some());
    // Vertices with equal values are one.
    let mut known = HashMap::new();
    let (mut positions, mut places, mut colors) = (Vec::new(), Vec::new(), Vec::new());
    let mut corners = Vec::with_capacity(triangles.len());
    for &t in triangles {
        let of = coordinates(t).unwrap_or_default();
        let vertices = scene.triangle(t).vertices;
        corners.push([0, 1, 2].map(|i| {
            let color = if has_tints { tint(t, i) } else { [1.0; 4] };
            let key = (vertices[i], of[i].map(f32::to_bits), color.map(f32::to_bits));
            *known.entry(key).or_insert_with(|| {
                positions.push(scene.vertices()[vertices[i].index()]);
                places.push(of[i]);
                colors.push(color);
                positions.len() as u32 - 1
            })
        }));
    }
    let single: Vec<[f32; 3]> = positions.iter().map(|p| p.as_vec3().to_array()).collect();
    let mut attributes = json!({ "POSITION": document.add_vectors(&single, true) });
    if has_coordinates {
        attributes["TEXCOORD_0"] = json!(document.add_vectors(&places, false));
    }
    if has_tints {
        attributes["COLOR_0"] = json!(document.add_vectors(&colors, false));
    }
    let indices = document.add_indices(corners.iter().flatten().copied());
    let positions = positions.iter().map(|p| p.to_array()).collect();
    let json = json!({ "attributes": attributes, "indices": indices });
    (json, Primitive { positions, triangles: corners, is_two_sided: false })
}

/// Materials and textures that were added.
#[derive(Default)]
struct Materials {
    materials: BTreeMap<MaterialId, usize>,
    images: BTreeMap<usize, usize>,
}

impl Materials {
    /// Returns the index of a material in the document, to which it is added on first use.
    fn add(&mut self, document: &mut Document, scene: &Scene, id: MaterialId) -> usize {
        if let Some(&index) = self.materials.get(&id) {
            return index;
        }
        let material = &scene.materials()[id.index()];
        let mut json = json!({ "pbrMetallicRoughness": { "metallicFactor": 0.0, "roughnessFactor": 1.0 } })
            .named(&material.name);
        let color = material.reflectance_map.map_or(material.reflectance, |color| color.factor);
        let alpha = material.opacity.factor;
        let pbr = &mut json["pbrMetallicRoughness"];
        pbr["baseColorFactor"] =
            json!([color.x.min(1.0), color.y.min(1.0), color.z.min(1.0), alpha.min(1.0)]);
        let base = material.reflectance_map.map(|color| color.map).or(material.opacity.map);
        if let Some(map) = base {
            pbr["baseColorTexture"] = json!({ "index": self.texture(document, scene, &map) });
        }
        // The radiance of glTF; above one with an extension.
        let emitted =
            material.exitance_map.map_or(material.exitance, |color| color.factor) / std::f64::consts::PI;
        let strength = emitted.max_element();
        if strength > 0.0 {
            json["emissiveFactor"] = json!((emitted / strength.max(1.0)).to_array());
            if let Some(color) = material.exitance_map {
                json["emissiveTexture"] = json!({ "index": self.texture(document, scene, &color.map) });
            }
            if strength > 1.0 {
                json["extensions"] =
                    json!({ "KHR_materials_emissive_strength": { "emissiveStrength": strength } });
                document.use_extension("KHR_materials_emissive_strength");
            }
        }
        if material.sides == Sides::Both {
            json["doubleSided"] = json!(true);
        }
        match material.opacity.cutoff {
            Some(cutoff) => {
                json["alphaMode"] = json!("MASK");
                json["alphaCutoff"] = json!(cutoff);
            }
            None if !material.opacity.is_full() => json["alphaMode"] = json!("BLEND"),
            None => {}
        }
        let index = document.add("materials", json);
        self.materials.insert(id, index);
        index
    }

    /// Adds a texture to the document, and returns its index.
    fn texture(&mut self, document: &mut Document, scene: &Scene, map: &TextureMap) -> usize {
        let number = map.texture.index();
        let image = match self.images.get(&number) {
            Some(&image) => image,
            None => {
                let image = document.add_png(&format!("texture {number}"), png(&scene.textures()[number]));
                self.images.insert(number, image);
                image
            }
        };
        let wrap = map.wrap.map(|wrap| match wrap {
            Wrap::Repeat => REPEAT,
            Wrap::Mirror => MIRRORED_REPEAT,
            Wrap::Clamp => CLAMP_TO_EDGE,
        });
        let sampler = document.add("samplers", json!({ "wrapS": wrap[0], "wrapT": wrap[1] }));
        document.add("textures", json!({ "source": image, "sampler": sampler }))
    }
}

/// Returns a texture as a PNG file.
fn png(texture: &Texture) -> Vec<u8> {
    let [width, height] = texture.size();
    let mut bytes = Vec::new();
    // Writing to memory cannot fail, and the size is that of the texels.
    let _ = PngEncoder::new(&mut bytes).write_image(
        texture.texels().as_flattened(),
        width,
        height,
        ExtendedColorType::Rgba8,
    );
    bytes
}

/// Members of JSON objects.
trait With {
    fn with(self, name: &str, value: Value) -> Self;
    fn named(self, name: &str) -> Self;
}

impl With for Value {
    /// Returns the object with another member.
    fn with(mut self, name: &str, value: Value) -> Self {
        self[name] = value;
        self
    }

    /// Returns the object with a name, unless it is empty.
    fn named(self, name: &str) -> Self {
        if name.is_empty() { self } else { self.with("name", json!(name)) }
    }
}
