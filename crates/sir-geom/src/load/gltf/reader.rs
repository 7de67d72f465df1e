//! State of reading a glTF file.

use std::cell::Cell;
use std::collections::BTreeMap;
use std::path::Path;
use std::rc::Rc;

use ::gltf::json::{Index, Root, root::Get};

use crate::builder::SceneBuilder;
use crate::load::error::LoadError;
use crate::load::gltf::document::Document;
use crate::load::gltf::known::{Known, Pixels};
use crate::load::notes::{Notes, quoted};
use crate::load::options::LoadOptions;
use crate::load::texture::{Image, Images};

/// Reader that adds the contents of a glTF file to a builder.
pub(super) struct Reader<'a> {
    pub(super) path: &'a Path,
    pub(super) root: &'a Root,
    /// The document with `root`, and what `root` lacks.
    pub(super) document: &'a Document,
    pub(super) buffers: Vec<Rc<Vec<u8>>>,
    pub(super) options: LoadOptions,
    pub(super) builder: &'a mut SceneBuilder,
    pub(super) notes: &'a mut Notes,
    /// Materials read so far, by index in the file. No index stands for the default material, whose two colors the flag
    /// tells apart: it is true for primitives with vertex colors.
    pub(super) materials: BTreeMap<(Option<usize>, bool), Known>,
    /// Images read so far; `None` for unreadable ones.
    pub(super) textures: BTreeMap<Pixels, Option<Image>>,
    pub(super) images: Images,
    /// Number of vertices read so far.
    pub(super) vertices: usize,
    /// Number of texture coordinates and colors read so far.
    pub(super) coordinates: usize,
    pub(super) triangles: usize,
    pub(super) primitives: usize,
    /// Number of accessor elements without data that were read so far.
    pub(super) unbacked: Cell<usize>,
}

impl Reader<'_> {
    pub(super) fn invalid(&self, what: impl Into<String>) -> LoadError {
        LoadError::Gltf { path: self.path.to_owned(), what: what.into() }
    }
}

/// Returns the name of an element in quotes or, if it has none, its number.
pub(super) fn label(kind: &str, number: usize, name: &str) -> String {
    if name.is_empty() { format!("{kind} {number}") } else { quoted(name) }
}

/// Returns the element of a file at an index. `what` names the requester and the kind of element in error messages.
pub(super) fn lookup<'a, T>(
    path: &Path,
    root: &'a Root,
    index: Index<T>,
    what: &str,
) -> Result<&'a T, LoadError>
where
    Root: Get<T>,
{
    root.get(index).ok_or_else(|| LoadError::Gltf {
        path: path.to_owned(),
        what: format!("{what} {} does not exist", index.value()),
    })
}
