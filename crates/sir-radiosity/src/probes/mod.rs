//! Irradiance at points as a function of the normal of the receiver, for objects that move through a scene.
//!
//! A probe is six sensors at one point that look along the axes. Their rays are those of sensors, with the same errors.
//! Each ray also counts for the nine coefficients of the irradiance in spherical harmonics, with the share of the
//! harmonic that belongs to its sensor, so that the coefficients are unbiased: no higher degree of the light leaks into
//! them, as it would if they were fitted to irradiances in some directions.

mod gatherer;
mod harmonics;
mod measurement;
mod repeated;
mod replication;
mod stage;
mod view;

pub use gatherer::ProbeGatherer;
pub use harmonics::{COSINE_FACTORS, HARMONICS, harmonics, sum_of_harmonics};
pub use measurement::ProbeMeasurement;
pub use repeated::RepeatedProbes;
pub use stage::{ProbeStage, ProbeTask};
pub use view::share_of_backs;
