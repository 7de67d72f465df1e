//! Estimates memory and time of a pipeline without running it.

pub mod estimate;
pub(crate) mod needs;
pub mod probe;
mod text;

pub use estimate::{Estimate, check, estimate};
pub use probe::StageEstimate;
