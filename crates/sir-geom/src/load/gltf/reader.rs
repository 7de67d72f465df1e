//! A glTF file on its way into a scene.

use std::cell::Cell;
use std::collections::BTreeMap;
use std::path::Path;
use std::rc::Rc;

use ::gltf::json::{Index, Root, root::Get};

use crate::builder::SceneBuilder;
use crate::load::error::LoadError;
use crate::load::gltf::known::{Known, Pixels};
use crate::load::notes::Notes;
use crate::load::options::LoadOptions;
use crate::load::texture::{Image, Images};

/// A file on its way into a builder.
pub(super) struct Reader<'a> {
    pub(super) path: &'a Path,
    pub(super) root: &'a Root,
    pub(super) buffers: Vec<Rc<Vec<u8>>>,
    pub(super) options: LoadOptions,
    pub(super) builder: &'a mut SceneBuilder,
    pub(super) notes: &'a mut Notes,
    /// Materials met so far by their index in the file; no index stands for the default one, which comes in two colors.
    pub(super) materials: BTreeMap<(Option<usize>, bool), Known>,
    /// Images met so far; `None` for one that cannot be read.
    pub(super) textures: BTreeMap<Pixels, Option<Image>>,
    pub(super) images: Images,
    /// How many were added so far.
    pub(super) vertices: usize,
    /// Coordinates of textures and colors.
    pub(super) coordinates: usize,
    pub(super) triangles: usize,
    pub(super) primitives: usize,
    /// Elements of accessors without data.
    pub(super) unbacked: Cell<usize>,
}

impl Reader<'_> {
    pub(super) fn invalid(&self, what: impl Into<String>) -> LoadError {
        LoadError::Gltf { path: self.path.to_owned(), what: what.into() }
    }
}

/// The element of a file at an index. `what` says who asks for which kind of element.
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
