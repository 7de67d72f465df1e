//! Who runs which lines.
//!
//! # Design
//!
//! A stage is a range of line indices `[0, N)`, and a line is a pure function of its index. So all that is to be
//! decided is which worker walks which part of the range, in pieces small enough to report progress and to stop
//! between them. That is this crate; what a line does is none of its business, and who asks for it neither.
//!
//! [`share`] cuts the range among workers, [`walk`] walks a share block by block under the eyes of an [`Observer`],
//! and [`first_shot`] and [`multipath`] run the two stages of the solver that way. There is one worker so far.
//!
//! # Example
//!
//! ```
//! use std::ops::Range;
//! use sir_parallel::{Silent, share, walk};
//!
//! // Four workers share ten lines; the second one walks its own.
//! assert_eq!(share(10, 1, 4), 2..5);
//! let mut seen = Vec::new();
//! walk(share(10, 1, 4), 2, &mut Silent, |block: Range<u64>| seen.extend(block))?;
//! assert_eq!(seen, [2, 3, 4]);
//! # Ok::<(), sir_parallel::RunError>(())
//! ```

mod stages;
mod walk;

pub use stages::{StageRun, first_shot, multipath};
pub use walk::{Observer, RunError, Silent, share, walk};
