//! Parallel execution of line tracing: threads, MPI ranks, and checkpoints.
//!
//! [`Solver`] is the entry point: it computes the light in a scene in ten lines of code.
//!
//! # Design
//!
//! A [`Stage`](sir_radiosity::Stage) consists of rounds of lines. A line is a pure function of its index, and lines
//! only add to integers. Therefore the result does not depend on which worker traces which line, nor on their order.
//! This crate distributes lines over workers; it does not know what a line computes. One driver, [`Executor::run`],
//! runs all stages.
//!
//! * An [`Executor`] has a number of ranks with a number of threads each. Threads take small blocks of lines from a
//!   shared counter and write to shared tallies. Ranks trace equal shares of the lines and sum their tallies at the end
//!   of each round.
//! * The lines of some stages form chains, as in multipath, in which each line depends on the ones before it. Threads
//!   and ranks then share chains instead of lines.
//! * A [`Communicator`] has one operation: it replaces numbers by their sums over all ranks. [`SingleProcess`] is the
//!   trivial case of one process; [`connect`] returns the MPI ranks if the crate was built with the feature `mpi`.
//! * The state of a stage is a sequence of numbers that are passed to a [`Visitor`](sir_radiosity::Visitor). One
//!   visitor sums them over the ranks, one saves them ([`Checkpoints`]), one restores them ([`Saved`]). A checkpoint
//!   holds sums over all workers, so any number of workers can resume from it. It also holds the results of earlier
//!   stages that are still needed ([`Prior`]). A stage starts [`Fresh`](Start::Fresh) from its input or
//!   [`Resumed`](Start::Resumed) from a checkpoint.
//! * Four times a second all ranks agree on how many lines to trace next, whether to save, and whether to stop. This
//!   does not change the result.
//!
//! # Example
//!
//! The light in a closed box, computed with one thread and with three:
//!
//! ```
//! use std::num::NonZeroUsize;
//! use glam::DVec3;
//! use sir_geom::{Material, Rgb, SceneBuilder, shapes::{self, Facing}};
//! use sir_lines::Domain;
//! use sir_mesh::Subdivision;
//! use sir_parallel::{Executor, Start};
//! use sir_radiosity::{BatchSettings, Batches, FirstShot, Model, ShotSettings};
//!
//! let mut builder = SceneBuilder::new();
//! let gray = Material::diffuse("gray", Rgb::splat(0.5)).emitting(Rgb::splat(1.0));
//! let gray = builder.add_material(gray);
//! shapes::cuboid(&mut builder, DVec3::ZERO, DVec3::ONE, [gray; 6], Facing::Inward);
//! let model = Model::new(builder.build()?.scene, Subdivision::PerTriangle)?;
//!
//! let (lines, seed) = (20_000, 1);
//! let solve = |threads: usize| {
//!     let executor = &mut Executor::new(NonZeroUsize::new(threads).unwrap_or(NonZeroUsize::MIN));
//!     let shot = ShotSettings::new(&model, lines, seed);
//!     let shot = executor.run::<FirstShot>(shot, Start::Fresh(()))?.outcome;
//!     let transport = BatchSettings::new(&model, Domain::hull(model.scene.vertices()), lines, seed);
//!     executor.run::<Batches>(transport, Start::Fresh(shot))
//! };
//! assert_eq!(solve(1)?.outcome.solution(&model), solve(3)?.outcome.solution(&model));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod checkpoint;
mod communicator;
mod connect;
mod driver;
mod error;
mod executor;
#[cfg(feature = "mpi")]
mod mpi;
mod observer;
mod remaining;
mod slices;
mod solver;
mod threads;
mod time;

pub use checkpoint::{Checkpoints, Saved};
pub use communicator::{Communicator, SingleProcess};
pub use connect::{ConnectError, HAS_MPI, connect};
pub use driver::{StageRun, Start};
pub use error::{CheckpointError, RunError};
pub use executor::{Executor, Prior, cores};
pub use observer::{NoProgress, Observer};
pub use solver::{SideLight, Solved, Solver, SolverError};
pub use threads::Threads;
pub use time::StageTime;
