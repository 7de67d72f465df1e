//! The display mesh, shown by pictures and GLB files.

mod build;
mod denoise;
mod levels;
mod mesh;
mod node;
mod outlines;
mod polygons;
mod smooth;

pub use mesh::{DisplayMesh, DisplayPiece, DisplayVertex};
