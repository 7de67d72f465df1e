//! Readers of scene files: glTF 2.0 and Wavefront OBJ.
//!
//! A reader takes from a file what a [`Scene`](crate::Scene) has, and reports what it ignores in
//! [`Warning`](crate::Warning)s, one per kind. Files may come from anywhere, so nothing in them is trusted: any defect
//! ends in a [`LoadError`], never in a panic or in unbounded use of memory.

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
#[cfg(feature = "gltf")]
pub use gltf::{GltfFile, GltfPrimitive, RawElements};
pub use options::{LoadOptions, SidesPolicy};

use crate::builder::SceneBuilder;
#[cfg(any(feature = "gltf", feature = "obj"))]
use crate::load::notes::{Notes, shorten};
use crate::warning::Built;

/// Reads a scene file. The extension of its name (`gltf`, `glb` or `obj`, in any case) determines the format.
///
/// Each format has a cargo feature, `gltf` and `obj`; both are enabled by default. Without them, this crate needs no
/// image decoder and no JSON reader.
///
/// Textures keep their resolution, up to 2²⁸ texels in total; triangles without texture coordinates have the mean
/// linear colors. Only materials that a triangle uses are read. Content that a scene cannot hold is ignored, with one
/// warning per kind.
///
/// # glTF 2.0
///
/// * **Content**: the default scene, or else the first scene, or else all nodes. Triangles are in the order of a
///   traversal of the nodes, parents before children. Instances (`EXT_mesh_gpu_instancing`) are expanded. Hidden nodes
///   (`KHR_node_visibility`) are left out with the meshes and lights below them.
/// * **Materials**: the base color times the vertex colors is the reflectance, also of metals and unlit materials. Its
///   alpha is the opacity, as `alphaMode` states. The emitted color times its strength is a radiance `L`, which gives
///   the exitance `π L`.
/// * **Groups** have the names of nodes, or else of meshes.
/// * **Cameras and punctual lights** (`KHR_lights_punctual`) are read. Intensities in cd and lx are taken as W/sr and
///   W/m²; the range of lights is ignored.
/// * **Buffers and images** may be embedded, or lie in files in the scene's folder or below it.
/// * **Extensions** that are not read are warnings that say what is missing. Required ones without which surfaces or
///   light would be wrong are errors.
///
/// # OBJ
///
/// * **Triangles** are in the order of the faces. Polygons are cut into fans from their first corner, or into other
///   triangles where a fan would be wrong.
/// * **Materials**: `Kd` times `map_Kd` and the vertex colors, which are taken as sRGB, is the reflectance. `Ke` times
///   `map_Ke` is a radiance, which gives the exitance `π Ke`. `d` (or else `1 − Tr`) times the alpha, or brightness, of
///   `map_d` is the opacity.
/// * **Groups** have the names in `o` and `g` statements; the last one before a face counts.
/// * **Text** is UTF-8, UTF-16 or in any other encoding that contains ASCII. Names are compared, and files found, by
///   their bytes; names that are not UTF-8 get escapes such as `\xB0` for them.
///
/// # Errors
///
/// If the reader of the format is disabled; if the file, or another one that its geometry needs, cannot be read or
/// violates its format; or if there is no triangle. Missing material libraries and textures are warnings.
pub fn load(path: &Path, options: &LoadOptions) -> Result<Built, LoadError> {
    load_with(path, options, |_| {})
}

/// Reads a scene file as [`load`] does, and adds to it: `add` gets the builder after the contents of the file were
/// added and scaled, so its lengths are in meters.
///
/// # Errors
///
/// The same as those of [`load`].
#[cfg_attr(
    not(any(feature = "gltf", feature = "obj")),
    expect(unused_variables, reason = "without a reader, there is nothing to do with options")
)]
pub fn load_with(
    path: &Path,
    options: &LoadOptions,
    add: impl FnOnce(&mut SceneBuilder),
) -> Result<Built, LoadError> {
    if path.is_dir() {
        return Err(LoadError::Folder { path: path.to_owned() });
    }
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

/// Fills a builder with a reader, and builds the scene.
#[cfg(any(feature = "gltf", feature = "obj"))]
fn read(
    path: &Path,
    options: &LoadOptions,
    reader: impl FnOnce(&Path, LoadOptions, &mut SceneBuilder, &mut Notes) -> Result<(), LoadError>,
    add: impl FnOnce(&mut SceneBuilder),
) -> Result<Built, LoadError> {
    let (mut builder, mut notes) = (SceneBuilder::new(), Notes::default());
    reader(path, *options, &mut builder, &mut notes)?;
    builder.end_meshes();
    builder.scale(options.scale);
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
