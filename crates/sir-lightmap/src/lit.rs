//! The lit glTF: the document as its author made it, with lightmap coordinates, images and references to them.

use std::collections::{BTreeMap, BTreeSet};

use glam::{DAffine3, DVec2};
use serde_json::{Value, json};
use sir_geom::Side;

use crate::document::{Document, FLOAT, list, object};
use crate::error::LightmapError;
use crate::existing::LIGHTMAP_SET;
use crate::layout::{Layout, Rectangle, Sheet, Unfolded};
use crate::objects::{Objects, is_double_sided};

const CLAMP_TO_EDGE: u32 = 33_071;
const LINEAR: u32 = 9_729;

/// Extension of materials that refers to a lightmap.
const EXTENSION: &str = "MOZ_lightmap";
const UNLIT: &str = "KHR_materials_unlit";
const INSTANCING: &str = "EXT_mesh_gpu_instancing";

/// Image of a page, as the lit document has it.
pub(crate) struct PageImage {
    pub(crate) png: Vec<u8>,
    /// Factor from its linear values in `[0, 1]` to irradiance as it is shown.
    pub(crate) intensity: f64,
}

/// Use of the pages in a document.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Style {
    /// Beside the materials of the author. With `expand`, every instance has coordinates of its own.
    Lightmap { expand: bool },
    /// In place of the materials.
    Combined,
}

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

/// Material of a primitive with a lightmap.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Variant {
    material: Option<usize>,
    /// Page and set of coordinates; `None` if the rectangle differs from node to node.
    lightmap: Option<(u32, u32)>,
    is_one_sided: bool,
}

/// Adds the lightmap to the document, and returns where each instance has its light.
pub(crate) fn light(
    document: &mut Document,
    objects: &Objects,
    layout: &Layout,
    pages: &[PageImage],
    style: Style,
) -> Result<Vec<Lit>, LightmapError> {
    let textures = add_textures(document, pages);
    let mut lighter = Lighter { textures, pages, style, variants: BTreeMap::new() };
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
        let base = base_primitives(document, objects, number, &sheets)?;
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
                extras.insert(
                    "lightmap".into(),
                    json!({ "page": rectangle.page, "uv_rect": uv_rect, "texCoord": set }),
                );
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

/// A primitive of a sheet before it has lightmap coordinates.
struct Base<'a> {
    sheet: &'a Sheet,
    unfolded: &'a Unfolded,
    json: Value,
    /// True if it is one side of a surface that has two.
    is_one_sided: bool,
}

/// Returns the primitives of all sheets of a mesh, with vertices split at the edges of charts.
fn base_primitives<'a>(
    document: &mut Document,
    objects: &Objects,
    number: usize,
    sheets: &[&'a Sheet],
) -> Result<Vec<Base<'a>>, LightmapError> {
    let mesh = &objects.meshes[number];
    let source = list(&document.json["meshes"][mesh.index], "primitives").to_vec();
    let mut base = Vec::new();
    for (i, json) in source.iter().enumerate() {
        let is_split = sheets.len() > 1 && mesh.primitives[i].is_two_sided;
        for &sheet in sheets {
            let unfolded = &sheet.primitives[i];
            let mut json = json.clone();
            if unfolded.triangles.is_empty() {
                // Points and lines stay as they are.
                if sheet.side == Side::Front {
                    base.push(Base { sheet, unfolded, json, is_one_sided: false });
                }
                continue;
            }
            let is_back = sheet.side == Side::Back;
            split_vertices(document, &mut json, &unfolded.origin, is_back)?;
            let corners = |&[a, b, c]: &[u32; 3]| if is_back { [a, c, b] } else { [a, b, c] };
            let indices = unfolded.triangles.iter().flat_map(corners);
            let indices = document.add_indices(indices);
            let members = object(&mut json);
            members.insert("indices".into(), json!(indices));
            members.remove("mode");
            let is_one_sided = is_split && is_double_sided(document, &json);
            base.push(Base { sheet, unfolded, json, is_one_sided });
        }
    }
    Ok(base)
}

