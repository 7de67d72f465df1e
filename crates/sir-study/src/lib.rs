//! Studies of the solver: the speed-up by more threads and ranks ([`scaling`]), and the experiment of Martínez, Forés
//! and Martín (2009) ([`experiment`]).
//!
//! Both run the program `sir` repeatedly on pipelines, read its reports, and write tables, diagrams and text. This
//! crate is not published: it is for developers of the solver and for readers of the paper. `examples/two_threads.rs`
//! measures without the program, because [`scaling::measure`] takes any function that makes a run.

mod error;
pub mod experiment;
pub mod scaling;

pub use error::StudyError;
