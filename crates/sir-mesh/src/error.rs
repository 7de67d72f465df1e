//! Errors.

use thiserror::Error;

/// Reason why a scene cannot be divided into patches.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum MeshError {
    /// A limit that must be positive is not.
    #[error("the largest {what} of a patch is {value}; give a positive number")]
    NotPositive {
        /// `area` or `edge`.
        what: &'static str,
        /// The limit asked for.
        value: f64,
    },
    /// There are more patches or sides than 32-bit numbers can count.
    #[error("the subdivision makes more than {} patches or sides", u32::MAX)]
    TooMany,
}
