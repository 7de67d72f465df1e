//! glTF 2.0, text (`.gltf`) and binary (`.glb`).
//!
//! The crate `gltf` provides the types of the JSON part. Its validation and its accessors are not used: they panic on
//! some files (a position accessor that is out of range, a GLB length below 12, a camera without its object) and reject
//! others because of parts that a scene does not need. Here every index is checked when it is looked up.

mod access;
mod camera;
mod container;
mod corners;
mod data;
mod document;
mod extensions;
mod file;
mod geometry;
mod images;
mod instances;
mod known;
mod light;
mod luminaire;
mod material;
mod primitive;
mod reader;
mod uri;
mod walk;
mod wording;

pub use file::{GltfFile, GltfPrimitive, RawElements};

use std::collections::BTreeMap;
use std::path::Path;

use crate::builder::SceneBuilder;
use crate::load::error::LoadError;
use crate::load::gltf::data::Data;
use crate::load::gltf::reader::Reader;
use crate::load::notes::Notes;
use crate::load::options::LoadOptions;
use crate::load::texture::Images;

/// Reads a glTF file into a builder.
pub(super) fn read(
    path: &Path,
    options: LoadOptions,
    builder: &mut SceneBuilder,
    notes: &mut Notes,
) -> Result<(), LoadError> {
    let (document, binary) = container::open(path)?;
    extensions::check(path, &document, notes)?;
    notes.count("animations are not played: the scene is read in its state at rest", document.animations);
    let buffers = container::buffers(path, &document.root, binary)?;
    let reader = Reader {
        data: Data::new(path, &document, &buffers),
        options,
        builder,
        notes,
        materials: BTreeMap::new(),
        textures: BTreeMap::new(),
        profiles: BTreeMap::new(),
        images: Images::default(),
        vertices: 0,
        coordinates: 0,
        triangles: 0,
        primitives: 0,
    };
    reader.scene()
}
