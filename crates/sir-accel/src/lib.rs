//! Ray tracing in triangle meshes: closest hits, occlusion and all hits along lines, exactly watertight.
//!
//! # Example
//!
//! ```
//! use glam::DVec3;
//! use sir_accel::{Accel, Line, Options, Ray};
//!
//! let positions = [DVec3::ZERO, DVec3::X, DVec3::ONE, DVec3::Y];
//! let accel = Accel::build(&positions, &[[0, 1, 2], [0, 2, 3]], Options::default())?;
//! let mut tracer = accel.tracer();
//! let line = Line { origin: DVec3::new(0.75, 0.25, 2.0), direction: DVec3::NEG_Z };
//! let hit = tracer.closest(&Ray::new(line)).expect("the line meets the first triangle");
//! assert!(hit.triangle.0 == 0 && (hit.t - 1.75).abs() < 1e-9);
//! assert!(!tracer.occluded(&Ray::new(line).within(0.0..1.5)));
//! assert_eq!(tracer.all_hits(&line).len(), 1);
//! # Ok::<(), sir_accel::AccelError>(())
//! ```
//!
//! The input is positions and indices; no scene, materials or files are needed. The plain types ([`Line`],
//! [`TriangleId`], [`Barycentric`], [`Side`]) come from `sir-types`.
//!
//! # Design
//!
//! Some methods need *every* surface along a line, in order and with the right parity: a line must cross a closed
//! surface an even number of times. Floating-point tests lose or duplicate hits on edges and corners. This crate avoids
//! that by construction instead of by tolerance:
//!
//! * Corners are rounded to an integer grid of 2³¹ steps across the bounding sphere, lines to a grid that is 256 times
//!   finer. On these grids a crossing is an exact predicate of integers. Signs of edge functions are computed in double
//!   precision where an error bound proves them, and otherwise in 128-bit integers.
//! * A line that meets an edge or a corner *exactly* is treated as shifted by an infinitesimal `(ε, ε², ε³)`
//!   (symbolic perturbation, Edelsbrunner and Mücke 1990). There is one shift for the whole line, so neighboring
//!   triangles cannot disagree. A line therefore crosses every closed triangle mesh an even number of times.
//! * Surfaces in contact (a decal on a wall, two sheets back to back) are ordered by a rule that is the same in both
//!   directions of the line, not by rounding: see [`Hit`] and [`Options::contact_priorities`].
//!
//! # Searches
//!
//! | search | one line | many lines | range |
//! |---|---|---|---|
//! | first hit | [`closest`](Tracer::closest) | [`closest_each`](Tracer::closest_each) | [`Ray::range`] |
//! | any hit | [`occluded`](Tracer::occluded) | [`occluded_each`](Tracer::occluded_each) | [`Ray::range`] |
//! | all hits | [`all_hits`](Tracer::all_hits) | [`all_hits_each`](Tracer::all_hits_each) | none |
//! | all hits in a range | [`all_hits_within`](Tracer::all_hits_within) | [`all_hits_within_each`](Tracer::all_hits_within_each) | [`TRange`] |
//!
//! A range is half-open and holds signed distances along the unit direction, `start ≤ t < end`; see [`TRange`].
//!
//! # Transparent surfaces
//!
//! A triangle of opacity `α` stops a line with the probability `α`, which may vary over the triangle
//! ([`Options::opacity`]). A hash of line and triangle decides, so all searches agree, and no random numbers are
//! needed. A line that passes continues straight, as if the triangle were not there. Parity then holds for crossings
//! but no longer for hits: a line may pass the front of a leaf and hit its back. [`Tracer::all_crossings_each`] returns
//! crossings and leaves opacity to the caller.
//!
//! # Speed
//!
//! The binary tree is optimized by `obvhs` and collapsed into nodes of sixteen boxes and leaves of eight triangles. A
//! line visits few of them, but each visit may wait for memory. So the functions for many lines keep dozens of lines
//! active, advance each by one step at a time, and prefetch the data of the next step. Boxes and triangles are culled
//! in single precision, with a margin for rounding; the remaining triangles are tested in double precision, eight at a
//! time. The algorithm is written once, generic over the SIMD backend, and compiled for AVX-512, AVX2 and plain arrays.
//! The backend is chosen at run time; the hits are the same bit for bit.

#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod accel;
mod build;
mod cluster;
mod contact;
mod error;
mod grid;
mod hit;
mod leaf;
mod line_f32;
mod memory;
mod node;
mod opacity;
mod options;
mod queries;
mod ray;
mod scratch;
mod search;
mod simd;
mod stacks;
mod tracer;
mod tree;
mod triangle;

#[cfg(test)]
mod tests;

// Test helpers are shared with the integration tests, which call the crate `sir_accel`.
#[cfg(test)]
extern crate self as sir_accel;

pub use accel::Accel;
pub use error::AccelError;
pub use hit::{Hit, LineHits};
pub use memory::{collect_in_huge_pages, prefetch};
pub use opacity::Opacity;
pub use options::Options;
pub use ray::{Ray, TRange};
pub use sir_types::{Barycentric, Line, Side, TriangleId};
pub use tracer::Tracer;
