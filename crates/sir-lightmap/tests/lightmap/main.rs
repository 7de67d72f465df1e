//! Tests of lightmaps.
#![allow(clippy::unwrap_used, clippy::panic, reason = "tests may panic")]

mod gltf;
mod layouts;
mod scenes;
mod texels;
