//! Required precision of the answers, and the work that it takes.

use serde::Serialize;

/// Required precision of the answers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Effort {
    /// Standard errors of at most 0.5 % of the exact answer.
    Quick,
    /// Standard errors of at most 0.1 % of the exact answer.
    Full,
}

impl Effort {
    /// Returns the largest permitted standard error, relative to the exact answer.
    #[must_use]
    pub fn precision(self) -> f64 {
        match self {
            Self::Quick => 5e-3,
            Self::Full => 1e-3,
        }
    }

    /// Returns the number of lines of a run that has `full` lines at full effort.
    pub(crate) fn lines(self, full: u64) -> u64 {
        match self {
            Self::Quick => full / 20,
            Self::Full => full,
        }
    }

    /// Returns the number of parts of a circle that has `full` parts at full effort. Each facet needs some lines, so
    /// fewer lines require fewer parts.
    pub(crate) fn segments(self, full: u32) -> u32 {
        match self {
            Self::Quick => full / 4,
            Self::Full => full,
        }
    }
}
