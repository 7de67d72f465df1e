//! Pipelines: a text file says what to do with a scene, and this crate does it.
//!
//! # Design
//!
//! A pipeline file is RON: a list of stages, each of which turns what earlier ones made into something new. The stages
//! are thin; the work lies in the crates below. What this crate adds is the way from text to files:
//!
//! * *All mistakes of a file at once, each at its place.* serde stops at the first error, so the file is parsed to a
//!   tree whose nodes know their place, and read with a list of problems ([`text`]). Fields are declared once ([`plan`]): from
//!   there come the reader, the writer and the tables of the reference. A [`Pipeline`](plan::Pipeline) is valid by
//!   construction: the order of its stages, its numbers and its paths have been checked, and nothing is written before its scene
//!   has been read.
//! * *A library.* It prints nothing, knows no arguments and no signals: a [`Progress`] is told how far a run is, and a flag in
//!   [`RunOptions`] ends it.
//! * *A run directory is complete if and only if it holds a `result.json`* ([`report`]), which is written last; files appear whole
//!   or not at all.
//! * *The same pipeline gives the same bytes,* except for the times in `result.json`.
//!
//! # Doors
//!
//! [`check`](fn@check) says what a pipeline will do and cost, [`run`](fn@run) does it:
//!
//! ```
//! use sir_pipeline::{RunOptions, check, run};
//! # use std::path::Path;
//! # let folder = tempfile::tempdir()?;
//! # let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/furnace/furnace.gltf");
//! # std::fs::copy(scene, folder.path().join("furnace.gltf"))?;
//! # let path = &folder.path().join("furnace.ron");
//! # let text = r#"Pipeline(stages: [Load(path: "furnace.gltf"), FirstShot(lines: 2_000), Multipath(lines: 2_000)])"#;
//! # std::fs::write(path, text)?;
//!
//! let estimate = check(path)?;
//! println!("{} patches", estimate.prepared.model.mesh.patch_count());
//!
//! let options = RunOptions { out: Some(folder.path().join("result")), ..RunOptions::default() };
//! let done = run(path, &options)?;
//! for stage in &done.report.stages {
//!     println!("{} took {} s", stage.name, stage.time.seconds);
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Mistakes are shown with their places:
//!
//! ```
//! use std::path::Path;
//! use sir_pipeline::plan::Pipeline;
//!
//! let text = r#"Pipeline(stages: [FirstShot(line: 1_000_000)])"#;
//! let problems = Pipeline::parse(text, Path::new("room.ron")).unwrap_err();
//! let shown = problems.to_string();
//! assert!(shown.contains("error: unknown field `line` in `FirstShot`\n --> room.ron:1:29\n"));
//! assert!(shown.contains("= help: did you mean `lines`?"));
//! ```
//!
//! # Where things are
//!
//! | folder | from | to |
//! |---|---|---|
//! | [`text`] | RON | declared types, or all mistakes |
//! | [`plan`] | the text of a pipeline | what it says, with every default filled in |
//! | [`prepare`] | a plan | scene, patches, acceleration structure, places of sensors |
//! | [`mod@check`] | a plan | memory and time that it will take |
//! | [`mod@run`] | a plan | light, files and a [`report`]; resuming |
//! | [`info`] | a scene file | what is in it, and what a pipeline should set |
//! | [`view_factors`] | a scene file | view factors of its parts |

pub mod check;
mod error;
mod error_kind;
pub mod fingerprint;
pub mod format;
pub mod info;
mod memory;
pub mod plan;
pub mod prepare;
pub mod progress;
mod ranks;
pub mod report;
pub mod run;
pub mod stopwatch;
pub mod text;
mod units;
pub mod view_factors;

pub use check::check;
pub use error::{Error, chain};
pub use error_kind::ErrorKind;
pub use progress::{NoProgress, Progress};
pub use run::{RunOptions, RunResult, resume, run};
pub use units::Units;
