//! glTF 2.0, text (`.gltf`) and binary (`.glb`).
//!
//! The crate `gltf` gives the types of the JSON part. Its validation and its accessors are not used: they panic
//! at some files (a position accessor that is out of range, a GLB length below 12, a camera without its object)
//! and refuse others for parts that a scene does not need. Here every index is looked up with a check instead.

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

/// Extensions whose meaning is taken in, or does not change a diffuse scene.
const KNOWN_EXTENSIONS: [&str; 6] = [
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_unlit",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
];

/// Extensions about gloss, without which materials are what they are to this program anyway.
const GLOSS_EXTENSIONS: [&str; 7] = [
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_dispersion",
    "KHR_materials_ior",
    "KHR_materials_iridescence",
    "KHR_materials_sheen",
    "KHR_materials_specular",
];

/// Extensions about light in materials.
const GLASS_EXTENSIONS: [&str; 3] =
    ["KHR_materials_diffuse_transmission", "KHR_materials_transmission", "KHR_materials_volume"];

/// The most unknown extensions that are named.
const MOST_NAMES: usize = 8;

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
    // Any 2.x is meant to be readable as 2.0, unless the file states a minimum.
    let readable = match &root.asset.min_version {
        Some(minimum) => minimum == "2.0",
        None => root.asset.version.starts_with("2."),
    };
    if readable {
        return Ok(());
    }
    let what = format!("its version is \"{needed}\", and 2.0 is read");
    Err(LoadError::Gltf { path: path.to_owned(), what: files::shortened(&what, 100) })
}

fn check_extensions(path: &Path, root: &Root, notes: &mut Notes) -> Result<(), LoadError> {
    let unknown = |names: &[String]| -> Vec<String> {
        let mut seen = BTreeSet::from(KNOWN_EXTENSIONS);
        let new = names.iter().filter(|&name| seen.insert(name));
        new.take(MOST_NAMES).map(|name| files::shortened(name, 60)).collect()
    };
    let names = unknown(&root.extensions_required);
    if !names.is_empty() {
        return Err(LoadError::RequiredExtensions { path: path.to_owned(), names });
    }
    for name in unknown(&root.extensions_used) {
        let what = match &*name {
            name if GLOSS_EXTENSIONS.contains(&name) => {
                "glTF extensions describe gloss, which diffuse surfaces lack, and were ignored"
            }
            name if GLASS_EXTENSIONS.contains(&name) => {
                "glTF extensions describe light in materials, and were ignored: light passes only where alpha lets it"
            }
            _ => "glTF extensions have no meaning here and were ignored",
        };
        notes.name(what, name);
    }
    Ok(())
}
