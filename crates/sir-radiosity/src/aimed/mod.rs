//! Rays aimed at emitting surfaces: which surface a ray from a point aims at, and at which point of it.

mod emitters;
mod seen;
mod tree;

pub(crate) use emitters::{Aim, Choice, Emitters};
