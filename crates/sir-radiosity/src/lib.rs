//! Monte Carlo radiosity with a first shot of local lines, and global lines for all further reflections.
//!
//! # Design
//!
//! The method is that of Martínez, Forés and Martín (2009), *Parallel implementation of a global line Monte Carlo
//! radiosity*, which builds on Sbert's multipath (1996, 1997). This crate computes how a range of lines changes a
//! solution. It contains no threads, ranks, files or progress reports. The caller divides the lines into ranges, and
//! accesses the state of a stage as a sequence of numbers ([`Visitor`]).
//!
//! * A [`Stage`] traces lines in rounds. [`run_stage`] runs one on the calling thread, `sir_parallel` on many.
//! * [`FirstShot`]: lines from the light sources ([`Emitter`]: surfaces, points, parallel light, the sky) carry the
//!   emitted power to the first surfaces. [`SecondShot`]: lines from the brightest patches carry what these reflect.
//! * [`ShadowRays`]: direct light at the patches by rays from there to the light sources. Where there are few sources, it
//!   has less noise than that of the first shot.
//! * Global lines pass the reflected power on, between every pair of surfaces that face each other along a line, in
//!   both directions. [`Replicas`] passes it on line by line, as published. [`Batches`] fixes the power that surfaces
//!   send while the lines of a batch are traced, so that any number of workers can share these lines.
//! * [`Repeats`]: the mean of independent runs of these stages, with standard errors from their spread.
//! * [`Solution`]: irradiance and its standard error per side of a patch. [`SensorStage`] measures irradiance at any
//!   point, [`ProbeStage`] also for any direction of the receiver, in spherical harmonics.
//! * [`ViewFactorLines`]: the shares of the power of one group of surfaces that arrive at another.
//!
//! Power is counted in whole [`Quanta`]. Sums of integers are the same in any order, for any number of workers that
//! share the tallies, and the energy [`Balance`] closes exactly. Lines are reduced to [`Segment`]s, which name the two
//! sides that see each other. A new kind of line or a new transport needs to know nothing else.
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
//! use sir_radiosity::{BatchSettings, Batches, FirstShot, Model, ShotSettings, run_stage};
//!
//! let mut builder = SceneBuilder::new();
//! let gray = Material::diffuse("gray", Rgb::splat(0.5)).emitting(Rgb::splat(1.0));
//! let gray = builder.add_material(gray);
//! shapes::cuboid(&mut builder, DVec3::ZERO, DVec3::ONE, [gray; 6], Facing::Inward);
//! let model = Model::new(builder.build()?.scene, Subdivision::PerTriangle)?;
//!
//! let (seed, lines) = (1, 100_000);
//! let shot = run_stage::<FirstShot>(ShotSettings::new(&model, lines, seed), ())?;
//! let settings = BatchSettings::new(&model, Domain::hull(model.scene.vertices()), lines, seed);
//! let solution = run_stage::<Batches>(settings, shot)?.solution(&model);
//!
//! model.mesh.for_each_side(|triangle, _, _, side| {
//!     let radiosity = solution.radiosity(&model, triangle, Side::Front, side);
//!     let sigma = solution.standard_error(&model, triangle, side);
//!     assert!((radiosity - 2.0).abs().cmplt(5.0 * sigma).all(), "{radiosity} ± {sigma}");
//! });
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod aimed;
mod batches;
mod build_accel;
mod counted;
mod emitter;
mod error;
mod first_shot;
mod focus_sides;
mod glare;
mod global;
mod grouping;
mod line_numbers;
mod local_shot;
mod model;
mod patch_side;
mod power;
mod probes;
mod received;
mod repeated_sums;
mod repeated_totals;
mod repeats;
mod replicas;
mod second_shot;
mod segments;
mod sensors;
mod shadow_rays;
mod shot;
mod solution;
mod sources;
mod stage;
mod tallies;
mod totals;
mod transported;
mod view_factors;
mod visitor;
mod workers;

pub use batches::{BatchSettings, Batches, crossings_per_patch};
pub use build_accel::build_accel;
pub use counted::{Counted, CountedPower};
pub use emitter::{Emitter, SkyAperture};
pub use error::SolveError;
pub use first_shot::FirstShot;
pub use focus_sides::FocusSides;
pub use glare::{GlareSources, error_of_rating, unified_glare_rating};
pub use grouping::Grouping;
pub use local_shot::LocalShot;
pub use model::{Model, ModelError};
pub use patch_side::PatchSide;
pub use power::{POWERS, PowerUnit, Quanta};
pub use probes::{
    COSINE_FACTORS, HARMONICS, ProbeGatherer, ProbeMeasurement, ProbeStage, ProbeTask, RepeatedProbes,
    harmonics, share_of_backs, sum_of_harmonics,
};
pub use received::Received;
pub use repeated_totals::RepeatedTotals;
pub use repeats::{MIN_REPEATS, Repeats};
pub use replicas::{Replica, ReplicaSettings, Replicas};
pub use second_shot::SecondShot;
pub use segments::{End, Segment, Segments};
pub use sensors::{
    Gatherer, Measurement, REPLICATIONS, RepeatedMeasurements, Sensor, SensorSettings, SensorStage,
    SensorStart, SensorTask, SpreadOfMean,
};
pub use shadow_rays::{ShadowRaySettings, ShadowRays};
pub use shot::{Points, Shot, ShotSettings};
pub use solution::{Solution, in_quadrature};
pub use sources::{Source, emits, sources, total_power};
pub use stage::{AnyOrder, Chain, Stage, chain_units, run_stage, share};
pub use totals::{Balance, Counts, StageTotals};
pub use transported::{Transported, Walked};
pub use view_factors::{
    Accuracy, Closed, ClosureError, MAX_GROUPS, Receiver, Residual, Share, ViewFactorLines,
    ViewFactorSettings, ViewFactorTask, ViewFactors,
};
pub use visitor::Visitor;
pub use workers::{Job, OneWorker, Workers};
