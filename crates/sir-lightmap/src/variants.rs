//! Materials with lightmaps.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::{Value, json};

use crate::base::Base;
use crate::document::Document;
use crate::json::{list, object};
use crate::layout::Rectangle;

/// Extension of materials that refers to a lightmap.
const EXTENSION: &str = "MOZ_lightmap";
const UNLIT: &str = "KHR_materials_unlit";

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

/// Material of a primitive with a lightmap.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Variant {
    material: Option<usize>,
    /// Page and set of coordinates; `None` if the rectangle differs from node to node.
    lightmap: Option<(u32, u32)>,
    is_one_sided: bool,
}

/// Adds meshes and materials with lightmaps.
pub(crate) struct Lighter<'a> {
    textures: Vec<usize>,
    pages: &'a [PageImage],
    style: Style,
    /// Index of each variant of a material; those of new ones are counted from the end of the list.
    variants: BTreeMap<Variant, usize>,
}

impl<'a> Lighter<'a> {
    /// Creates it, with the indices of the textures of the pages.
    pub(crate) fn new(textures: Vec<usize>, pages: &'a [PageImage], style: Style) -> Self {
        Self { textures, pages, style, variants: BTreeMap::new() }
    }

    /// Returns the index of the texture of a page, and the factor from its values to irradiance as it is shown.
    pub(crate) fn texture(&self, page: u32) -> (usize, f64) {
        (self.textures[page as usize], self.pages[page as usize].intensity)
    }

    /// Returns a primitive with lightmap coordinates at a place, and with the material for it.
    pub(crate) fn primitive(
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
    pub(crate) fn place_mesh(
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
    pub(crate) fn finish(self, document: &mut Document) {
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
