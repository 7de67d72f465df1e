//! Pictures, lit meshes and tables from a radiosity solution.
//!
//! # Design
//!
//! A solution is one irradiance for every side of every patch, and that is all this crate asks for: a scene, its
//! patches, and a slice of numbers, whoever computed them. It knows no solver, no threads of others and no
//! command line.
//!
//! Three kinds of output come from it:
//!
//! * **To look at.** [`DisplayMesh`] turns constant patches into a smooth mesh, once, and pictures ([`render`],
//!   [`write_png`], [`write_exr`]) and the model for viewers ([`write_glb`]) both show that mesh. What makes such a
//!   mesh look wrong is well known (Cohen and Wallace 1993, chapter 8), and each cause has its remedy here. Cracks:
//!   all vertices on a common edge are shared. Colors that run: irradiance is interpolated, and reflectance is
//!   applied afterwards. Light that creeps around corners or through walls: which surfaces continue each other
//!   is decided around each edge, and not by looking at normals alone. Bands: dithering.
//! * **To measure.** EXR files and the attribute `_RADIOSITY` of GLB files are linear and not clamped, and a
//!   [`Table`] holds the solution itself, patch by patch and not interpolated, with its standard error.
//! * **To compare.** [`compare`] says how far two tables are apart, in units of the mean and of their own errors.
//!
//! Pictures are drawn by tracing the *scene's* triangles and interpolating in the patch that is hit, so they need
//! no second acceleration structure, and a million patches cost no more than one.
//!
//! Every file appears whole or not at all ([`write_atomically`]).
//!
//! # Limits
//!
//! A patch that is half under a cupboard has one irradiance, the mean of light and dark, so the shadow of a contact
//! is as wide as a patch. Meshing along the borders of shadows would be the remedy; smaller patches are.
//!
//! # Example
//!
//! ```
//! use glam::DVec3;
//! use sir_accel::{Accel, Options};
//! use sir_geom::{Material, Rgb, SceneBuilder, shapes::{self, Facing}};
//! use sir_mesh::{PatchMesh, Subdivision};
//! use sir_view::{DisplayMesh, Exposure, PictureSettings, default_camera, render};
//!
//! let mut builder = SceneBuilder::new();
//! let gray = builder.add_material(Material::diffuse("gray", Rgb::splat(0.5)));
//! shapes::cuboid(&mut builder, DVec3::ZERO, DVec3::ONE, [gray; 6], Facing::Inward);
//! let scene = builder.build()?.scene;
//! let mesh = PatchMesh::new(&scene, Subdivision::MaxArea(0.01))?;
//!
//! // In place of a solver: the same light everywhere.
//! let irradiance = vec![Rgb::splat(2.0); mesh.side_count()];
//!
//! let display = DisplayMesh::new(&scene, &mesh, &irradiance);
//! let corners: Vec<_> = scene.triangles().iter().map(|triangle| triangle.vertices.map(|v| v.0)).collect();
//! let accel = Accel::build(scene.vertices(), &corners, Options::default())?;
//! let camera = default_camera(&display, &accel, DVec3::Y);
//! let settings = PictureSettings { width: 40, height: 30, grid: 2, threads: 1 };
//! let picture = render(&display, &accel, &camera, settings)?;
//!
//! let radiance = 0.5 * 2.0 / std::f64::consts::PI;
//! assert!(picture.radiance.iter().all(|pixel| (f64::from(pixel[0]) - radiance).abs() < 1e-6));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod atomic_file;
mod camera_rays;
mod display;
mod error;
mod exposure;
mod exr;
mod glb;
mod map;
mod picture;
mod png;
mod render;
mod table;
mod tone;
mod viewpoint;

pub use atomic_file::write_atomically;
pub use display::{DisplayMesh, DisplayPiece, DisplayVertex};
pub use error::ViewError;
pub use exposure::Exposure;
pub use exr::write_exr;
pub use glb::write_glb;
pub use map::{Map, write_map};
pub use picture::{Picture, PictureSettings};
pub use png::write_png;
pub use render::render;
pub use sir_geom::luminance;
pub use table::{BandComparison, COLUMNS, Comparison, Row, Table, WorstRow, compare};
pub use tone::{srgb, tone_map};
pub use viewpoint::{default_camera, guess_up};
