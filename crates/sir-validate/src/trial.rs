//! Trials: quantities, and a function that estimates them.

use sir_parallel::{Executor, RunError};

use crate::effort::Effort;
use crate::error::ValidateError;

/// A quantity with a known exact value.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Quantity {
    pub(crate) name: String,
    /// Group of similar quantities, such as all faces of a cube, which are shown in one row of a table.
    pub(crate) group: Option<String>,
    pub(crate) exact: f64,
    /// Value published by others.
    pub(crate) published: Option<f64>,
}

impl Quantity {
    /// Creates a quantity without a group.
    pub(crate) fn new(name: impl Into<String>, exact: f64) -> Self {
        Self { name: name.into(), group: None, exact, published: None }
    }
}

/// Function of the number of lines, the seed and the executor that returns one estimate of each quantity, from about
/// this many lines.
pub(crate) type Sample<'a> = Box<dyn Fn(u64, u64, &mut Executor<'_>) -> Result<Vec<f64>, RunError> + 'a>;

/// Quantities that the same runs estimate.
pub(crate) struct Trial<'a> {
    pub(crate) quantities: Vec<Quantity>,
    /// Number of lines per run at full effort.
    pub(crate) lines: u64,
    /// Builds the scene and returns the function that makes a run.
    pub(crate) prepare: Box<dyn Fn(Effort) -> Result<Sample<'a>, ValidateError> + 'a>,
}
