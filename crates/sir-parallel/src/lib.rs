//! Who runs which lines: threads, MPI ranks, and restarts.
//!
//! [`Solver`] is the way in: ten lines from a scene to its light.
//!
//! # Design
//!
//! A [`Stage`](sir_radiosity::Stage) is some rounds of lines. A line is a pure function of its index, and what lines change are
//! integers to which they only add. So the result is the same whoever traces which lines, in whatever order. This crate decides
//! who does; what a line does is none of its business. One driver, [`Executor::run`], runs all stages.
//!
//! * An [`Executor`] is some ranks with some threads each. Threads take small blocks of lines from a common counter and write
//!   to the same tallies; ranks have equal shares of the lines, and add up their tallies at the end of each round.
//! * Where the lines of a stage are divided into chains, as in multipath, whose lines depend on those before them, threads and ranks share chains
//!   instead of lines.
//! * A [`Communicator`] does one thing: it replaces numbers by their sums over all ranks. [`SingleProcess`] is a process by itself;
//!   [`connect`] gives MPI if the crate was built with the feature `mpi`.
//! * The state of a stage is a sequence of numbers that a [`Visitor`](sir_radiosity::Visitor) sees. One visitor adds them up
//!   over the ranks, one saves them ([`Checkpoints`]), one restores them ([`Saved`]). A checkpoint holds sums over all
//!   workers, so any number of them can go on from it. Results of stages before that are still needed go with it
//!   ([`Prior`]). A stage starts [`Fresh`](Start::Fresh) from its input, or [`Resumed`](Start::Resumed) from a checkpoint.
//! * Four times a second all ranks agree on how many lines to trace next, whether to save, and whether to stop. This
//!   changes nothing in the result.
//!
//! # Example
//!
//! The light in a closed box, by one thread and by three:
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
//! assert_eq!(solve(1)?.outcome.received, solve(3)?.outcome.received);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

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
pub use time::StageTime;
