//! Why patches cannot be made.

use thiserror::Error;

/// Why patches cannot be made.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum MeshError {
    /// A limit that must be positive is not.
    #[error("the largest {what} of a patch is {value}, but it must be a positive number")]
    NotPositive {
        /// `area` or `edge`.
        what: &'static str,
        /// The limit asked for.
        value: f64,
    },
    /// More patches than 32-bit numbers can count.
    #[error("so fine a subdivision makes more than {} patches or sides", u32::MAX)]
    TooMany,
}
