//! The document of a glTF file with its buffers.

use std::cell::Cell;
use std::path::Path;
use std::rc::Rc;

use ::gltf::json::{Index, Root, root::Get};

use crate::load::error::LoadError;
use crate::load::gltf::document::Document;

/// The document of a glTF file, and the bytes of its buffers.
pub(super) struct Data<'a> {
    pub(super) path: &'a Path,
    pub(super) root: &'a Root,
    /// The document with `root`, and what `root` lacks.
    pub(super) document: &'a Document,
    pub(super) buffers: &'a [Rc<Vec<u8>>],
    /// Number of accessor elements without data that were read so far.
    pub(super) unbacked: Cell<usize>,
}

impl<'a> Data<'a> {
    pub(super) fn new(path: &'a Path, document: &'a Document, buffers: &'a [Rc<Vec<u8>>]) -> Self {
        Self { path, root: &document.root, document, buffers, unbacked: Cell::new(0) }
    }

    pub(super) fn invalid(&self, what: impl Into<String>) -> LoadError {
        LoadError::Gltf { path: self.path.to_owned(), what: what.into() }
    }
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
