//! Tests of reading scene files through the public interface.

#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout, reason = "these are tests")]

mod as_it_comes;
mod broken;
mod files;
mod gltf;
mod gltf_as_written;
mod gltf_extensions;
mod gltf_lights;
mod gltf_materials;
mod obj;
mod textures;
mod third_party;
