//! The per-patch table: the solution in numbers.

mod compare;
mod csv;
mod npy;
mod patch_table;
mod row;

pub use compare::{BandComparison, Comparison, WorstRow, compare};
pub use patch_table::Table;
pub use row::{COLUMNS, Row};
