//! The stages `FirstShot` and `SecondShot`.

use crate::text::field::Format as _;
use crate::text::formats::{Count, count};
use crate::text::record::record;

/// Largest number of lines or repeats. A larger one is certainly an error.
pub(crate) const MAX_LINES: u64 = 1_000_000_000_000_000;

/// Returns the format of the number of lines of a stage.
pub(crate) fn line_count() -> Count<u64> {
    count(1, MAX_LINES, 1_000_000)
}

record! {
    /// Stage that sends the power of the light sources along local lines.
    pub struct FirstShot {
        /// Total number of lines, allocated to the sources in proportion to their power.
        pub lines: u64 = line_count().required();
    }
}

record! {
    /// Stage that sends the power reflected by the brightest patches along local lines.
    pub struct SecondShot {
        /// Total number of lines. The more lines there are, the more patches send along them, so that each line carries
        /// as much power as a line of the first shot.
        pub lines: u64 = line_count().required();
    }
}
