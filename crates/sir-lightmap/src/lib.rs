//! Lightmaps of a radiosity solution.
//!
//! # Design
//!
//! The input is a scene, its patches, and the irradiance of each side of each patch with its standard error. The output is
//! what engines want: the scene as its author made it, a second set of texture coordinates, and images.
//!
//! * **Documents.** The glTF file is read again as JSON (`document`), and changed as little as possible (`lit`): what this
//!   crate does not know, such as extensions and animations, stays. Triangles that come from no glTF file, those of OBJ files
//!   and panels of pipelines, become meshes of it (`loose`). `objects` knows where each triangle of the scene is in the
//!   document, for which [`Scene::mesh_instances`](sir_geom::Scene::mesh_instances) tells from which mesh it comes.
//! * **Layout.** `unwrap` unfolds each side of each mesh into charts, with the crate `uvunwrap`, and places them on pages. A
//!   layout that the file has is kept if it is valid (`existing`). Charts end at creases, so that no texel mixes the light of
//!   two walls. Backs without any light, such as the outsides of a room, are left out, and other surfaces without light take
//!   one texel each (`dark`).
//! * **Texels.** `means` gives vertices values that keep the power of patches. `texels` cuts the polygons of the display mesh at the edges of texels and integrates exactly. A texel starts
//!   no ray, so none starts behind a wall: where other bakers leak, this one takes the mean of what lies in the texel.
//! * **Seams.** `seams` fits the texels on both sides of edges of charts to each other, within their errors; `dilate` gives
//!   the texels around charts the light of their neighbors.
//!
//! All sums run in a fixed order, so the result does not depend on the number of threads. Charts are the same on all
//! processors: `uvunwrap` is used without the solver whose results differ.
//!
//! # Example
//!
//! ```
//! use std::path::Path;
//! use glam::DVec3;
//! use sir_geom::{Material, Rgb, SceneBuilder, shapes::{self, Facing}};
//! use sir_lightmap::{Lightmap, LightmapOptions, Observer, Solution, Step};
//! use sir_mesh::{PatchMesh, PatchSize, Subdivision};
//!
//! struct GoOn;
//! impl Observer for GoOn {
//!     fn progress(&self, _: Step, _: u64, _: Option<u64>) -> bool {
//!         true
//!     }
//! }
//!
//! let mut builder = SceneBuilder::new();
//! let gray = builder.add_material(Material::diffuse("gray", Rgb::splat(0.5)));
//! shapes::cuboid(&mut builder, DVec3::ZERO, DVec3::ONE, [gray; 6], Facing::Inward);
//! let scene = builder.build()?.scene;
//! let mesh = PatchMesh::new(&scene, Subdivision::Surfaces(PatchSize::MaxArea(0.01)))?;
//! // Uniform irradiance, instead of the result of a solver.
//! let irradiance = vec![Rgb::splat(2.0); mesh.side_count()];
//! let errors = vec![Rgb::splat(0.1); mesh.side_count()];
//! let solution = Solution {
//!     scene: &scene,
//!     mesh: &mesh,
//!     irradiance: &irradiance,
//!     errors: &errors,
//!     is_denoised: false,
//!     direct: None,
//!     source: Path::new("box.obj"),
//!     scale: 1.0,
//!     up: DVec3::Y,
//! };
//! let options = LightmapOptions { size: 128, ..LightmapOptions::default() };
//! let lightmap = Lightmap::new(solution, options, &GoOn)?;
//! let covered = lightmap.areas().iter().zip(lightmap.irradiance()).filter(|(area, _)| **area > 0.0);
//! assert!(covered.into_iter().all(|(_, light)| (light[0] - 2.0).abs() < 1e-5));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Limits
//!
//! Light is not resolved finer than patches, and single patches that differ from their neighbors are smoothed, as in
//! pictures. Errors of texels are upper limits. Triangles too thin for single precision have no texels; [`Lightmap::notes`] tells their area.

mod atlas;
mod base;
mod clip;
mod compact;
mod connected;
mod dark;
mod dilate;
mod document;
mod encode;
mod error;
mod existing;
mod input;
mod json;
mod layout;
mod lightmap;
mod lit;
mod loose;
mod means;
mod objects;
mod observer;
mod options;
mod seams;
mod solution;
mod texels;
mod text;
mod unwrap;
mod variants;
mod write;

pub use error::LightmapError;
pub use lightmap::Lightmap;
pub use observer::{Observer, Step};
pub use options::{LightmapOptions, LightmapSides};
pub use seams::SeamSteps;
pub use solution::Solution;
pub use write::LightmapFiles;
