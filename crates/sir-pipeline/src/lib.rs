//! Parses, checks and runs pipelines: text files that describe what to do with a scene.
//!
//! # Design
//!
//! A pipeline file is a list of stages in RON. Each stage works on the output of earlier ones. The stages are thin: the
//! computation is in the lower crates. This crate turns the text into output files, with these properties:
//!
//! * *All errors of a file are reported at once, each with its position.* serde stops at the first error. This crate
//!   therefore parses the file to a tree whose nodes know their position, and collects problems while it reads the tree
//!   ([`text`]). Each field is declared once ([`plan`]); the reader, the writer and the tables of the reference follow
//!   from the declaration. A [`Pipeline`](plan::Pipeline) is valid by construction: the order of its stages, its
//!   numbers and its paths have been checked. Nothing is written before the scene has been read.
//! * *It is a library.* It prints nothing, and handles neither arguments nor signals: a [`Progress`] receives the
//!   progress of a run, and a flag in [`RunOptions`] stops it.
//! * *A run directory is complete if and only if it holds a `result.json`* ([`report`]), which is written last. Files
//!   are written atomically.
//! * *The same pipeline gives the same bytes,* except for the times in `result.json`.
//!
//! # Entry points
//!
//! [`check`](fn@check) estimates the cost of a pipeline, [`run`](fn@run) runs it:
//!
//! ```
//! use sir_pipeline::{RunOptions, check, run};
//! # use std::path::Path;
//! # let folder = tempfile::tempdir()?;
//! # std::fs::write(folder.path().join("field.obj"), "v 0 0 0\nv 0 0 1\nv 1 0 0\nf 1 2 3\n")?;
//! # let path = &folder.path().join("field.ron");
//! # let text = r#"Pipeline(stages: [Load(path: "field.obj"), Light([Environment(radiance: 1)]),
//! #     FirstShot(lines: 2_000), Multipath(lines: 2_000)])"#;
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
//! Errors are shown with their positions:
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
//! # Modules
//!
//! | module | input | output |
//! |---|---|---|
//! | [`text`] | RON | declared types, or all errors |
//! | [`plan`] | the text of a pipeline | the pipeline, with every default filled in |
//! | [`prepare`] | a plan | scene, patches, acceleration structure, sensor positions |
//! | [`mod@check`] | a plan | its memory and time |
//! | [`mod@run`] | a plan | light, files and a [`report`]; also resumes runs |
//! | [`mix`] | a run directory | the same files, with dimmed light groups |
//! | [`info`] | a scene file | its contents, and recommended pipeline settings |
//! | [`view_factors`] | a scene file | view factors of its parts |

mod available_memory;
pub mod check;
pub mod draft;
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
mod run_files;
pub mod stopwatch;
pub mod text;
mod units;
pub mod view_factors;
mod watcher;

pub use check::check;
pub use error::{Error, chain};
pub use error_kind::ErrorKind;
pub use progress::{NoProgress, Progress};
pub use run::{MixOptions, RunOptions, RunResult, mix, resume, run};
pub use units::Units;
pub use watcher::Watcher;
