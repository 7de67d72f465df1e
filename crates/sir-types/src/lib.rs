//! Plain types that every crate of SIR shares: lines, sides of triangles, points on triangles, boxes, spheres and
//! disjoint sets.
//!
//! # Design
//!
//! A triangle tracer needs neither a scene nor a file reader, and a sampler of lines needs no triangles. The types that
//! they share are in this crate, below all others, so that each crate can be used alone. The types are plain values in
//! double precision; none of them fails or refers to its origin.
//!
//! # Example
//!
//! ```
//! use glam::DVec3;
//! use sir_types::{BoundingBox, Line};
//!
//! let unit = BoundingBox { min: DVec3::ZERO, max: DVec3::ONE };
//! assert!(unit.meets(&Line { origin: DVec3::splat(-1.0), direction: DVec3::ONE.normalize() }));
//! ```

#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod bounds;
mod disjoint_sets;
mod index;
mod line;
mod side;

pub use bounds::{BoundingBox, BoundingSphere};
pub use disjoint_sets::DisjointSets;
pub use index::TriangleId;
pub use line::{Barycentric, Line};
pub use side::Side;
