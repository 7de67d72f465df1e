//! Readers of scene files: glTF 2.0 and Wavefront OBJ.
//!
//! A reader takes from a file what a [`Scene`](crate::Scene) has, and says in [`Warning`](crate::Warning)s, one
//! line per kind, what it passed over. Files come from anywhere, so nothing in them is trusted: whatever is
//! wrong with one ends in a [`LoadError`], never in a panic or in memory without bound.

mod error;
#[cfg(any(feature = "gltf", feature = "obj"))]
mod files;
#[cfg(feature = "gltf")]
mod gltf;
#[cfg(any(feature = "gltf", feature = "obj"))]
mod notes;
#[cfg(feature = "obj")]
mod obj;
mod options;
#[cfg(any(feature = "gltf", feature = "obj"))]
mod texture;

use std::path::Path;

pub use error::LoadError;
pub use options::{LoadOptions, SidesPolicy};

use crate::builder::SceneBuilder;
#[cfg(any(feature = "gltf", feature = "obj"))]
use crate::load::notes::{Notes, shorten};
use crate::warning::Built;

/// Reads a scene file; the extension of its name (`gltf`, `glb` or `obj`, in any case) tells the format.
///
/// Each format has a cargo feature, `gltf` and `obj`; both are on by default. With neither, this crate needs no decoder of images
/// and no reader of JSON.
///
/// Textures are kept as they are, up to 2²⁸ texels in all; triangles without coordinates have their mean linear colors. Only materials that a triangle uses are taken in. What the
/// file has beyond a scene is passed over with one warning per kind.
///
/// # glTF 2.0
///
/// The default scene, else the first one, else all nodes; triangles in the order of a walk through the nodes,
/// parents before children. Base color, times the colors of vertices, is the reflectance, also of metals and unlit materials, its alpha the opacity as `alphaMode` says; the emitted color times its strength
/// is a radiance `L`, which gives the exitance `π L`. Groups have the names of nodes, or else of meshes. Cameras and punctual lights
/// (`KHR_lights_punctual`) are taken in; the numbers of the latter, in cd and lx, are taken for W/sr and W/m², their range is ignored. Buffers and images may be embedded
/// or lie in files in the scene's folder or below it.
///
/// # OBJ
///
/// Triangles in the order of the faces, polygons cut into fans from their first corner, or into other triangles where that would be wrong. `Kd` times
/// `map_Kd` and the colors of vertices, taken for sRGB, is the reflectance; `Ke` times `map_Ke` a radiance that gives the exitance `π Ke`; `d` (else
/// `1 − Tr`) times the alpha, or brightness, of `map_d` the opacity. Groups have the
/// names in `o` and `g` statements, of which the last before a face counts.
///
/// # Errors
///
/// If the reader of the format is switched off, or the file or one that its geometry needs cannot be read, breaks its format, or holds no triangle. Missing
/// material libraries and textures are warnings.
pub fn load(path: &Path, options: &LoadOptions) -> Result<Built, LoadError> {
    load_with(path, options, |_| {})
}

/// As [`load`], with more than the file has: `add` gets the builder when it holds the contents of the file.
///
/// # Errors
///
/// As [`load`].
#[cfg_attr(
    not(any(feature = "gltf", feature = "obj")),
    expect(unused_variables, reason = "without a reader, there is nothing to do with options")
)]
pub fn load_with(
    path: &Path,
    options: &LoadOptions,
    add: impl FnOnce(&mut SceneBuilder),
) -> Result<Built, LoadError> {
    let extension = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
    match extension.as_deref() {
        #[cfg(feature = "gltf")]
        Some("gltf" | "glb") => read(path, options, gltf::read, add),
        #[cfg(feature = "obj")]
        Some("obj") => read(path, options, obj::read, add),
        #[cfg(not(feature = "gltf"))]
        Some("gltf" | "glb") => Err(LoadError::WithoutReader { path: path.to_owned(), feature: "gltf" }),
        #[cfg(not(feature = "obj"))]
        Some("obj") => Err(LoadError::WithoutReader { path: path.to_owned(), feature: "obj" }),
        _ => Err(LoadError::UnknownFormat { path: path.to_owned(), extension }),
    }
}

/// Lets a reader fill a builder, and builds the scene.
#[cfg(any(feature = "gltf", feature = "obj"))]
fn read(
    path: &Path,
    options: &LoadOptions,
    reader: impl FnOnce(&Path, LoadOptions, &mut SceneBuilder, &mut Notes) -> Result<(), LoadError>,
    add: impl FnOnce(&mut SceneBuilder),
) -> Result<Built, LoadError> {
    let (mut builder, mut notes) = (SceneBuilder::new(), Notes::default());
    reader(path, *options, &mut builder, &mut notes)?;
    let skipped = notes.skipped();
    notes.warn(&mut builder);
    add(&mut builder);
    let mut built =
        builder.build().map_err(|source| LoadError::Scene { path: path.to_owned(), skipped, source })?;
    shorten(&mut built.warnings);
    Ok(built)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reader_that_is_switched_off_is_named() {
        for (name, feature, is_on) in [
            ("absent.gltf", "gltf", cfg!(feature = "gltf")),
            ("absent.GLB", "gltf", cfg!(feature = "gltf")),
            ("absent.obj", "obj", cfg!(feature = "obj")),
        ] {
            let error = load(Path::new(name), &LoadOptions::default()).unwrap_err();
            assert!(error.to_string().contains(name));
            match error {
                LoadError::WithoutReader { feature: named, .. } => assert!(!is_on && named == feature),
                other => assert!(is_on && matches!(other, LoadError::Read { .. }), "{other}"),
            }
        }
    }
}
