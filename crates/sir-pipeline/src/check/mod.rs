//! What a pipeline will do and cost, without doing it.

pub mod estimate;
pub(crate) mod needs;
pub mod probe;
mod text;

pub use estimate::{Estimate, Repeated, check, estimate};
pub use probe::StageEstimate;
