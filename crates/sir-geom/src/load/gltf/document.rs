//! The JSON document of a glTF file.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use ::gltf::json::{Root, Value, deserialize};

use crate::load::error::LoadError;
use crate::load::files;
use crate::load::gltf::wording::plain;

/// Maximum length of a parser's message \[characters\], which may quote the file at length.
const MAX_MESSAGE_LENGTH: usize = 160;

/// Largest magnitude below which every whole number is a double.
const MAX_EXACT: f64 = 9_007_199_254_740_992.0;

/// Contents of the JSON document.
pub(super) struct Document {
    pub(super) root: Root,
    /// Number of animations, which are not read.
    pub(super) animations: usize,
    /// Names of all extensions that have an object somewhere.
    pub(super) extensions: BTreeSet<String>,
    /// Extensions of nodes that the crate `gltf` does not know, by node.
    pub(super) nodes: BTreeMap<usize, NodeExtensions>,
    /// Photometric files of lights (`EXT_lights_ies`).
    pub(super) profiles: Vec<LightProfile>,
    /// Extensions of textures, each of which has an image in another format, by texture.
    pub(super) textures: BTreeMap<usize, Vec<String>>,
}

/// Extensions of a node.
#[derive(Default)]
pub(super) struct NodeExtensions {
    /// True if the node and its descendants are not shown (`KHR_node_visibility`).
    pub(super) is_hidden: bool,
    /// Accessors by attribute (`EXT_mesh_gpu_instancing`).
    pub(super) instances: BTreeMap<String, u32>,
    /// Light with a photometric file (`EXT_lights_ies`).
    pub(super) luminaire: Option<NodeLuminaire>,
}

/// Light of a node with a photometric file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct NodeLuminaire {
    /// Index of the photometric file.
    pub(super) profile: usize,
    /// Factor of the intensity per band: its multiplier times its color.
    pub(super) factor: [f64; 3],
}

/// Location of a photometric file.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct LightProfile {
    /// Name, or an empty string.
    pub(super) name: String,
    /// Address of the file, or its data.
    pub(super) uri: Option<String>,
    /// Index of the buffer view with its data.
    pub(super) view: Option<u32>,
}

/// Reads the JSON document of the file `path`.
pub(super) fn parse(path: &Path, json: &[u8]) -> Result<Document, LoadError> {
    let invalid = |what: String| LoadError::Gltf { path: path.to_owned(), what };
    let short = |text: &str| files::shortened(text, MAX_MESSAGE_LENGTH);
    let mut document: Value = deserialize::from_slice(json)
        .map_err(|e| invalid(format!("its text is not complete, valid JSON ({})", short(&e.to_string()))))?;
    let mut extensions = BTreeSet::new();
    normalize(&mut document, &mut extensions);
    if !document.is_object() {
        return Err(invalid("its JSON text is not an object".to_owned()));
    }
    check_version(path, &mut document)?;
    let nodes = node_extensions(&document).map_err(invalid)?;
    let profiles = light_profiles(&document);
    let textures = texture_extensions(&document);
    let animations = document["animations"].as_array().map_or(0, Vec::len);
    forget_unused(&mut document);
    // For a value of the wrong type, its path is more useful than its line.
    let root = serde_path_to_error::deserialize(document).map_err(|e| {
        let message = short(&plain(&e.inner().to_string()));
        // The path of the whole document is ".".
        match e.path().to_string().as_str() {
            "." => invalid(message),
            place => invalid(format!("{}: {message}", short(place))),
        }
    })?;
    Ok(Document { root, animations, extensions, nodes, profiles, textures })
}

/// Writes whole numbers as integers, because `3`, `3.0` and `0.3e1` are equal (glTF 2.0 specification, section 3.2), and
/// collects the names of extensions.
///
/// The depth of a document is limited by the JSON reader.
fn normalize(value: &mut Value, extensions: &mut BTreeSet<String>) {
    match value {
        Value::Number(number) if number.is_f64() => {
            let whole = number.as_f64().filter(|x| x.fract() == 0.0 && x.abs() < MAX_EXACT);
            // A negative zero stays as it is.
            if let Some(x) = whole.filter(|x| *x != 0.0 || x.is_sign_positive()) {
                *value = if x < 0.0 { Value::from(x as i64) } else { Value::from(x as u64) };
            }
        }
        Value::Array(elements) => elements.iter_mut().for_each(|element| normalize(element, extensions)),
        Value::Object(members) => {
            for (name, member) in members.iter_mut().filter(|(name, _)| *name != "extras") {
                if let (true, Some(all)) = (name == "extensions", member.as_object()) {
                    extensions.extend(all.keys().cloned());
                }
                normalize(member, extensions);
            }
        }
        _ => {}
    }
}

