//! **SIR**: parallel global-line Monte Carlo radiosity.
//!
//! Ten lines from a scene to its light, with standard errors, on all cores:
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
//! Three doors for three kinds of user:
//!
//! * *A pipeline file*: `sir run room.ron`, or [`pipeline::run`](fn@pipeline::run) and [`pipeline::check`](fn@pipeline::check) from Rust.
//! * *A solver*: [`parallel::Solver`], or its stages one by one with [`parallel::Executor`].
//! * *A part*: each crate works by itself; [`accel`] and [`lines`] need no scene.
//!
//! This package only gathers the crates that do the work.

pub use sir_accel as accel;
pub use sir_cli as cli;
pub use sir_geom as geom;
pub use sir_lines as lines;
pub use sir_mesh as mesh;
pub use sir_parallel as parallel;
pub use sir_pipeline as pipeline;
pub use sir_radiosity as radiosity;
pub use sir_scenes as scenes;
pub use sir_view as view;
