//! Who runs which lines: threads, MPI ranks, and restarts.
//!
//! # Design
//!
//! A stage is a range of line indices `[0, N)`, a line is a pure function of its index, and what lines change are integers
//! to which they only add. So the result is the same whoever traces which lines, in whatever order. This crate decides who
//! does; what a line does is none of its business.
//!
//! * A [`Crew`] is some ranks with some threads each. Threads take small blocks of lines from a common counter and write
//!   to one shared ledger; ranks have equal shares of the lines, and add up their ledgers when the stage asks for it.
//! * A [`Communicator`] does one thing: it replaces numbers by their sums over all ranks. [`Alone`] is a single process;
//!   [`connect`] gives MPI if the crate was built with the feature `mpi`.
//! * The state of a stage is a sequence of numbers that a [`Visitor`](sir_radiosity::Visitor) sees. One visitor adds them up
//!   over the ranks, one saves them ([`Checkpoints`]), one puts them back ([`Saved`]). A checkpoint holds sums over all
//!   workers, so any number of them can go on from it. What was computed before the stage and is still needed goes with it
//!   ([`Earlier`]).
//! * Four times a second all ranks agree on how many lines to trace next, whether to save, and whether to stop. This
//!   changes nothing in the result.
//!
//! [`first_shot`], [`batches`] and [`multipath`] run the stages of the solver, [`measure`] its sensors; [`view_factors`] stands by itself. In multipath
//! what a line carries depends on the lines before it; there, threads and ranks share replicas instead of lines.
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
//! use sir_parallel::{Crew, batches, first_shot};
//! use sir_radiosity::Model;
//!
//! let mut builder = SceneBuilder::new();
//! let grey = Material::diffuse("grey", Rgb::splat(0.5)).emitting(Rgb::splat(1.0));
//! let grey = builder.add_material(grey);
//! shapes::cuboid(&mut builder, DVec3::ZERO, DVec3::ONE, [grey; 6], Facing::Inward);
//! let model = Model::new(builder.build()?.scene, Subdivision::PerTriangle)?;
//! let domain = Domain::hull(model.scene.vertices());
//!
//! let solve = |threads: usize| {
//!     let crew = &mut Crew::of(NonZeroUsize::new(threads).unwrap_or(NonZeroUsize::MIN));
//!     let (lines, seed) = (20_000, 1);
//!     let shot = first_shot(&model, lines, seed, crew, None)?.outcome;
//!     batches(&model, shot, lines, domain.clone(), seed, crew, None)
//! };
//! assert_eq!(solve(1)?.outcome.received, solve(3)?.outcome.received);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod checkpoint;
mod communicator;
mod connect;
mod crew;
mod error;
mod measure;
#[cfg(feature = "mpi")]
mod mpi;
mod observer;
mod replicas;
mod stages;
mod view_factors;

pub use checkpoint::{Checkpoints, Saved};
pub use communicator::{Alone, Communicator};
pub use connect::{ConnectError, HAS_MPI, connect};
pub use crew::{Crew, Earlier, StageTime, cores};
pub use error::{CheckpointError, RunError};
pub use measure::measure;
pub use observer::{Observer, Silent};
pub use stages::{StageRun, batches, first_shot, multipath, second_shot};
pub use view_factors::view_factors;
