//! Scenes for light transport: triangles, materials and cameras, with readers for glTF and OBJ.
//!
//! # Design
//!
//! A light-transport solver needs little of a scene: flat triangles, one diffuse material each, textures that vary it,
//! and the side of each triangle that is its *front*. [`Scene`] holds exactly that, in double precision and in world
//! space, with node hierarchies and file formats already resolved. It is immutable. A [`SceneBuilder`] builds it and is
//! the one place where geometry is checked, so that every later crate may rely on finite coordinates, valid indices,
//! triangles that have an area, and reflectances below one.
//!
//! Readers never leave out or change anything silently: they return a list of [`Warning`]s together with the scene.
//!
//! [`BoundingBox`] and [`BoundingSphere`] enclose the triangles.
//!
//! The readers are cargo features, `gltf` and `obj`, both enabled by default. Without them, scenes come from a
//! [`SceneBuilder`], and the crate needs no image decoder and no JSON reader.
//!
//! Indices are typed ([`TriangleId`], [`MaterialId`], …), so a triangle index cannot be used in place of a material
//! index.
//!
//! # Conventions
//!
//! * Lengths are in meters if the scene is; the solver does not depend on the unit.
//! * The *front* of a triangle is the side from which its corners run counterclockwise.
//! * Colors are linear Rec. 709 RGB ([`Rgb`]).
//! * Emission is stored as radiant *exitance* `M` \[W/m²\]: a file's emitted radiance `L` becomes `M = π L`.
//!
//! # Example
//!
//! ```
//! use sir_geom::{Material, Rgb, SceneBuilder, shapes::{self, Facing}};
//! use glam::DVec3;
//!
//! let mut builder = SceneBuilder::new();
//! let gray = builder.add_material(Material::diffuse("gray", Rgb::splat(0.5)));
//! shapes::cuboid(&mut builder, DVec3::ZERO, DVec3::ONE, [gray; 6], Facing::Inward);
//! let scene = builder.build()?.scene;
//! assert_eq!(scene.triangles().len(), 12);
//! assert!((scene.total_area() - 6.0).abs() < 1e-12);
//! # Ok::<(), sir_geom::SceneError>(())
//! ```

#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod appearance;
mod beam;
mod builder;
mod camera;
mod color;
mod dimming;
mod error;
mod index;
mod light;
mod load;
mod material;
mod points;
mod polygon;
mod scene;
pub mod shapes;
mod sky;
mod split;
mod surface;
mod text;
mod texture;
mod warning;

pub use beam::Beam;
pub use builder::SceneBuilder;
pub use camera::{Camera, Projection};
pub use color::{Rgb, luminance};
pub use dimming::Dimming;
pub use error::SceneError;
pub use index::{FaceId, GroupId, MaterialId, VertexId};
pub use light::{Arrival, Light, LightKind, Spread, Tabulated};
#[cfg(feature = "gltf")]
pub use load::{GltfFile, GltfPrimitive, RawElements};
pub use load::{LoadError, LoadOptions, SidesPolicy, load, load_with};
pub use material::{MAX_REFLECTANCE, Material, Opacity, Sides};
pub use points::{PointTree, Weld, median_extent};
pub use polygon::triangulate;
pub use scene::{MeshInstance, Scene, Triangle};
pub use sir_types::{Barycentric, BoundingBox, BoundingSphere, Line, Side, TriangleId, typed_index};
pub use sky::{Sky, SkyModel};
pub use surface::Opacities;
pub use text::utf8_text;
pub use texture::{ColorMap, Texture, TextureId, TextureMap, TextureMean, TextureSums, Wrap};
pub use warning::{Built, Warning};
