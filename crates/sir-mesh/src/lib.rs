//! Patches: the elements on which radiosity is solved.
//!
//! # Design
//!
//! *Trace coarse, record fine.* An acceleration structure holds the triangles of the file only, however fine the patches
//! are. The patch of a hit follows from its triangle and barycentric coordinates, in constant time.
//!
//! [`Subdivision::Surfaces`] divides surfaces, regardless of their triangles: flat ones into square cells that their outline
//! cuts, and small triangles of bent ones are joined. A patch is a list of [`Piece`]s: convex polygons in triangles.
//! [`Subdivision::Triangles`] cuts each triangle into `n²` congruent ones, for which nothing is stored.
//! [`Subdivision::PerFace`] makes one patch of all triangles of a flat polygon, as in classic radiosity systems with one
//! element per rectangle.
//!
//! Power lives on *sides* ([`SideId`]): a patch of a one-sided triangle has one, of a two-sided triangle two. The patches of
//! a surface have consecutive numbers, and so have their sides.
//!
//! If a triangle has a texture, each patch of its surface has its own reflectance, exitance and covered share: the means
//! over its area.
//!
//! `surfaces/` finds the surfaces, `layout.rs` decides how each is divided, `cells.rs` and `lattice.rs` cut it, and
//! `numbering.rs` holds what a lookup needs.
//!
//! # Example
//!
//! ```
//! use glam::DVec3;
//! use sir_geom::{Barycentric, Material, Rgb, SceneBuilder, Side, TriangleId, shapes::{self, Facing}};
//! use sir_mesh::{PatchMesh, PatchSize, Subdivision};
//!
//! let mut builder = SceneBuilder::new();
//! let gray = builder.add_material(Material::diffuse("gray", Rgb::splat(0.5)));
//! shapes::cuboid(&mut builder, DVec3::ZERO, DVec3::ONE, [gray; 6], Facing::Inward);
//! let scene = builder.build()?.scene;
//!
//! let mesh = PatchMesh::new(&scene, Subdivision::Triangles(PatchSize::MaxArea(0.01)))?;
//! let (triangle, hit) = (TriangleId(3), Barycentric { v: 0.3, w: 0.6 });
//! let patch = mesh.patch_at(triangle, hit);
//! assert!(mesh.pieces(triangle, patch).all(|piece| piece.triangle == triangle));
//! assert!(mesh.patch_area(triangle, patch) <= 0.01);
//! assert_eq!(mesh.side_of(triangle, patch, Side::Back), None, "this triangle is one-sided");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod barycentric;
mod cells;
mod error;
mod index;
mod lattice;
mod layout;
mod mesh;
mod numbering;
mod parts;
mod piece;
mod properties;
mod side_sums;
mod subdivision;
mod surfaces;

pub use error::MeshError;
pub use index::{PatchId, SideId};
pub use mesh::PatchMesh;
pub use piece::Piece;
pub use side_sums::{Part, Per, SideSums};
pub use subdivision::{PatchSize, Subdivision};
