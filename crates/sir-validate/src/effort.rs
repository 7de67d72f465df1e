//! How precise answers have to be, and what that takes.

use serde::Serialize;

/// How precise answers have to be.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Effort {
    /// Standard errors of at most 0.5 % of the exact answer.
    Quick,
    /// Standard errors of at most 0.1 % of the exact answer.
    Full,
}

impl Effort {
    /// The largest standard error, relative to the exact answer.
    #[must_use]
    pub fn precision(self) -> f64 {
        match self {
            Self::Quick => 5e-3,
            Self::Full => 1e-3,
        }
    }

    /// Lines of a run that has this many in full.
    pub(crate) fn lines(self, full: u64) -> u64 {
        match self {
            Self::Quick => full / 20,
            Self::Full => full,
        }
    }

    /// Parts of a circle that has this many in full. Each facet needs some lines, so there are fewer where lines are few.
    pub(crate) fn segments(self, full: u32) -> u32 {
        match self {
            Self::Quick => full / 4,
            Self::Full => full,
        }
    }
}
