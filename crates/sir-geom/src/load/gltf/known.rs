//! Cached data about the materials and images that were read so far.

use std::path::PathBuf;
use std::rc::Rc;

use crate::index::MaterialId;
use crate::light::Tabulated;
use crate::load::texture::Placement;

/// Location of the encoded bytes of an image, the key of the image cache: images may share bytes, and large ones take
/// time to decode.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Pixels {
    /// In a buffer view.
    View(usize),
    /// In a file.
    File(PathBuf),
    /// In the URI of the image with this index, or nowhere.
    Own(usize),
}

/// Source of texture coordinates: the number of an attribute, and the transform of its values.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct Coordinates {
    pub(super) set: u32,
    pub(super) placement: Placement,
}

/// Data about a material that its primitives need.
#[derive(Clone)]
pub(super) struct Known {
    pub(super) id: MaterialId,
    /// Coordinate sets of its textures.
    pub(super) sets: Rc<[Coordinates]>,
    pub(super) alpha: Alpha,
}

/// Use of the alpha of vertex colors.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Alpha {
    /// Ignored, because the material is opaque.
    Opaque,
    /// Ignored with a warning, although it should decide where there is a surface.
    Mask,
    /// Multiplies the opacity.
    Blend,
}

/// Light of a photometric file, without an orientation.
pub(super) struct KnownProfile {
    pub(super) name: String,
    pub(super) shape: Tabulated,
    /// Largest intensity \[cd\].
    pub(super) largest: f64,
}
