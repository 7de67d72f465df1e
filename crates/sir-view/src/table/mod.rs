//! Tables: the light of patches, or of parts of a scene, in numbers.

mod compare;
mod csv;
mod files;
mod light_table;
mod npy;
mod row;

pub use compare::{BandComparison, Comparison, WorstRow, compare};
pub use row::{Row, Table};
