//! Threads of this process.

use std::num::NonZeroUsize;
use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
use std::thread;

use sir_radiosity::{Job, StageTotals, Workers};

/// Largest number of lines in a block: several milliseconds of work for a thread.
pub(crate) const BLOCK: u64 = 1 << 10;

/// Smallest number of lines in a block.
const SMALLEST_BLOCK: u64 = 16;

/// A number of threads of this process. They are started anew for each task.
#[derive(Clone, Copy, Debug)]
pub struct Threads(pub NonZeroUsize);

impl Workers for Threads {
    fn count(&self) -> usize {
        self.0.get()
    }

    fn run(&self, jobs: Vec<Job<'_>>) {
        each(jobs, |job| job());
    }
}

/// Applies a function to every item, each on its own thread; the calling thread takes the first item. Returns the
/// results in order.
pub(crate) fn each<I: Send, T: Send>(
    items: impl IntoIterator<Item = I>,
    function: impl Fn(I) -> T + Sync,
) -> Vec<T> {
    let function = &function;
    let mut items = items.into_iter();
    let Some(mine) = items.next() else { return Vec::new() };
    thread::scope(|scope| {
        let others: Vec<_> = items.map(|item| scope.spawn(move || function(item))).collect();
        let mut results = vec![function(mine)];
        results.extend(others.into_iter().map(join));
        results
    })
}

/// Waits for a thread and propagates its panic.
fn join<T>(handle: thread::ScopedJoinHandle<'_, T>) -> T {
    handle.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
}

/// Traces units of `lines_per_unit` lines each on several threads, which take blocks of units from a shared counter.
/// Returns the sum of their totals.
pub(crate) fn trace_blocks(
    threads: usize,
    units: Range<u64>,
    lines_per_unit: u64,
    trace: impl Fn(usize, Range<u64>, &mut StageTotals) + Sync,
) -> StageTotals {
    let length = units.end - units.start;
    // Small blocks if there are few units, so that no thread waits long for the others at the end.
    let smallest = SMALLEST_BLOCK.div_ceil(lines_per_unit);
    let block = (BLOCK / lines_per_unit).min(length / (8 * threads as u64)).max(smallest);
    let next = AtomicU64::new(units.start);
    let work = |thread: usize| {
        let mut totals = StageTotals::default();
        loop {
            let start = next.fetch_add(block, Relaxed);
            if start >= units.end {
                return totals;
            }
            trace(thread, start..units.end.min(start + block), &mut totals);
        }
    };
    let helpers = (threads as u64 - 1).min(length / block);
    let mut totals = StageTotals::default();
    each(0..=helpers as usize, work).into_iter().for_each(|part| totals += part);
    totals
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Mutex;

    #[test]
    fn every_unit_is_traced_once_by_any_number_of_threads() {
        for threads in [1, 2, 3, 7] {
            for (units, lines) in [(0..0, 1), (5..6, 1), (100..1_000, 1), (7..123_456, 1), (3..40, 4096)] {
                let seen = Mutex::new(Vec::new());
                let trace = |thread, block: Range<u64>, totals: &mut StageTotals| {
                    assert!(thread < threads);
                    totals.counts.lines += block.end - block.start;
                    seen.lock().unwrap().extend(block);
                };
                let totals = trace_blocks(threads, units.clone(), lines, trace);
                assert_eq!(totals.counts.lines, units.end - units.start);
                let mut seen = seen.into_inner().unwrap();
                seen.sort_unstable();
                assert!(seen.into_iter().eq(units));
            }
        }
    }
}
