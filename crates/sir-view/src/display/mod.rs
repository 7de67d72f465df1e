//! The mesh that pictures and models show.

mod build;
mod denoise;
mod levels;
mod mesh;
mod outline;
mod points;
mod seams;
mod smooth;

pub use mesh::{DisplayMesh, DisplayPiece, DisplayVertex};
