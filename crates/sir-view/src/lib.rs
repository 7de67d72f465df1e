//! Pictures, lit meshes and tables from a radiosity solution.
//!
//! # Design
//!
//! The input is a scene, its patches, and one irradiance per side of every patch, as a slice of numbers from any
//! source. The crate depends on no solver, no external thread pool and no command line.
//!
//! There are three kinds of output:
//!
//! * **For viewing.** [`DisplayMesh`] turns patches of constant irradiance into a smooth mesh, once. Pictures
//!   ([`render`], [`write_png`], [`write_exr`]) and the model for viewers ([`write_glb`]) both show this mesh. The
//!   artifacts of such meshes are well known (Cohen and Wallace 1993, chapter 8), and each has its remedy here.
//!   Cracks: triangles share all vertices on a common edge. Blurred material borders: irradiance is interpolated,
//!   and reflectance is applied afterwards. Light leaks around corners or through walls: the continuity of surfaces
//!   is determined around each edge, and not from normals alone. Banding: dithering.
//! * **For measurement.** EXR files and the attribute `_RADIOSITY` of GLB files are linear and not clamped. A
//!   [`Table`] holds the solution itself, per patch and not interpolated, with its standard error.
//! * **For comparison.** [`compare`] states the difference of two tables, relative to the mean and to their standard
//!   errors.
//!
//! Pictures are drawn by tracing rays against the *scene's* triangles and interpolating in the patch that is hit. They
//! need no second acceleration structure, and a million patches cost no more than one.
//!
//! All files are written atomically ([`write_atomically`]).
//!
//! # Limits
//!
//! A patch that lies half under a cupboard has one irradiance, the mean of light and dark, so a contact shadow is as
//! wide as a patch. The crate does not mesh along shadow borders (discontinuity meshing); use smaller patches.
//!
//! # Example
//!
//! ```
//! use glam::DVec3;
//! use sir_accel::{Accel, Options};
//! use sir_geom::{Material, Rgb, SceneBuilder, shapes::{self, Facing}};
//! use sir_mesh::{PatchMesh, PatchSize, Subdivision};
//! use sir_view::{DisplayMesh, Exposure, PictureSettings, default_camera, render};
//!
//! let mut builder = SceneBuilder::new();
//! let gray = builder.add_material(Material::diffuse("gray", Rgb::splat(0.5)));
//! shapes::cuboid(&mut builder, DVec3::ZERO, DVec3::ONE, [gray; 6], Facing::Inward);
//! let scene = builder.build()?.scene;
//! let mesh = PatchMesh::new(&scene, Subdivision::Triangles(PatchSize::MaxArea(0.01)))?;
//!
//! // Uniform irradiance, instead of the result of a solver.
//! let irradiance = vec![Rgb::splat(2.0); mesh.side_count()];
//!
//! let display = DisplayMesh::new(&scene, &mesh, &irradiance);
//! let corners: Vec<_> = scene.triangles().iter().map(|triangle| triangle.vertices.map(|v| v.0)).collect();
//! let accel = Accel::build(scene.vertices(), &corners, Options::default())?;
//! let camera = default_camera(&display, &accel, DVec3::Y, scene.bounding_box());
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
mod up;
mod viewpoint;

pub use atomic_file::{is_partial_file, write_atomically};
pub use display::{DisplayMesh, DisplayPiece, DisplayVertex};
pub use error::ViewError;
pub use exposure::Exposure;
pub use exr::{ExrFormat, color_channels, write_exr, write_exr_channels};
pub use glb::{write_glb, write_glb_file};
pub use map::{FalseColors, Map, write_false_colors, write_map};
pub use picture::{Picture, PictureSettings};
pub use png::write_png;
pub use render::{render, render_irradiance};
pub use sir_geom::luminance;
pub use table::{BandComparison, Comparison, Row, Table, WorstRow, compare};
pub use tone::{srgb, tone_map};
pub use up::{UpClue, more_faces_along_z, up_clues};
pub use viewpoint::default_camera;
