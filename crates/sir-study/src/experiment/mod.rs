//! Section 5 of Martínez, Forés and Martín (2009), repeated on any pipelines: `sir experiment`.
//!
//! The program runs *itself* on pipelines that are derived from those it is given, one run after the other, and compares
//! their results; what needs no solution it counts in its own process. Each run has a directory that is kept, with its
//! pipeline and its report: an experiment that was interrupted goes on with the runs that are missing.
//!
//! * `subject`: a pipeline, and those derived from it; `runs`: making them, once; `scene`: what is made for one.
//! * A module for each part finds numbers and writes a section: `speed` (scaling), `precision` (error), `mix`, `bodies`
//!   (domains), `spread`, `farm`.
//! * `paper`: what was published; `verdict`: whether the numbers agree; `document`: the report.

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
