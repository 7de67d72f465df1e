//! Monte Carlo radiosity with a first shot of local lines, and global lines for all further reflections.
//!
//! # Design
//!
//! The method is that of Martínez, Forés and Martín (2009), *Parallel implementation of a global line Monte Carlo
//! radiosity*, with Sbert's multipath (1996, 1997) at its heart. This crate knows how a range of lines changes a
//! solution. It knows nothing of threads, ranks, files or progress: those who do cut the ranges, and see the state of a
//! stage as a sequence of numbers ([`Visitor`]).
//!
//! * [`FirstShot`]: lines from the light sources ([`Emitter`]: surfaces, points, parallel light, the sky) carry the emitted power to
//!   the first surfaces.
//! * Lines through the whole scene pass the reflected power on, between every pair of surfaces that face each other
//!   along a line, in both directions. [`Multipath`] sends it on line by line, as published. [`Batches`] freezes
//!   what surfaces send while the lines of a batch are traced, so that any number of workers can share them.
//! * [`Repeats`]: the mean of independent runs of these stages, with the errors that their spread shows.
//! * [`Solution`]: irradiance and its standard error per side of a patch. [`Sensors`] measure it at any other point.
//! * [`ViewFactorLines`] count which share of the light of one group of surfaces arrives at another.
//!
//! Power is counted in whole [`Quanta`]: integers add up to the same sum in any order, by any number of workers who
//! share a ledger, and the energy [`Balance`] closes exactly, not nearly. Lines become [`Segment`]s, which name the two sides that see each other:
//! a new kind of line or a new transport needs to know nothing else.
//!
//! # Example
//!
//! In a closed box whose faces all emit `M` and reflect `ρ`, the radiosity is `M / (1 − ρ)` everywhere.
//!
//! ```
//! use glam::DVec3;
//! use sir_geom::{Material, Rgb, SceneBuilder, Side, shapes::{self, Facing}};
//! use sir_lines::Domain;
//! use sir_mesh::Subdivision;
//! use sir_radiosity::{Books, FirstShot, Model, Multipath, MultipathSettings};
//!
//! let mut builder = SceneBuilder::new();
//! let grey = Material::diffuse("grey", Rgb::splat(0.5)).emitting(Rgb::splat(1.0));
//! let grey = builder.add_material(grey);
//! shapes::cuboid(&mut builder, DVec3::ZERO, DVec3::ONE, [grey; 6], Facing::Inward);
//! let model = Model::new(builder.build()?.scene, Subdivision::PerTriangle)?;
//!
//! let (seed, lines) = (1, 100_000);
//! let shot = FirstShot::new(&model, lines, seed)?;
//! let (tally, mut books) = (shot.tally(1), Books::default());
//! shot.trace(0, 0..lines, &tally, &mut books);
//! let shot = shot.finish(tally, books)?;
//!
//! let domain = Domain::hull(model.scene.vertices());
//! let settings = MultipathSettings::new(lines, domain);
//! let multipath = Multipath::new(&model, shot, settings, seed, 1);
//! let mut books = Books::default();
//! multipath.trace(0, &mut multipath.replica(0), lines, &mut books);
//! let solution = multipath.finish(books)?.solution;
//!
//! model.mesh.for_each_side(|triangle, _, _, side| {
//!     let radiosity = solution.radiosity(&model, triangle, Side::Front, side);
//!     let sigma = solution.standard_error(&model, triangle, side);
//!     assert!((radiosity - 2.0).abs().cmplt(4.0 * sigma).all(), "{radiosity} ± {sigma}");
//! });
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod balance;
mod batches;
mod build_accel;
mod emitter;
mod error;
mod first_shot;
mod global;
mod grouping;
mod inside;
mod ledger;
mod model;
mod multipath;
mod power;
mod received;
mod repeats;
mod second_shot;
mod segments;
mod sensors;
mod solution;
mod sources;
mod state;
mod view_factors;

pub use balance::{Balance, Books, Counts};
pub use batches::{Batches, Part, Totals};
pub use build_accel::build_accel;
pub use emitter::{Emitter, Opening};
pub use error::SolveError;
pub use first_shot::{FirstShot, FirstShotTally, Shot};
pub use grouping::Grouping;
pub use inside::Inside;
pub use model::{Model, ModelError};
pub use multipath::{Multipath, MultipathSettings, Replica, Transported, share};
pub use power::{PowerUnit, Quanta};
pub use received::Received;
pub use repeats::{ENOUGH, RepeatedBooks, Repeats};
pub use second_shot::SecondShot;
pub use segments::{End, Segment, Segments};
pub use sensors::{LIFT, Measurement, REPLICATIONS, Sensor, SensorSettings, Sensors};
pub use solution::Solution;
pub use sources::{Source, emits, sources};
pub use state::Visitor;
pub use view_factors::{
    Accuracy, Closed, ClosureError, MAX_GROUPS, Receiver, Residual, Share, ViewFactorLines,
    ViewFactorSettings, ViewFactors,
};
