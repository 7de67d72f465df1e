//! Checks of dependencies (*arrows*): between crates they point downward, as the design allows, and between the files
//! of a crate they have no cycles.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod circles;
mod crates;
mod files;
mod modules;
mod names;
