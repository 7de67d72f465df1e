//! What is to be computed, and how: quantities, and a function that estimates them.

use sir_parallel::{Executor, RunError};

use crate::effort::Effort;
use crate::error::ValidateError;

/// A number whose exact value is known.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Quantity {
    pub(crate) name: String,
    /// Quantities that are alike, such as all faces of a cube, are shown in one row of a table.
    pub(crate) group: Option<String>,
    pub(crate) exact: f64,
    /// What others have published.
    pub(crate) published: Option<f64>,
}

impl Quantity {
    /// A number that stands alone.
    pub(crate) fn new(name: impl Into<String>, exact: f64) -> Self {
        Self { name: name.into(), group: None, exact, published: None }
    }
}

/// Gives one estimate of each quantity, from about this many lines with this seed.
pub(crate) type Sample<'a> = Box<dyn Fn(u64, u64, &mut Executor<'_>) -> Result<Vec<f64>, RunError> + 'a>;

/// Some numbers that the same runs give.
pub(crate) struct Trial<'a> {
    pub(crate) quantities: Vec<Quantity>,
    /// Lines of a run, if there is time enough.
    pub(crate) lines: u64,
    /// Makes the scene and says how to light it.
    pub(crate) prepare: Box<dyn Fn(Effort) -> Result<Sample<'a>, ValidateError> + 'a>,
}
