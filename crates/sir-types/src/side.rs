//! The two sides of a triangle.

/// One side of a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Side {
    /// The side from which the corners run counterclockwise.
    Front,
    /// The other side.
    Back,
}

impl Side {
    /// Returns the opposite side.
    #[inline]
    #[must_use]
    pub fn flip(self) -> Self {
        match self {
            Self::Front => Self::Back,
            Self::Back => Self::Front,
        }
    }
}
