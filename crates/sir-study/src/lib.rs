//! Studies of the solver: how much faster more workers are ([`scaling`]), and the experiment of Martínez, Forés and Martín (2009)
//! ([`experiment`]).
//!
//! Both run the program `sir` again and again on pipelines, read the reports, and write tables, diagrams and text. This crate is not
//! published: it is of use to those who work on the solver, and to readers of the paper. `examples/two_threads.rs` measures without the
//! program: [`scaling::measure`] takes any function that makes a run.

mod error;
pub mod experiment;
pub mod scaling;

pub use error::StudyError;