/// Replaces the attributes of a primitive by copies with these elements. For the back of a surface, normals are turned.
fn split_vertices(
    document: &mut Document,
    primitive: &mut Value,
    origin: &[u32],
    is_back: bool,
) -> Result<(), LightmapError> {
    let replace = |document: &mut Document, attributes: &mut Value| -> Result<(), LightmapError> {
        for (name, accessor) in object(attributes).iter_mut() {
            let Some(index) = accessor.as_u64().map(|index| index as usize) else { continue };
            let count = document.json["accessors"][index]["count"].as_u64().unwrap_or(0);
            let is_same =
                origin.len() as u64 == count && origin.iter().zip(0u32..).all(|(&origin, i)| origin == i);
            let is_turned = is_back && (name == "NORMAL" || name == "TANGENT");
            if is_same && !is_turned {
                continue;
            }
            let copy = document.add_selection(index, origin)?;
            if is_turned {
                document.negate(copy, if name == "NORMAL" { 0..3 } else { 3..4 });
            }
            *accessor = json!(copy);
        }
        Ok(())
    };
    replace(document, &mut primitive["attributes"])?;
    if let Some(targets) = primitive.get_mut("targets").and_then(Value::as_array_mut) {
        for target in targets {
            replace(document, target)?;
        }
    }
    Ok(())
}

/// Adds meshes and materials with lightmaps.
struct Lighter<'a> {
    textures: Vec<usize>,
    pages: &'a [PageImage],
    style: Style,
    /// Index of each variant of a material; those of new ones are counted from the end of the list.
    variants: BTreeMap<Variant, usize>,
}

impl Lighter<'_> {
    /// Returns a primitive with lightmap coordinates at a place, and with the material for it.
    fn primitive(
        &mut self,
        document: &mut Document,
        base: &Base<'_>,
        place: Rectangle,
        set: u32,
        lightmap: Option<(u32, u32)>,
    ) -> Value {
        let Base { unfolded, is_one_sided, .. } = *base;
        let mut json = base.json.clone();
        if unfolded.triangles.is_empty() {
            return json;
        }
        let coordinates: Vec<[f32; 2]> =
            unfolded.coordinates.iter().map(|&uv| place.place(uv).as_vec2().to_array()).collect();
        let accessor = document.add_vectors(&coordinates, false);
        if self.style == Style::Combined {
            let unused = |name: &str| name.starts_with("TEXCOORD_") || name.starts_with("COLOR_");
            object(&mut json["attributes"]).retain(|name, _| !unused(name));
        }
        for other in 0..set {
            // Sets must be numbered without gaps.
            let name = format!("TEXCOORD_{other}");
            if json["attributes"].get(&name).is_none() {
                json["attributes"][name] = json!(accessor);
            }
        }
        json["attributes"][format!("TEXCOORD_{set}")] = json!(accessor);
        let material = json["material"].as_u64().map(|index| index as usize);
        json["material"] = json!(self.material(document, Variant { material, lightmap, is_one_sided }));
        json
    }

    /// Returns the index of a variant of a material, which is added on first use.
    fn material(&mut self, document: &mut Document, variant: Variant) -> usize {
        if let Some(&index) = self.variants.get(&variant) {
            return index;
        }
        let mut json = variant.material.map_or_else(
            // The reader of scenes takes it for gray, too.
            || json!({ "pbrMetallicRoughness": { "baseColorFactor": [0.5, 0.5, 0.5, 1.0], "metallicFactor": 0.0 } }),
            |index| document.json["materials"][index].clone(),
        );
        if variant.is_one_sided {
            object(&mut json).remove("doubleSided");
        }
        if let (Some((page, _)), Style::Combined) = (variant.lightmap, self.style) {
            json = unlit(&json, self.textures[page as usize]);
            document.use_extension(UNLIT);
        } else if let Some((page, set)) = variant.lightmap {
            let page = page as usize;
            object(&mut json).entry("extensions").or_insert_with(|| json!({}));
            json["extensions"][EXTENSION] = json!({
                "index": self.textures[page], "texCoord": set, "intensity": self.pages[page].intensity,
            });
            document.use_extension(EXTENSION);
        }
        let index = document.add("materials", json);
        self.variants.insert(variant, index);
        index
    }

    /// Adds a mesh with these primitives, or puts them into the mesh of the source.
    fn place_mesh(
        &mut self,
        document: &mut Document,
        source: usize,
        primitives: Vec<Value>,
        can_replace: bool,
    ) -> usize {
        let meshes = document.list_mut("meshes");
        if can_replace {
            meshes[source]["primitives"] = json!(primitives);
            return source;
        }
        let mut mesh = meshes[source].clone();
        mesh["primitives"] = json!(primitives);
        meshes.push(mesh);
        meshes.len() - 1
    }

    /// Puts the variants of materials in the place of the materials that nothing else uses.
    fn finish(self, document: &mut Document) {
        let mut of_source: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for (variant, &index) in &self.variants {
            if let Some(source) = variant.material {
                of_source.entry(source).or_default().push(index);
            }
        }
        let mut used: BTreeSet<u64> = BTreeSet::new();
        for primitive in list(&document.json, "meshes").iter().flat_map(|mesh| list(mesh, "primitives")) {
            used.extend(primitive["material"].as_u64());
            // Variants of materials that the file itself offers.
            collect_members(&primitive["extensions"], "material", &mut used);
        }
        let count = list(&document.json, "materials").len();
        let mut target: Vec<usize> = (0..count).collect();
        for (&source, variants) in &of_source {
            if let (false, Some(&first)) = (used.contains(&(source as u64)), variants.first()) {
                target[first] = source;
            }
        }
        // New materials close the gaps.
        let materials = document.list_mut("materials");
        let mut next = 0;
        let mut kept = Vec::with_capacity(materials.len());
        let added: BTreeSet<usize> = self.variants.values().copied().collect();
        let first_new = added.first().copied().unwrap_or(count);
        for (i, material) in std::mem::take(materials).into_iter().enumerate() {
            if i < first_new {
                kept.push(material);
                next += 1;
            } else if target[i] != i {
                let place = target[i];
                kept[place] = material;
            } else {
                target[i] = next;
                kept.push(material);
                next += 1;
            }
        }
        *materials = kept;
        for mesh in document.list_mut("meshes") {
            for primitive in mesh["primitives"].as_array_mut().into_iter().flatten() {
                if let Some(index) = primitive["material"].as_u64() {
                    primitive["material"] = json!(target[index as usize]);
                }
            }
        }
    }
}

