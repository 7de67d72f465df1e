//! Cutting and walking ranges of lines.

use std::ops::Range;

use sir_radiosity::SolveError;
use thiserror::Error;

/// Why a stage did not finish.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum RunError {
    /// The light cannot be computed.
    #[error(transparent)]
    Solve(#[from] SolveError),
    /// The observer asked to stop.
    #[error("interrupted after {done} of {total} lines")]
    Interrupted {
        /// Lines done.
        done: u64,
        /// Lines asked for.
        total: u64,
    },
}

/// Watches a stage, and may stop it.
pub trait Observer {
    /// Called after every block with the number of lines done so far and in all.
    fn progress(&mut self, done: u64, total: u64);

    /// Asked before every block: whether to give up.
    fn should_stop(&self) -> bool {
        false
    }
}

/// An observer that says nothing and lets everything finish.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Observer for Silent {
    fn progress(&mut self, _done: u64, _total: u64) {}
}

/// The part of `0..lines` that belongs to one of several workers. The parts follow each other and differ in length by
/// one line at most.
#[must_use]
pub fn share(lines: u64, worker: u64, workers: u64) -> Range<u64> {
    let start = |w: u64| (u128::from(lines) * u128::from(w) / u128::from(workers)) as u64;
    start(worker)..start(worker + 1)
}

/// Walks a range in blocks of at most `block` lines, in order.
///
/// # Errors
///
/// [`RunError::Interrupted`] if the observer wants to stop.
pub fn walk(
    lines: Range<u64>,
    block: u64,
    observer: &mut dyn Observer,
    mut trace: impl FnMut(Range<u64>),
) -> Result<(), RunError> {
    let total = lines.end.saturating_sub(lines.start);
    let mut next = lines.start;
    while next < lines.end {
        if observer.should_stop() {
            return Err(RunError::Interrupted { done: next - lines.start, total });
        }
        let end = lines.end.min(next.saturating_add(block.max(1)));
        trace(next..end);
        next = end;
        observer.progress(next - lines.start, total);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_cover_the_range_evenly() {
        for lines in [0, 1, 7, 1000, u64::MAX] {
            for workers in [1, 2, 3, 64] {
                let mut next = 0;
                for w in 0..workers {
                    let part = share(lines, w, workers);
                    assert_eq!(part.start, next);
                    assert!((part.end - part.start).abs_diff(lines / workers) <= 1);
                    next = part.end;
                }
                assert_eq!(next, lines);
            }
        }
    }

    struct StopAfter(u64, u64);
    impl Observer for StopAfter {
        fn progress(&mut self, done: u64, _total: u64) {
            self.1 = done;
        }
        fn should_stop(&self) -> bool {
            self.1 >= self.0
        }
    }

    #[test]
    fn a_walk_can_be_stopped_between_blocks() {
        let mut observer = StopAfter(25, 0);
        let mut seen = 0;
        let outcome = walk(0..100, 10, &mut observer, |block| seen += block.count());
        assert_eq!(outcome, Err(RunError::Interrupted { done: 30, total: 100 }));
        assert_eq!(seen, 30);
    }
}
