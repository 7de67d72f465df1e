//! Readers of scene files: glTF 2.0 and Wavefront OBJ.
//!
//! A reader takes from a file what a [`Scene`](crate::Scene) has, and says in [`Warning`](crate::Warning)s, one
//! line per kind, what it passed over. Files come from anywhere, so nothing in them is trusted: whatever is
//! wrong with one ends in a [`LoadError`], never in a panic or in memory without bound.

mod error;
mod files;
mod gltf;
mod notes;
mod obj;
mod texture;

use std::path::Path;

pub use error::LoadError;

use crate::builder::{Built, SceneBuilder};
use crate::material::{Material, Sides};
use notes::Notes;

/// The most vertices or triangles of a glTF scene. Without a limit, a small file with many instances of its
/// meshes could fill any memory.
const MAX_ELEMENTS: usize = 1 << 26;

/// Reflectance in place of one that a file does not give.
const DEFAULT_REFLECTANCE: f64 = 0.5;

/// How to read a scene file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct LoadOptions {
    /// Which sides of surfaces take part in light transport.
    pub sides: SidesPolicy,
}

/// What decides which sides of a surface reflect.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum SidesPolicy {
    /// The file: `doubleSided` in glTF, where both sides also emit. OBJ files have no such notion: both sides
    /// reflect, and the front emits.
    #[default]
    AsAuthored,
    /// Both sides of every surface reflect. Which sides emit is left to the file.
    Both,
    /// Only the fronts reflect and emit.
    Front,
}

impl SidesPolicy {
    /// The material as this policy has it.
    fn apply(self, mut material: Material) -> Material {
        match self {
            Self::AsAuthored => {}
            Self::Both => material.sides = Sides::Both,
            Self::Front => {
                material.sides = Sides::Front;
                material.back_emits = false;
            }
        }
        material
    }
}

/// Reads a scene file; the extension of its name (`gltf`, `glb` or `obj`, in any case) tells the format.
///
/// Textures are kept as they are, up to 2²⁸ texels in all; triangles without coordinates have their mean linear colours. Only materials that a triangle uses are taken in. What the
/// file has beyond a scene is passed over with one warning per kind.
///
/// # glTF 2.0
///
/// The default scene, else the first one, else all nodes; triangles in the order of a walk through the nodes,
/// parents before children. Base colour, times the colours of vertices, is the reflectance, also of metals and unlit materials, its alpha the opacity as `alphaMode` says; the emitted colour times its strength
/// is a radiance `L`, which gives the exitance `π L`. Groups have the names of nodes, or else of meshes. Cameras and punctual lights
/// (`KHR_lights_punctual`) are taken in; the numbers of the latter, in cd and lx, are taken for W/sr and W/m², their range is ignored. Buffers and images may be embedded
/// or lie in files in the scene's folder or below it.
///
/// # OBJ
///
/// Triangles in the order of the faces, polygons cut into fans from their first corner, or into other triangles where that would be wrong. `Kd` times
/// `map_Kd` and the colours of vertices, taken for sRGB, is the reflectance; `Ke` times `map_Ke` a radiance that gives the exitance `π Ke`; `d` (else
/// `1 − Tr`) times the alpha, or brightness, of `map_d` the opacity. Groups have the
/// names in `o` and `g` statements, of which the last before a face counts.
///
/// # Errors
///
/// If the file or one that its geometry needs cannot be read, breaks its format, or holds no triangle. Missing
/// material libraries and textures are warnings.
pub fn load(path: &Path, options: &LoadOptions) -> Result<Built, LoadError> {
    load_with(path, options, |_| {})
}

/// As [`load`], with more than the file has: `add` gets the builder when it holds the contents of the file.
///
/// # Errors
///
/// As [`load`].
pub fn load_with(
    path: &Path,
    options: &LoadOptions,
    add: impl FnOnce(&mut SceneBuilder),
) -> Result<Built, LoadError> {
    let extension = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
    let (mut builder, mut notes) = (SceneBuilder::new(), Notes::default());
    match extension.as_deref() {
        Some("gltf" | "glb") => gltf::read(path, *options, &mut builder, &mut notes)?,
        Some("obj") => obj::read(path, *options, &mut builder, &mut notes)?,
        _ => return Err(LoadError::UnknownFormat { path: path.to_owned(), extension }),
    }
    let skipped = notes.skipped();
    notes.warn(&mut builder);
    add(&mut builder);
    let mut built =
        builder.build().map_err(|source| LoadError::Scene { path: path.to_owned(), skipped, source })?;
    notes::shorten(&mut built.warnings);
    Ok(built)
}
