//! The stages `FirstShot`, `ShadowRays`, `SecondShot` and `Solve`.

use crate::text::field::Format as _;
use crate::text::formats::{Count, count, number};
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
    /// Stage that replaces the direct light of the first shot with that of rays from the patches.
    pub struct ShadowRays {
        /// Total number of rays. Every side of a patch has at least two points with rays to the sources.
        pub rays: u64 = line_count().required();
    }
}

record! {
    /// Stage that sends the power reflected by the brightest patches along local lines.
    pub struct SecondShot {
        /// Total number of lines.
        pub lines: u64 = line_count().required();
        /// Share of the reflected light that is sent, from the brightest patches on; `1` is all of it. By default, each
        /// line carries as much power as a line of the first shot.
        pub share: Option<f64> =
            number(1.0).with_range(|x| x > 0.0 && x <= 1.0, "above 0, at most 1").optional("from the lines");
    }
}

record! {
    /// Stage that computes all light: a first shot, shadow rays, a second shot and global lines.
    pub struct Solve {
        /// Number of lines and rays of all these stages together. A pilot of a few per cent of that number decides how they
        /// are divided.
        pub lines: u64 = line_count().required();
    }
}
