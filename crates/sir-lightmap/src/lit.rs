//! The lit glTF: the document as its author made it, with lightmap coordinates, images and references to them.

use std::collections::{BTreeMap, BTreeSet};

use glam::{DAffine3, DVec2};
use serde_json::{Value, json};
use sir_geom::Side;

use crate::base::base_primitives;
use crate::document::Document;
use crate::error::LightmapError;
use crate::existing::LIGHTMAP_SET;
use crate::json::{list, object};
use crate::layout::{Layout, Rectangle, Sheet};
use crate::objects::Objects;
use crate::variants::{Lighter, PageImage, Style};

const CLAMP_TO_EDGE: u32 = 33_071;
const LINEAR: u32 = 9_729;

const INSTANCING: &str = "EXT_mesh_gpu_instancing";

/// Where an instance of a mesh has its light, for the manifest.
#[derive(Clone, Debug)]
pub(crate) struct Lit {
    pub(crate) node: usize,
    /// Index of the mesh in the lit document.
    pub(crate) mesh: usize,
    /// Number of the instance among those of its node in the source.
    pub(crate) of_node: u32,
    pub(crate) page: u32,
    /// Place of the coordinates on the page: corner and size.
    pub(crate) uv_rect: [f64; 4],
    /// Set of texture coordinates.
    pub(crate) set: u32,
    /// True if the layout is that of the file.
    pub(crate) is_existing: bool,
}

/// Adds the lightmap to the document, and returns where each instance has its light. `is_split` is true if the sides of
/// two-sided surfaces have texels of their own.
pub(crate) fn light(
    document: &mut Document,
    objects: &Objects,
    layout: &Layout,
    pages: &[PageImage],
    style: Style,
    is_split: bool,
) -> Result<Vec<Lit>, LightmapError> {
    let textures = add_textures(document, pages);
    let mut lighter = Lighter::new(textures, pages, style);
    let expand = style != Style::Lightmap { expand: false };
    let mut lit = Vec::new();
    let shared = shared_meshes(document, objects);
    let nodes = expand_instances(document, objects)?;
    for (number, mesh) in objects.meshes.iter().enumerate() {
        let sheets: Vec<&Sheet> =
            layout.of_mesh[number].iter().flatten().map(|&sheet| &layout.sheets[sheet]).collect();
        let Some(&front) = sheets.first() else { continue };
        let set = match style {
            Style::Lightmap { .. } => free_set(document, mesh.index, front.existing),
            Style::Combined => 0,
        };
        // Vertices are the same in all copies of the mesh; only the coordinates differ.
        let base = base_primitives(document, objects, number, &sheets, is_split)?;
        let mut is_first = true;
        let is_own = expand || sheets.len() > 1 || front.instances.len() == 1;
        let mut common = None;
        for &instance in &front.instances {
            let Some(rectangle) = layout.rectangle(instance, Side::Front) else { continue };
            let of = &objects.instances[instance];
            let node = nodes.get(&instance).copied().unwrap_or(of.node);
            let index = match common {
                Some(index) if !is_own => index,
                _ => {
                    let places = |sheet: &Sheet| match is_own {
                        true => layout.rectangle(instance, sheet.side),
                        false => Some(Rectangle::whole(0)),
                    };
                    let lightmap = is_own.then_some((rectangle.page, set));
                    let mut primitives = Vec::with_capacity(base.len());
                    for of in &base {
                        let place = places(of.sheet).unwrap_or(Rectangle::whole(0));
                        primitives.push(lighter.primitive(document, of, place, set, lightmap));
                    }
                    // The first one takes the place of the mesh, unless a node that is not lit uses it, too.
                    let can_replace = is_first && !shared.contains(&mesh.index);
                    is_first = false;
                    lighter.place_mesh(document, mesh.index, primitives, can_replace)
                }
            };
            common = Some(index);
            let uv_rect = match is_own {
                true => [0.0, 0.0, 1.0, 1.0],
                false => {
                    let DVec2 { x, y } = rectangle.min;
                    let size = rectangle.max - rectangle.min;
                    [x, y, size.x, size.y]
                }
            };
            let node_json = &mut document.list_mut("nodes")[node];
            node_json["mesh"] = json!(index);
            let extras = object(node_json).entry("extras").or_insert_with(|| json!({}));
            if let Some(extras) = extras.as_object_mut() {
                let (index, intensity) = lighter.texture(rectangle.page);
                let place = json!({
                    "page": rectangle.page, "uv_rect": uv_rect, "texCoord": set,
                    "index": index, "intensity": intensity,
                });
                extras.insert("lightmap".into(), place);
            }
            let page = rectangle.page;
            let (is_existing, of_node) = (front.existing.is_some(), of.of_node);
            lit.push(Lit { node, mesh: index, of_node, page, uv_rect, set, is_existing });
        }
    }
    lighter.finish(document);
    Ok(lit)
}

