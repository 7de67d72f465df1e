//! What a reader remembers of materials and images that it has met.

use std::path::PathBuf;
use std::rc::Rc;

use crate::index::MaterialId;
use crate::load::texture::Placement;

/// Where the encoded bytes of an image lie. Images may share them, and large ones take time to decode.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Pixels {
    /// In a buffer view.
    View(usize),
    /// In a file.
    File(PathBuf),
    /// In the URI of this image, or nowhere.
    Own(usize),
}

/// Where the coordinates of a texture come from: the number of an attribute, and what becomes of its numbers.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct Coordinates {
    pub(super) set: u32,
    pub(super) placement: Placement,
}

/// What a primitive must know about its material.
#[derive(Clone)]
pub(super) struct Known {
    pub(super) id: MaterialId,
    /// The sets of coordinates that its textures use.
    pub(super) sets: Rc<[Coordinates]>,
    pub(super) alpha: Alpha,
}

/// What becomes of the alpha of vertex colors.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Alpha {
    /// It has no meaning.
    Opaque,
    /// It should decide where there is a surface, but is not asked.
    Mask,
    /// It is a share of the light.
    Blend,
}
