//! State of reading a glTF file.

use std::collections::BTreeMap;

use crate::builder::SceneBuilder;
use crate::load::gltf::data::Data;
use crate::load::gltf::known::{Known, KnownProfile, Pixels};
use crate::load::notes::{Notes, quoted};
use crate::load::options::LoadOptions;
use crate::load::texture::{Image, Images};

/// Reader that adds the contents of a glTF file to a builder.
pub(super) struct Reader<'a> {
    pub(super) data: Data<'a>,
    pub(super) options: LoadOptions,
    pub(super) builder: &'a mut SceneBuilder,
    pub(super) notes: &'a mut Notes,
    /// Materials read so far, by index in the file. No index stands for the default material, whose two colors the flag
    /// tells apart: it is true for primitives with vertex colors.
    pub(super) materials: BTreeMap<(Option<usize>, bool), Known>,
    /// Images read so far; `None` for unreadable ones.
    pub(super) textures: BTreeMap<Pixels, Option<Image>>,
    /// Photometric files read so far, by index.
    pub(super) profiles: BTreeMap<usize, KnownProfile>,
    pub(super) images: Images,
    /// Number of vertices read so far.
    pub(super) vertices: usize,
    /// Number of texture coordinates and colors read so far.
    pub(super) coordinates: usize,
    pub(super) triangles: usize,
    pub(super) primitives: usize,
}

/// Returns the name of an element in quotes or, if it has none, its number.
pub(super) fn label(kind: &str, number: usize, name: &str) -> String {
    if name.is_empty() { format!("{kind} {number}") } else { quoted(name) }
}
