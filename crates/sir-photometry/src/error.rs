//! Errors.

use thiserror::Error;

/// Reason that a table is no distribution of intensity.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum TableError {
    /// The numbers of angles and values do not fit together.
    #[error(
        "a table of {azimuths} planes and {polars} polar angles needs at least one plane, two angles, and a value for each \
         pair, but there are {values} values"
    )]
    Size {
        /// Number of planes.
        azimuths: usize,
        /// Number of polar angles.
        polars: usize,
        /// Number of values.
        values: usize,
    },
    /// A number is infinite or not a number.
    #[error("a number of the table is not finite")]
    NotFinite,
    /// Angles do not ascend.
    #[error("the angles of the table do not ascend")]
    Order,
    /// Angles are outside of their range.
    #[error("the planes of the table span more than 360°, or its polar angles are outside of 0 to 180°")]
    Range,
    /// An intensity is negative.
    #[error("the intensity {value} cd is negative")]
    Negative {
        /// The intensity \[cd\].
        value: f64,
    },
    /// All intensities are zero.
    #[error("all intensities are zero")]
    Dark,
}
