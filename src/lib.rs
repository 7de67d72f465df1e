//! **SIR**: parallel global-line Monte Carlo radiosity.
//!
//! Computes the light in a scene in ten lines of code, with standard errors, on all cores:
//!
//! ```
//! use std::path::Path;
//! use sir::geom::{LoadOptions, load};
//! use sir::parallel::Solver;
//!
//! let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/cornell-box/cornell-box.gltf"));
//! let scene = load(path, &LoadOptions::default())?.scene;
//! let solved = Solver::new(scene).patches(2_000).first_shot(50_000).multipath(100_000).seed(1).solve()?;
//! solved.for_each_side(|side| {
//!     assert!(side.radiosity.is_finite() && side.error.is_finite());
//! });
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! There are three ways to use SIR:
//!
//! * *Pipeline files*: `sir run room.ron`, or [`pipeline::run`](fn@pipeline::run) and
//!   [`pipeline::check`](fn@pipeline::check) from Rust.
//! * *Solver*: [`parallel::Solver`], or single stages with [`parallel::Executor`].
//! * *Single crates*: each crate can be used on its own; [`accel`] and [`lines`] need no scene.
//!
//! This package only re-exports the crates of the workspace.

pub use sir_accel as accel;
pub use sir_cli as cli;
pub use sir_geom as geom;
pub use sir_lines as lines;
pub use sir_mesh as mesh;
pub use sir_parallel as parallel;
pub use sir_pipeline as pipeline;
pub use sir_radiosity as radiosity;
pub use sir_report as report;
pub use sir_scenes as scenes;
pub use sir_view as view;