/// Checks that the version is 2.x, and that no later one than 2.0 is needed. The version may be a number.
fn check_version(path: &Path, document: &mut Value) -> Result<(), LoadError> {
    // Elements of glTF 1.0 have names in place of numbers.
    let has_names = ["meshes", "nodes", "accessors"].iter().any(|list| document[*list].is_object());
    let mut asset = document.get_mut("asset");
    let mut stated = |field: &str| {
        let member = asset.as_mut()?.get_mut(field)?;
        if member.is_number() {
            *member = Value::String(member.to_string());
        }
        member.as_str().map(str::to_owned)
    };
    let (version, minimum) = (stated("version"), stated("minVersion"));
    let unsupported = |version: String| Err(LoadError::GltfVersion { path: path.to_owned(), version });
    if has_names {
        return unsupported(version.map_or("1.0".to_owned(), |version| files::shortened(&version, 20)));
    }
    let check = |stated: Option<String>, is_readable: fn((u32, u32)) -> bool| {
        let Some(stated) = stated else { return Ok(()) };
        match major_minor(&stated) {
            Some(numbers) if is_readable(numbers) => Ok(()),
            Some(_) => unsupported(stated),
            None => {
                let what =
                    format!("its version \"{}\" is not of the form \"2.0\"", files::shortened(&stated, 20));
                Err(LoadError::Gltf { path: path.to_owned(), what })
            }
        }
    };
    check(version, |(major, _)| major == 2)?;
    // Any version 2.x is readable as 2.0, unless the file states a minimum.
    check(minimum, |least| least <= (2, 0))
}

/// Returns the two numbers of a version. `2` is `2.0`.
fn major_minor(version: &str) -> Option<(u32, u32)> {
    let (major, minor) = version.split_once('.').unwrap_or((version, "0"));
    Some((major.parse().ok()?, minor.parse().ok()?))
}

/// Returns the elements of a list that have extensions, with their indices.
fn extended<'a>(document: &'a Value, list: &str) -> impl Iterator<Item = (usize, &'a Value)> {
    let elements = document[list].as_array().into_iter().flatten().enumerate();
    elements.filter_map(|(i, element)| Some((i, element.get("extensions")?)))
}

/// Returns the extensions of nodes. The error names an invalid one.
fn node_extensions(document: &Value) -> Result<BTreeMap<usize, NodeExtensions>, String> {
    let mut nodes = BTreeMap::new();
    for (i, extensions) in extended(document, "nodes") {
        let mut node = NodeExtensions::default();
        if let Some(visibility) = extensions.get("KHR_node_visibility") {
            let visible = visibility.get("visible").map_or(Some(true), Value::as_bool);
            let visible =
                visible.ok_or_else(|| format!("nodes[{i}]: `visible` is neither true nor false"))?;
            node.is_hidden = !visible;
        }
        if let Some(instancing) = extensions.get("EXT_mesh_gpu_instancing") {
            for (name, accessor) in instancing["attributes"].as_object().into_iter().flatten() {
                let index = accessor.as_u64().and_then(|index| u32::try_from(index).ok());
                let index = index.ok_or_else(|| {
                    format!("nodes[{i}]: {} of its instances is not an accessor", files::shortened(name, 60))
                })?;
                node.instances.insert(name.clone(), index);
            }
        }
        if let Some(light) = extensions.get("EXT_lights_ies") {
            node.luminaire = Some(node_luminaire(light).ok_or_else(|| {
                format!(
                    "nodes[{i}]: its `EXT_lights_ies` needs the index of a `light`, a `multiplier` that is not negative, and a \
                     `color` of three numbers from 0"
                )
            })?);
        }
        if node.is_hidden || !node.instances.is_empty() || node.luminaire.is_some() {
            nodes.insert(i, node);
        }
    }
    Ok(nodes)
}

