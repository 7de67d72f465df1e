//! The display mesh, shown by pictures and GLB files.

mod build;
mod denoise;
mod levels;
mod mesh;
mod outline;
mod points;
mod seams;
mod smooth;

pub use mesh::{DisplayMesh, DisplayPiece, DisplayVertex};
pub(crate) use seams::extent;
