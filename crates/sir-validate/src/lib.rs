//! Validation of SIR with cases of diffuse light transport that have exact answers.
//!
//! # Design
//!
//! A [`Reference`] is a list of cases with exact answers (`data/`). [`validate`] builds a scene of each case, runs the
//! solver several times with independent random numbers, and compares the mean with the exact answer in standard errors
//! of the mean. The standard error comes from the spread of the runs, not from the error that a single run states: what
//! patches of a surface receive is correlated, and the solver's own error estimates are among the things that could be
//! wrong. Runs are added until the standard error is small enough to be meaningful ([`Effort::precision`]). An answer
//! passes if it is within four standard errors ([`LIMIT`]).
//!
//! * `shape` makes triangles for the shapes of the reference. `light` makes scenes, and computes the mean light of
//!   their surfaces.
//! * A module for each kind of case makes its *trials*: quantities, and a function that estimates them with a seed.
//!   `luminaire` has several files: its trials begin with the text of a photometric file.
//! * `repeat` repeats trials, `estimate` and [`Check`] compare them with exact answers, `runner` counts lines, and
//!   `report` makes tables.
//!
//! A report is a function of reference, effort, seed and selected cases; it does not depend on the number of threads.
//!
//! # Example
//!
//! ```
//! use std::num::NonZeroUsize;
//! use sir_validate::{Effort, Reference, Settings, Watcher, validate};
//!
//! struct Patient;
//! impl Watcher for Patient {
//!     fn begin(&mut self, _case: &str, _title: &str) {}
//!     fn progress(&mut self, _done: u64, _total: u64) {}
//!     fn should_stop(&self) -> bool { false }
//! }
//!
//! let settings =
//!     Settings { effort: Effort::Quick, seed: 1, threads: NonZeroUsize::MIN, cases: vec!["RE-08".into()] };
//! let report = validate(&Reference::built_in()?, &settings, &mut Patient)?;
//! assert!(report.passed());
//! # Ok::<(), sir_validate::ValidateError>(())
//! ```

#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod catalog;
mod check;
mod cube;
mod data;
mod effort;
mod error;
mod estimate;
mod factors;
mod flux;
mod light;
mod luminaire;
mod points;
mod radiosity;
mod repeat;
mod report;
mod room;
mod runner;
mod shape;
mod trial;
mod validate;

pub use check::{Check, LIMIT, Verdict};
pub use data::{FILES, Reference};
pub use effort::Effort;
pub use error::ValidateError;
pub use report::{Outcome, Report};
pub use runner::Watcher;
pub use validate::{Settings, validate};