/// Adds the images of the pages as textures, and returns their indices.
fn add_textures(document: &mut Document, pages: &[PageImage]) -> Vec<usize> {
    let sampler = document.add(
        "samplers",
        json!({ "magFilter": LINEAR, "minFilter": LINEAR, "wrapS": CLAMP_TO_EDGE, "wrapT": CLAMP_TO_EDGE }),
    );
    let texture = |(i, page): (usize, &PageImage)| {
        let name = format!("lightmap {i}");
        let image = document.add_png(&name, page.png.clone());
        document.add("textures", json!({ "name": name, "source": image, "sampler": sampler }))
    };
    pages.iter().enumerate().map(texture).collect()
}

/// Returns the meshes that nodes without light use, too, because they are hidden or not in the scene.
fn shared_meshes(document: &Document, objects: &Objects) -> BTreeSet<usize> {
    let lit: BTreeSet<usize> = objects.instances.iter().map(|instance| instance.node).collect();
    let nodes = list(&document.json, "nodes").iter().enumerate();
    let others = nodes.filter(|(i, _)| !lit.contains(i)).filter_map(|(_, node)| node["mesh"].as_u64());
    others.map(|mesh| mesh as usize).collect()
}

/// Replaces instances of nodes (`EXT_mesh_gpu_instancing`) by nodes of their own. Returns the node of each.
fn expand_instances(
    document: &mut Document,
    objects: &Objects,
) -> Result<BTreeMap<usize, usize>, LightmapError> {
    let mut nodes = BTreeMap::new();
    let instanced: BTreeSet<usize> = list(&document.json, "nodes")
        .iter()
        .enumerate()
        .filter(|(_, node)| node["extensions"].get(INSTANCING).is_some())
        .map(|(i, _)| i)
        .collect();
    for &node in &instanced {
        let transforms = match document.file() {
            Some(file) => file.instance_transforms(node)?,
            None => Vec::new(),
        };
        let json = document.json["nodes"][node].clone();
        let mut children = list(&json, "children").to_vec();
        for (number, instance) in objects.instances.iter().enumerate().filter(|(_, i)| i.node == node) {
            let matrix = transforms.get(instance.of_node as usize).copied().unwrap_or(DAffine3::IDENTITY);
            let mut child = json!({ "mesh": json["mesh"] });
            if let Some(name) = json["name"].as_str() {
                child["name"] = json!(format!("{name} {}", instance.of_node));
            }
            if matrix != DAffine3::IDENTITY {
                child["matrix"] = json!(glam::DMat4::from(matrix).to_cols_array().as_slice());
            }
            let child = document.add("nodes", child);
            children.push(json!(child));
            nodes.insert(number, child);
        }
        let json = object(&mut document.list_mut("nodes")[node]);
        json.remove("mesh");
        if !children.is_empty() {
            json.insert("children".into(), json!(children));
        }
        if let Some(extensions) = json.get_mut("extensions").and_then(Value::as_object_mut) {
            extensions.remove(INSTANCING);
            if extensions.is_empty() {
                json.remove("extensions");
            }
        }
    }
    if !instanced.is_empty() {
        document.forget_extension(INSTANCING);
    }
    Ok(nodes)
}

/// Returns the set of coordinates for the lightmap of a mesh: that of its layout, or the first from set 1 on that no texture
/// of its materials uses.
fn free_set(document: &Document, mesh: usize, existing: Option<u32>) -> u32 {
    if let Some(set) = existing {
        return set;
    }
    let mut used = BTreeSet::new();
    for primitive in list(&document.json["meshes"][mesh], "primitives") {
        if let Some(material) = primitive["material"].as_u64() {
            collect_sets(&document.json["materials"][material as usize], &mut used);
        }
    }
    (LIGHTMAP_SET..).find(|set| !used.contains(&u64::from(*set))).unwrap_or(LIGHTMAP_SET)
}

/// Collects the sets of coordinates that a material uses.
fn collect_sets(value: &Value, used: &mut BTreeSet<u64>) {
    match value {
        Value::Object(members) => {
            used.extend(members.get("texCoord").and_then(Value::as_u64));
            members.iter().filter(|(name, _)| *name != "extras").for_each(|(_, v)| collect_sets(v, used));
        }
        Value::Array(elements) => elements.iter().for_each(|element| collect_sets(element, used)),
        _ => {}
    }
}
