//! glTF 2.0, text (`.gltf`) and binary (`.glb`).
//!
//! The crate `gltf` provides the types of the JSON part. Its validation and its accessors are not used: they panic on
//! some files (a position accessor that is out of range, a GLB length below 12, a camera without its object) and reject
//! others because of parts that a scene does not need. Here every index is checked when it is looked up.

mod access;
mod camera;
mod container;
mod corners;
mod known;
mod light;
mod material;
mod primitive;
mod reader;
mod uri;
mod walk;

use std::cell::Cell;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use ::gltf::json::Root;

use crate::builder::SceneBuilder;
use crate::load::error::LoadError;
use crate::load::files;
use crate::load::gltf::reader::Reader;
use crate::load::notes::Notes;
use crate::load::options::LoadOptions;
use crate::load::texture::Images;

/// Extensions that are supported, or do not change a diffuse scene.
const KNOWN_EXTENSIONS: [&str; 6] = [
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_unlit",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
];

/// Extensions about gloss, which do not affect diffuse materials.
const GLOSS_EXTENSIONS: [&str; 7] = [
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_dispersion",
    "KHR_materials_ior",
    "KHR_materials_iridescence",
    "KHR_materials_sheen",
    "KHR_materials_specular",
];

/// Extensions about transmission of light through materials.
const TRANSMISSION_EXTENSIONS: [&str; 3] =
    ["KHR_materials_diffuse_transmission", "KHR_materials_transmission", "KHR_materials_volume"];

/// Maximum number of unknown extensions that are named.
const MAX_NAMES: usize = 8;

/// Reads a glTF file into a builder.
pub(super) fn read(
    path: &Path,
    options: LoadOptions,
    builder: &mut SceneBuilder,
    notes: &mut Notes,
) -> Result<(), LoadError> {
    let (root, binary) = container::open(path)?;
    check_version(path, &root)?;
    check_extensions(path, &root, notes)?;
    let buffers = container::buffers(path, &root, binary)?;
    let reader = Reader {
        path,
        root: &root,
        buffers,
        options,
        builder,
        notes,
        materials: BTreeMap::new(),
        textures: BTreeMap::new(),
        images: Images::default(),
        vertices: 0,
        coordinates: 0,
        triangles: 0,
        primitives: 0,
        unbacked: Cell::new(0),
    };
    reader.scene()
}

fn check_version(path: &Path, root: &Root) -> Result<(), LoadError> {
    let needed = root.asset.min_version.as_ref().unwrap_or(&root.asset.version);
    // Any version 2.x should be readable as 2.0, unless the file states a minimum.
    let readable = match &root.asset.min_version {
        Some(minimum) => minimum == "2.0",
        None => root.asset.version.starts_with("2."),
    };
    if readable {
        return Ok(());
    }
    let what = format!("its version is \"{needed}\", but only 2.0 is supported");
    Err(LoadError::Gltf { path: path.to_owned(), what: files::shortened(&what, 100) })
}

fn check_extensions(path: &Path, root: &Root, notes: &mut Notes) -> Result<(), LoadError> {
    let unknown = |names: &[String]| -> Vec<String> {
        let mut seen = BTreeSet::from(KNOWN_EXTENSIONS);
        let new = names.iter().filter(|&name| seen.insert(name));
        new.take(MAX_NAMES).map(|name| files::shortened(name, 60)).collect()
    };
    let names = unknown(&root.extensions_required);
    if !names.is_empty() {
        return Err(LoadError::RequiredExtensions { path: path.to_owned(), names });
    }
    for name in unknown(&root.extensions_used) {
        let what = match &*name {
            name if GLOSS_EXTENSIONS.contains(&name) => {
                "glTF extensions describe gloss, which diffuse surfaces do not have, and were ignored"
            }
            name if TRANSMISSION_EXTENSIONS.contains(&name) => {
                "glTF extensions describe transmission and were ignored: light passes only where alpha lets it"
            }
            _ => "glTF extensions are not supported and were ignored",
        };
        notes.name(what, name);
    }
    Ok(())
}
