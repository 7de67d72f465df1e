//! Repetition of section 5 of Martínez, Forés and Martín (2009) on any pipelines: `sir experiment`.
//!
//! The program runs *itself* on pipelines derived from the given ones, one run after the other, and compares their
//! results. Statistics that need no solution are counted in its own process. The directory of each run is kept, with
//! its pipeline and its report, so that an interrupted experiment continues with the missing runs.
//!
//! * `subject`: a pipeline, and the pipelines derived from it; `runs`: makes each run once; `scene`: all parts of the
//!   experiment on one scene.
//! * A module for each part computes numbers and writes a section: `speed` (scaling), `precision` (error), `mix`,
//!   `bodies` (domains), `spread`, `farm`.
//! * `paper`: the published numbers; `verdict`: the comparison with them; `document`: the report.

mod accuracy;
mod agenda;
mod bodies;
mod command;
mod crossings;
mod curves;
mod document;
pub(crate) mod error;
mod farm;
mod files;
mod lines;
mod machine;
mod markdown;
mod mix;
mod options;
mod paper;
mod precision;
mod runs;
mod scene;
mod speed;
mod spread;
mod subject;
mod verdict;

pub use command::experiment;
pub use error::ExperimentError;
pub use options::{ExperimentOptions, Part};
