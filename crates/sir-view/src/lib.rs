//! Being written.
mod atomic_file;
mod display;
mod error;
mod exr;
mod glb;
mod picture;
mod png;
mod table;
mod tone;
mod viewpoint;

pub use atomic_file::write_atomically;
pub use display::{DisplayMesh, DisplayVertex, Piece};
pub use error::ViewError;
pub use exr::write_exr;
pub use glb::write_glb;
pub use picture::{Picture, PictureSettings, render};
pub use png::write_png;
pub use table::{BandComparison, COLUMNS, Comparison, Row, Table, WorstRow, compare};
pub use tone::{Exposure, luminance, srgb, tone_map};
pub use viewpoint::{default_camera, guess_up};
