//! Removes accessors and buffer views that nothing refers to.

use std::collections::BTreeSet;

use serde_json::{Value, json};

use crate::json::{array, list, object};

/// Extensions of which it is known where they refer to accessors and buffer views: nowhere, or where this file looks.
const KNOWN: [&str; 25] = [
    "EXT_mesh_gpu_instancing",
    "EXT_texture_avif",
    "EXT_texture_webp",
    "KHR_animation_pointer",
    "KHR_lights_punctual",
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_dispersion",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_iridescence",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_variants",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    "KHR_node_visibility",
    "KHR_texture_basisu",
    "KHR_texture_transform",
    "KHR_xmp_json_ld",
    "MOZ_lightmap",
    "MSFT_texture_dds",
];

/// Removes what nothing refers to, and renumbers the rest. Returns true for each buffer view that is kept. `None`, and
/// without effect, for documents with extensions that may refer to more.
pub(crate) fn compact(json: &mut Value) -> Option<Vec<bool>> {
    let is_known = |name: &Value| name.as_str().is_some_and(|name| KNOWN.contains(&name));
    if !list(json, "extensionsUsed").iter().all(is_known) {
        return None;
    }
    let accessors = renumber(json, "accessors", for_each_accessor);
    remove(json, "accessors", &accessors);
    let views = renumber(json, "bufferViews", for_each_view);
    remove(json, "bufferViews", &views);
    Some(views)
}

/// Visits all references to elements of a list.
type ForEach = fn(&mut Value, &mut dyn FnMut(&mut Value));

/// Gives the used elements of a list numbers without gaps, in all references. Returns true for each one that is used.
fn renumber(json: &mut Value, name: &str, for_each: ForEach) -> Vec<bool> {
    let mut used = BTreeSet::new();
    for_each(json, &mut |reference| used.extend(reference.as_u64()));
    let is_used: Vec<bool> = (0..list(json, name).len() as u64).map(|i| used.contains(&i)).collect();
    let mut next = 0u64;
    let numbers: Vec<u64> = is_used
        .iter()
        .map(|&is_used| {
            next += u64::from(is_used);
            next.saturating_sub(1)
        })
        .collect();
    for_each(json, &mut |reference| {
        if let Some(number) = reference.as_u64().and_then(|i| numbers.get(i as usize)) {
            *reference = json!(number);
        }
    });
    is_used
}

fn remove(json: &mut Value, name: &str, is_used: &[bool]) {
    if let Some(elements) = json.get_mut(name).and_then(Value::as_array_mut) {
        let mut flags = is_used.iter();
        elements.retain(|_| flags.next().copied().unwrap_or(true));
    }
}

/// Visits all references to accessors.
fn for_each_accessor(json: &mut Value, visit: &mut dyn FnMut(&mut Value)) {
    let mut all = |members: &mut Value| object(members).values_mut().for_each(&mut *visit);
    for primitive in elements(json, "meshes").flat_map(|mesh| elements(mesh, "primitives")) {
        all(&mut primitive["attributes"]);
        elements(primitive, "targets").for_each(&mut all);
    }
    for node in elements(json, "nodes") {
        let instancing = member(node, "extensions").and_then(|all| member(all, "EXT_mesh_gpu_instancing"));
        instancing.and_then(|instancing| member(instancing, "attributes")).into_iter().for_each(&mut all);
    }
    for primitive in elements(json, "meshes").flat_map(|mesh| elements(mesh, "primitives")) {
        member(primitive, "indices").into_iter().for_each(&mut *visit);
    }
    for sampler in elements(json, "animations").flat_map(|animation| elements(animation, "samplers")) {
        member(sampler, "input").into_iter().for_each(&mut *visit);
        member(sampler, "output").into_iter().for_each(&mut *visit);
    }
    for skin in elements(json, "skins") {
        member(skin, "inverseBindMatrices").into_iter().for_each(&mut *visit);
    }
}

/// Visits all references to buffer views.
fn for_each_view(json: &mut Value, visit: &mut dyn FnMut(&mut Value)) {
    for accessor in elements(json, "accessors") {
        member(accessor, "bufferView").into_iter().for_each(&mut *visit);
        if let Some(sparse) = member(accessor, "sparse") {
            for part in ["indices", "values"] {
                let part = member(sparse, part).and_then(|part| member(part, "bufferView"));
                part.into_iter().for_each(&mut *visit);
            }
        }
    }
    for image in elements(json, "images") {
        member(image, "bufferView").into_iter().for_each(&mut *visit);
    }
}

/// Returns the elements of a list; none if it is absent.
fn elements<'a>(json: &'a mut Value, name: &str) -> impl Iterator<Item = &'a mut Value> {
    json.get_mut(name).map(array).into_iter().flatten()
}

fn member<'a>(json: &'a mut Value, name: &str) -> Option<&'a mut Value> {
    json.get_mut(name).filter(|member| !member.is_null())
}
