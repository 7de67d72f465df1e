//! Errors.

use thiserror::Error;

/// Reason why an acceleration structure cannot be built.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum AccelError {
    /// A corner is not in the list of positions.
    #[error(
        "triangle {triangle} has the corner {index}, but there are only {count} positions; corners are numbered from 0"
    )]
    OutOfRange {
        /// Number of the triangle.
        triangle: usize,
        /// Index of the corner in the list of positions.
        index: u32,
        /// Number of positions.
        count: usize,
    },
    /// A coordinate is infinite or NaN.
    #[error("position {position} has a coordinate that is infinite or not a number; give finite coordinates")]
    NotFinite {
        /// Number of the position.
        position: usize,
    },
    /// There are more triangles than can be numbered.
    #[error("{count} triangles are too many (at most {} can be numbered); divide the scene", MAX_TRIANGLES)]
    TooMany {
        /// Number of triangles.
        count: usize,
    },
    /// A list in the options does not have one element per triangle.
    #[error("the list of {list} has {found} elements for {triangles} triangles; give one for each")]
    WrongLength {
        /// Contents of the list.
        list: &'static str,
        /// Number of its elements.
        found: usize,
        /// Number of triangles.
        triangles: usize,
    },
    /// Squares of lengths in the scene would overflow or vanish.
    #[error(
        "the triangles have a bounding sphere of radius {radius}, outside of what double precision can square \
         (1e-140 to 1e140); choose another unit of length"
    )]
    Extent {
        /// Radius of the bounding sphere.
        radius: f64,
    },
}

/// Largest number of triangles.
pub(crate) const MAX_TRIANGLES: usize = (1 << 31) - 1;
