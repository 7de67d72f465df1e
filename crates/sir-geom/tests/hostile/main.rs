//! Malicious files, and broken third-party files: each ends in a scene or one clear error, in little time and memory.
//!
//! This is a separate program, because the memory of one file can only be measured if nothing else runs.

#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout, reason = "these are tests")]

mod bounded;
mod corpus;
#[allow(dead_code, reason = "other tests use the rest of it")]
#[path = "../load/files.rs"]
mod files;
mod gltf;
mod obj;
