//! Line sampling for light transport: global lines through a convex body, local lines from a surface or a point, and
//! the random or low-discrepancy points that samplers map to lines.
//!
//! # Design
//!
//! *A sampler is a function.* It maps a point `[f64; K]` of the unit cube `[0, 1)^K` to a line, a direction or a
//! position. Uniform points give the density that the documentation of the sampler states. Any point sequence can be
//! used: [`random_point`] draws points from any generator of the crate [`rand`], [`R2Sequence`] is a low-discrepancy
//! sequence, and callers can supply their own.
//!
//! | sampler | K | result |
//! |---|---|---|
//! | [`Domain::line`], [`GlobalLines::line`] | 6 | a uniform (isotropic) line through a convex body |
//! | [`ParallelLines::line`] | 3 | a line of one direction through a box |
//! | [`cosine_direction`] | 2 | a direction of diffuse light |
//! | [`unit_vector`] | 2 | a uniform direction |
//! | [`spot_direction`] | 5 | a direction of a spot light |
//! | [`point_on_triangle`], [`continuous_point_on_triangle`] | 2 | a uniform point of a triangle |
//!
//! *A line is a function of (seed, stage, index).* [`Streams`] gives each line its own random stream, so the line is
//! the same whichever thread or process traces it, before or after a restart. A [`Stream`] also implements the
//! generator traits of `rand`.
//!
//! *Bit-identical on every machine.* This crate converts raw bits to numbers itself, and samplers use only `+ − × ÷ √`.
//!
//! *Crossings can be forecast.* Uniform lines through a convex body cross a surface of area `A` inside it in proportion
//! to `A` (Cauchy and Crofton). [`Forecast`] returns the expected number of crossings. [`GlobalLines`] can draw a
//! larger share of the lines through a part of the scene, a [`Focus`], and gives each line the weight that compensates
//! for it. [`Allocation`] distributes lines among light sources by systematic sampling.
//!
//! The crate does not depend on a scene: a [`Domain`] is built from points, a box or a sphere. [`ConvexHull`] is exact
//! for any set of points.
//!
//! # Example
//!
//! The number of random lines that cross a disc of area 1 inside the unit sphere:
//!
//! ```
//! use rand::{SeedableRng, rngs::SmallRng};
//! use sir_lines::{Domain, random_point};
//! use sir_types::BoundingSphere;
//!
//! let domain = Domain::Sphere(BoundingSphere { center: glam::DVec3::ZERO, radius: 1.0 });
//! let mut generator = SmallRng::seed_from_u64(7);
//! let disc = 1.0 / std::f64::consts::PI; // squared radius of a disc of area 1 in the plane z = 0
//! let lines = 100_000;
//! let crossings = (0..lines)
//!     .map(|_| domain.line(random_point(&mut generator)))
//!     .filter(|line| line.at(-line.origin.z / line.direction.z).length_squared() < disc)
//!     .count() as f64;
//! let expected = domain.forecast(lines).crossings(1.0);
//! assert!((crossings - expected).abs() < 4.0 * expected.sqrt());
//! ```
//!
//! The share of the diffuse light of a small patch that meets a parallel disc of radius 1 at distance 1 is one half. A
//! low-discrepancy sequence needs only a few lines to estimate it:
//!
//! ```
//! use glam::DVec3;
//! use sir_lines::{R2Sequence, cosine_direction};
//!
//! let points = R2Sequence::new([0.3, 0.8]);
//! let lines = 1000;
//! let meet = (0..lines)
//!     .map(|i| cosine_direction(DVec3::Z, points.at(i)))
//!     .filter(|direction| direction.x.hypot(direction.y) < direction.z)
//!     .count() as f64;
//! assert!((meet / lines as f64 - 0.5).abs() < 0.005);
//! ```

#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod alias;
mod allocation;
mod domain;
mod facets;
mod focus;
mod forecast;
mod hull;
mod local;
mod parallel;
mod point;
mod r2_sequence;
mod sobol;
mod stream;
mod turn;

pub use allocation::Allocation;
pub use domain::Domain;
pub use facets::Facets;
pub use focus::{Focus, GlobalLines, LocalLines, MAX_FOCUS_DENSITY};
pub use forecast::Forecast;
pub use hull::ConvexHull;
pub use local::{
    continuous_point_on_triangle, cosine_direction, point_on_triangle, spot_direction, unit_vector,
};
pub use parallel::ParallelLines;
pub use point::{Numbers, random_point};
pub use r2_sequence::R2Sequence;
pub use sobol::{SobolPoint, SobolPoints};
pub use stream::{Purpose, Stream, Streams, seed_of_repeat};
