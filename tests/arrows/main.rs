//! Dependencies point one way: between the crates downward, along the lines of the design, and between the files of a crate
//! without circles.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod circles;
mod crates;
mod files;
mod modules;
mod names;