/// Returns the light of a node with a photometric file; `None` if a member has a wrong type or is out of range.
fn node_luminaire(light: &Value) -> Option<NodeLuminaire> {
    let profile = usize::try_from(light.get("light")?.as_u64()?).ok()?;
    let multiplier = light.get("multiplier").map_or(Some(1.0), Value::as_f64)?;
    let color: [f64; 3] = match light.get("color") {
        None => [1.0; 3],
        Some(color) => {
            let numbers: Option<Vec<f64>> = color.as_array()?.iter().map(Value::as_f64).collect();
            // The specification clamps colors to 1.
            <[f64; 3]>::try_from(numbers?).ok()?.map(|x| x.min(1.0))
        }
    };
    let factor = color.map(|x| x * multiplier);
    factor.iter().all(|&x| x >= 0.0 && x.is_finite()).then_some(NodeLuminaire { profile, factor })
}

/// Returns the locations of all photometric files.
fn light_profiles(document: &Value) -> Vec<LightProfile> {
    let lights = document["extensions"]["EXT_lights_ies"]["lights"].as_array();
    let text = |light: &Value, name: &str| light.get(name).and_then(Value::as_str).map(str::to_owned);
    let profile = |light: &Value| LightProfile {
        name: text(light, "name").unwrap_or_default(),
        uri: text(light, "uri"),
        view: light.get("bufferView").and_then(Value::as_u64).and_then(|view| u32::try_from(view).ok()),
    };
    lights.into_iter().flatten().map(profile).collect()
}

/// Returns the names of the extensions with which textures refer to images.
fn texture_extensions(document: &Value) -> BTreeMap<usize, Vec<String>> {
    let textures = extended(document, "textures").map(|(i, extensions)| {
        let all = extensions.as_object().into_iter().flatten();
        (i, all.filter(|(_, member)| member.get("source").is_some()).map(|(name, _)| name.clone()).collect())
    });
    textures.collect()
}

/// Removes what no scene needs, so that errors in it do not matter. Adds the empty list of nodes that a scene may omit,
/// but that the crate `gltf` requires.
fn forget_unused(document: &mut Value) {
    let Some(members) = document.as_object_mut() else { return };
    for unused in ["animations", "skins"] {
        members.remove(unused);
    }
    for sampler in members.get_mut("samplers").and_then(Value::as_array_mut).into_iter().flatten() {
        if let Some(sampler) = sampler.as_object_mut() {
            sampler.retain(|name, _| name == "wrapS" || name == "wrapT");
        }
    }
    for scene in members.get_mut("scenes").and_then(Value::as_array_mut).into_iter().flatten() {
        if let Some(scene) = scene.as_object_mut() {
            scene.entry("nodes").or_insert_with(|| Value::Array(Vec::new()));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn normalized(text: &str) -> String {
        let mut value: Value = deserialize::from_str(text).unwrap();
        normalize(&mut value, &mut BTreeSet::new());
        value.to_string()
    }

    #[test]
    fn only_whole_numbers_become_integers() {
        assert_eq!(
            normalized("[1.0, 1e2, 0.3e1, -4.0, 0.0, 1.5, 1e-3, 2.5e0, 1e30, 9007199254740992.0, 7, -8]"),
            "[1,100,3,-4,0,1.5,0.001,2.5,1e+30,9007199254740992.0,7,-8]"
        );
        assert_eq!(
            normalized(r#"{"a": {"b": [-0.0]}, "extras": 1.0}"#),
            r#"{"a":{"b":[-0.0]},"extras":1.0}"#
        );
    }

    #[test]
    fn extensions_are_collected_wherever_they_are() {
        let text = r#"{"extensions": {"A": {}}, "nodes": [{"extensions": {"B": {"extensions": {"C": 1}}}}],
            "extras": {"extensions": {"D": {}}}, "asset": {"extensions": []}}"#;
        let (mut value, mut names) = (deserialize::from_str(text).unwrap(), BTreeSet::new());
        normalize(&mut value, &mut names);
        assert_eq!(Vec::from_iter(names), ["A", "B", "C"]);
    }

    #[test]
    fn versions_are_two_numbers() {
        for (text, expected) in [
            ("2.0", Some((2, 0))),
            ("2", Some((2, 0))),
            ("2.10", Some((2, 10))),
            ("", None),
            ("two", None),
            ("2.x", None),
        ] {
            assert_eq!(major_minor(text), expected, "{text}");
        }
    }
}