/// Returns an unlit material with the transparency and the sides of another one, and a texture as its color.
fn unlit(material: &Value, texture: usize) -> Value {
    let mut json = json!({
        "pbrMetallicRoughness": { "baseColorTexture": { "index": texture }, "metallicFactor": 0.0 },
        "extensions": { UNLIT: {} },
    });
    for name in ["name", "alphaMode", "alphaCutoff", "doubleSided", "extras"] {
        if let Some(value) = material.get(name) {
            json[name] = value.clone();
        }
    }
    if json["alphaMode"] == "MASK" {
        // Texels have the share of the surface that is left.
        json["alphaCutoff"] = json!(0.5);
    }
    json
}

/// Collects the numbers of all members with a name, at any depth.
fn collect_members(value: &Value, name: &str, found: &mut BTreeSet<u64>) {
    match value {
        Value::Object(members) => {
            found.extend(members.get(name).and_then(Value::as_u64));
            members.values().for_each(|member| collect_members(member, name, found));
        }
        Value::Array(elements) => elements.iter().for_each(|element| collect_members(element, name, found)),
        _ => {}
    }
}

impl Document {
    /// Changes the sign of some components of an accessor that was added and has a view of its own.
    fn negate(&mut self, accessor: usize, components: std::ops::Range<usize>) {
        let of = &self.json["accessors"][accessor];
        let (component, count) =
            (of["componentType"].as_u64().unwrap_or(0), of["count"].as_u64().unwrap_or(0));
        let Some(view) = of["bufferView"].as_u64() else { return };
        let bytes = self.view_mut(view as usize);
        let stride = bytes.len() / (count as usize).max(1);
        for element in bytes.chunks_exact_mut(stride.max(1)) {
            for c in components.clone() {
                match component {
                    x if x == u64::from(FLOAT) => {
                        if let Some(sign) = element.get_mut(4 * c + 3) {
                            *sign ^= 0x80;
                        }
                    }
                    5122 => {
                        if let Some([a, b]) = element.get_mut(2 * c..2 * c + 2) {
                            let negative = i16::from_le_bytes([*a, *b]).saturating_neg();
                            [*a, *b] = negative.to_le_bytes();
                        }
                    }
                    5120 => {
                        if let Some(byte) = element.get_mut(c) {
                            *byte = (*byte as i8).saturating_neg() as u8;
                        }
                    }
                    _ => {}
                }
            }
        }
    }
}
