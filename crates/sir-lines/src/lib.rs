//! Lines: where they come from, how many will cross a surface, and their random numbers.
//!
//! # Design
//!
//! A *line is a pure function of (seed, stage, index)*. [`Streams`] gives every line its own random stream, so it
//! does not matter which thread, rank or restart traces it. Floats are made from raw bits here, and directions and
//! points use only `+ − × ÷ √`, because those give the same bits on every machine.
//!
//! * Global lines: a [`Domain`] is a convex body around the scene: its convex hull, its box, or a sphere. The uniform
//!   (isotropic) lines of the body meet a surface of area `A` in proportion to `A`, which integral geometry turns into a
//!   [`Forecast`] of the number of crossings.
//! * [`GlobalLines`] are those of a domain, and maybe more of them through a part of the scene that matters, a [`Focus`].
//! * Local lines: [`cosine_direction`] and [`point_on_triangle`] leave one surface as diffuse light does; [`unit_vector`] and
//!   [`spot_direction`] leave a point. [`ParallelLines`] come from one direction.
//! * [`EvenPoints`] are random, but not independent: for integrals over few lines, each of which has to count.
//! * [`Allocation`] shares a number of lines among sources in proportion to their power.
//!
//! # Example
//!
//! How often do lines cross a disc of area 1 inside the unit sphere?
//!
//! ```
//! use sir_geom::BoundingSphere;
//! use sir_lines::{Domain, Stage, Streams};
//!
//! let domain = Domain::Sphere(BoundingSphere { centre: glam::DVec3::ZERO, radius: 1.0 });
//! let streams = Streams::new(7, Stage::GLOBAL);
//! let lines = 100_000;
//! let disc = 1.0 / std::f64::consts::PI; // squared radius of a disc of area 1 in the plane z = 0
//! let counted = (0..lines)
//!     .map(|i| domain.sample(&mut streams.line(i)))
//!     .filter(|l| {
//!         let hit = l.at(-l.origin.z / l.direction.z);
//!         hit.length_squared() < disc
//!     })
//!     .count() as f64;
//! let expected = domain.forecast(lines).crossings(1.0);
//! assert!((counted - expected).abs() < 4.0 * expected.sqrt());
//! ```

mod alias;
mod allocation;
mod domain;
mod even;
mod facets;
mod focus;
mod forecast;
mod local;
mod parallel;
mod stream;
mod turn;

pub use allocation::Allocation;
pub use domain::Domain;
pub use even::EvenPoints;
pub use facets::Facets;
pub use focus::{DENSEST, Focus, GlobalLines, LocalLines};
pub use forecast::Forecast;
pub use local::{
    cosine_direction, cosine_direction_of, point_on_triangle, point_on_triangle_of, spot_direction,
    unit_vector,
};
pub use parallel::ParallelLines;
pub use stream::{Stage, Stream, Streams, seed_of_repeat};
