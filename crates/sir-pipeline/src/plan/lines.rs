//! The stages `FirstShot` and `SecondShot`.

use crate::text::field::Format as _;
use crate::text::formats::{Count, count};
use crate::text::record::record;

/// The largest number of lines or repeats; a larger one is a mistake for sure.
pub(crate) const MAX_LINES: u64 = 1_000_000_000_000_000;

/// The number of lines of a stage.
pub(crate) fn line_count() -> Count<u64> {
    count(1, MAX_LINES, 1_000_000)
}

record! {
    /// Sends the power of the light sources along local lines.
    pub struct FirstShot {
        /// Lines in all, shared among the sources in proportion to their power.
        pub lines: u64 = line_count().required();
    }
}

record! {
    /// Lets the brightest patches send what they reflect along local lines, too.
    pub struct SecondShot {
        /// Lines in all. The more there are, the more patches send along them: until each line carries as much as one of the
        /// first shot.
        pub lines: u64 = line_count().required();
    }
}
