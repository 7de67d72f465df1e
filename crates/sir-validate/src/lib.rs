//! Cases of diffuse light transport whose answers are known, and how far SIR's are from them.
//!
//! # Design
//!
//! A [`Reference`] is a list of cases with exact answers (`data/`). [`validate`] makes a scene of each, lights it several times with
//! independent random numbers, and compares the mean with the exact answer in standard errors of the mean. The noise is judged by how far the
//! runs are apart, not by what a single run says about itself: what patches of a surface receive is correlated, and the
//! solver's own error estimates are among the things that could be wrong. Runs are added until the standard error is small enough to mean
//! something ([`Effort::precision`]); an answer passes if it is within four of them ([`LIMIT`]).
//!
//! * `shape`: triangles for the shapes of the reference; `light`: scenes, and the mean light of their surfaces.
//! * A module for each kind of case makes *trials* of it: quantities, and a function that estimates them with a seed.
//! * `repeat` repeats them, `estimate` and [`Check`] judge, `runner` counts lines, `report` makes tables.
//!
//! A report is a function of reference, effort, seed and chosen cases; threads make it faster, not different.
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
