//! View factors between the materials or named parts of a scene, computed without a pipeline.

pub(crate) mod compute;
pub(crate) mod error;
mod files;
pub(crate) mod options;
pub(crate) mod report;

pub use compute::{ViewFactorsResult, view_factors};
pub use error::ViewFactorsError;
pub use options::{By, ViewFactorsOptions};
pub use report::{Group, Matrix, Pair, Report};
