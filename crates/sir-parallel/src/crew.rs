//! The workers of a run: ranks, and the threads of each.

use std::num::NonZeroUsize;
use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
use std::thread;
use std::time::{Duration, Instant};

use sir_radiosity::{Books, Visitor, share};

use crate::checkpoint::{Checkpoints, Saved};
use crate::communicator::{Alone, Communicator};
use crate::error::{CheckpointError, RunError};
use crate::observer::{Observer, Silent};

/// Most lines that a thread traces at a time: some milliseconds of work.
const BLOCK: u64 = 1 << 10;

/// Time between two looks at the observer.
const SLICE: Duration = Duration::from_millis(250);

/// Those who work on a run, who watches them, and where its state is saved.
pub struct Crew<'a> {
    /// The ranks.
    pub comm: &'a dyn Communicator,
    /// Threads of this rank.
    pub threads: NonZeroUsize,
    /// Who watches.
    pub observer: Box<dyn Observer + 'a>,
    /// Where and how often the state is saved, if it is.
    pub checkpoints: Option<&'a mut Checkpoints>,
    /// Shows what was computed before and is still needed, if anything: it is saved and restored with the state of the stage.
    pub earlier: Option<Earlier<'a>>,
}

/// Shows to a visitor what all ranks have alike.
pub type Earlier<'a> = Box<dyn FnMut(&mut dyn Visitor) + 'a>;

/// Processor cores that this process may use.
#[must_use]
pub fn cores() -> NonZeroUsize {
    thread::available_parallelism().unwrap_or(NonZeroUsize::MIN)
}

impl Default for Crew<'_> {
    /// All cores of this machine, unwatched.
    fn default() -> Self {
        Self::of(cores())
    }
}

impl<'a> Crew<'a> {
    /// Some threads of this process, unwatched.
    #[must_use]
    pub fn of(threads: NonZeroUsize) -> Self {
        Self { comm: &Alone, threads, observer: Box::new(Silent), checkpoints: None, earlier: None }
    }

    /// The same workers, watched.
    #[must_use]
    pub fn watched_by(mut self, observer: impl Observer + 'a) -> Self {
        self.observer = Box::new(observer);
        self
    }
}

/// Wall-clock time of a stage on this rank.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StageTime {
    /// All of it, set-up included.
    pub total: Duration,
    /// Tracing lines, which all threads do.
    pub tracing: Duration,
    /// Exchanging numbers with other ranks, and waiting for them.
    pub communication: Duration,
}

impl StageTime {
    /// What is neither tracing nor communication.
    #[must_use]
    pub fn sequential(&self) -> Duration {
        self.total.saturating_sub(self.tracing + self.communication)
    }
}

/// What a stage of lines can do for its crew.
pub(crate) trait Work: Sync {
    /// Traces some lines, by the thread of this number.
    fn trace(&self, thread: usize, lines: Range<u64>, books: &mut Books);
    /// Shows the whole state to a visitor.
    fn visit(&mut self, visitor: &mut dyn Visitor);
}

/// A crew at work on one stage.
pub(crate) struct Shift<'c, 'a> {
    crew: &'c mut Crew<'a>,
    /// What tells the stage from others.
    identity: Vec<i64>,
    start: Instant,
    /// Time spent; `total` is that before a restart.
    time: StageTime,
    /// Lines of all workers until the observer is looked at again.
    slice: u64,
    /// When the current slice began, and its lines.
    since: (Instant, u64),
    total: u64,
}

/// What all ranks do next.
pub(crate) struct Orders {
    /// Lines of all workers until the next orders.
    pub(crate) slice: u64,
    pub(crate) save: bool,
    pub(crate) stop: bool,
}

impl<'c, 'a> Shift<'c, 'a> {
    /// Begins a stage of `total` lines; `identity` tells it from other stages, whose checkpoints it cannot use.
    pub(crate) fn begin(crew: &'c mut Crew<'a>, total: u64, identity: &[u64]) -> Self {
        let now = Instant::now();
        let slice = BLOCK * (crew.comm.size() * crew.threads.get()) as u64;
        let identity = identity.iter().map(|&word| word as i64).collect();
        Self { crew, identity, start: now, time: StageTime::default(), slice, since: (now, 0), total }
    }

    pub(crate) fn comm(&self) -> &'a dyn Communicator {
        self.crew.comm
    }

    pub(crate) fn threads(&self) -> usize {
        self.crew.threads.get()
    }

    /// The time so far.
    pub(crate) fn time(&self) -> StageTime {
        StageTime { total: self.time.total + self.start.elapsed(), ..self.time }
    }

    /// Corrects how many lines there will be.
    pub(crate) fn expect(&mut self, total: u64) {
        self.total = total;
    }

    /// Tells the observer how many lines are done.
    pub(crate) fn progress(&mut self, done: u64) {
        self.crew.observer.progress(done, self.total);
    }

    /// Agrees with all ranks on what to do next: the first one decides, but each may want to stop.
    pub(crate) fn orders(&mut self) -> Orders {
        let (since, lines) = self.since;
        if lines > 0 {
            // Not too bold: the rate may be that of a few lucky lines.
            let wanted = lines as f64 * SLICE.as_secs_f64() / since.elapsed().as_secs_f64().max(1e-6);
            self.slice = (wanted as u64).clamp(self.slice / 2, 4 * self.slice).clamp(64, 1 << 40);
        }
        let first = self.crew.comm.is_first();
        let due = first && self.crew.checkpoints.as_ref().is_some_and(|c| c.are_due());
        let stop = self.crew.observer.should_stop();
        let mut words = [i64::from(stop), i64::from(due), if first { self.slice as i64 } else { 0 }];
        self.talk(|comm| comm.sum(&mut words));
        self.slice = words[2] as u64;
        self.since = (Instant::now(), 0);
        Orders { slice: self.slice, save: words[0] + words[1] > 0, stop: words[0] > 0 }
    }

    /// Notes how many lines all workers have traced since the last orders.
    pub(crate) fn traced(&mut self, lines: u64) {
        self.since.1 = lines;
    }

    /// Exchanges numbers with other ranks.
    pub(crate) fn talk<T>(&mut self, exchange: impl FnOnce(&dyn Communicator) -> T) -> T {
        let start = Instant::now();
        let outcome = exchange(self.crew.comm);
        self.time.communication += start.elapsed();
        outcome
    }

    /// Adds up, over all ranks, what is shown; all of them then have the sums.
    pub(crate) fn add_up(&mut self, show: impl FnOnce(&mut dyn Visitor)) {
        if self.crew.comm.size() > 1 {
            self.talk(|comm| show(&mut Adder(comm)));
        }
    }

    /// Whether, at the end of a stage, so much time has passed since the last checkpoint that there should be another one.
    pub(crate) fn is_late(&mut self) -> bool {
        let first = self.crew.comm.is_first();
        let mut late = [i64::from(first && self.crew.checkpoints.as_ref().is_some_and(|c| c.are_late()))];
        self.talk(|comm| comm.sum(&mut late));
        late[0] > 0
    }

    /// Goes on with what was saved.
    pub(crate) fn restore(
        &mut self,
        saved: Saved,
        position: &mut Position,
        show: &mut dyn FnMut(&mut dyn Visitor),
    ) -> Result<(), CheckpointError> {
        let Crew { comm, earlier, .. } = &mut *self.crew;
        saved.restore(*comm, &self.identity, &mut |visitor| {
            if let Some(earlier) = earlier {
                earlier(visitor);
            }
            position.visit(visitor);
            show(visitor);
        })?;
        self.time = position.spent;
        Ok(())
    }

    /// Saves the state that is shown, if there are checkpoints.
    pub(crate) fn save(
        &mut self,
        position: &mut Position,
        show: &mut dyn FnMut(&mut dyn Visitor),
    ) -> Result<(), CheckpointError> {
        position.spent = self.time();
        let Crew { comm, checkpoints, earlier, .. } = &mut *self.crew;
        match checkpoints {
            Some(checkpoints) => checkpoints.save(*comm, &self.identity, &mut |visitor| {
                if let Some(earlier) = earlier {
                    earlier(visitor);
                }
                position.visit(visitor);
                show(visitor);
            }),
            None => Ok(()),
        }
    }

    /// Lets all workers trace the lines up to `end`.
    pub(crate) fn trace(
        &mut self,
        work: &mut impl Work,
        position: &mut Position,
        end: u64,
    ) -> Result<(), RunError> {
        while position.next < end {
            let orders = self.orders();
            if orders.save {
                self.save(position, &mut |visitor| work.visit(visitor))?;
            }
            if orders.stop {
                return Err(RunError::Interrupted { done: position.next, total: self.total });
            }
            let lines = orders.slice.min(end - position.next);
            let mine = share(lines, self.crew.comm.rank() as u64, self.crew.comm.size() as u64);
            let mine = position.next + mine.start..position.next + mine.end;
            let threads = self.threads();
            position.books += self
                .tracing(|| spread(threads, mine, |thread, lines, books| work.trace(thread, lines, books)));
            self.traced(lines);
            position.next += lines;
            self.progress(position.next);
        }
        if end == self.total && self.is_late() {
            self.save(position, &mut |visitor| work.visit(visitor))?;
        }
        Ok(())
    }

    /// Traces lines: the time of whatever `work` does counts as such.
    pub(crate) fn tracing<T>(&mut self, work: impl FnOnce() -> T) -> T {
        let start = Instant::now();
        let outcome = work();
        self.time.tracing += start.elapsed();
        outcome
    }
}

/// Lets a thread each do something with every item; the calling thread takes the first.
pub(crate) fn each<I: Send, T: Send>(
    items: impl IntoIterator<Item = I>,
    job: impl Fn(I) -> T + Sync,
) -> Vec<T> {
    let job = &job;
    let mut items = items.into_iter();
    let Some(mine) = items.next() else { return Vec::new() };
    thread::scope(|scope| {
        let others: Vec<_> = items.map(|item| scope.spawn(move || job(item))).collect();
        let mut outcomes = vec![job(mine)];
        outcomes.extend(others.into_iter().map(join));
        outcomes
    })
}

fn micros(time: Duration) -> u64 {
    time.as_micros() as u64
}

/// How far a stage is.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Position {
    /// The next line.
    pub(crate) next: u64,
    /// What this rank has written down.
    pub(crate) books: Books,
    /// Time spent until the last checkpoint was saved.
    spent: StageTime,
}

impl Position {
    pub(crate) fn visit(&mut self, visitor: &mut dyn Visitor) {
        let StageTime { total, tracing, communication } = &mut self.spent;
        let mut words =
            [self.next, micros(*total), micros(*tracing), micros(*communication)].map(|w| w as i64);
        visitor.same(&mut words);
        let times = [total, tracing, communication];
        self.next = words[0] as u64;
        times
            .into_iter()
            .zip(&words[1..])
            .for_each(|(time, word)| *time = Duration::from_micros(*word as u64));
        self.books.visit(visitor);
    }
}

/// Traces lines on several threads, block by block; returns the sum of their books.
fn spread(threads: usize, lines: Range<u64>, trace: impl Fn(usize, Range<u64>, &mut Books) + Sync) -> Books {
    let length = lines.end - lines.start;
    // Towards the end of few lines no thread should wait for long.
    let block = BLOCK.min(length / (8 * threads as u64)).max(16);
    let next = AtomicU64::new(lines.start);
    let work = |thread: usize| {
        let mut books = Books::default();
        loop {
            let start = next.fetch_add(block, Relaxed);
            if start >= lines.end {
                return books;
            }
            trace(thread, start..lines.end.min(start + block), &mut books);
        }
    };
    let helpers = (threads as u64 - 1).min(length / block);
    let mut books = Books::default();
    each(0..=helpers as usize, work).into_iter().for_each(|part| books += part);
    books
}

/// Waits for a thread; if it panicked, so does this one.
fn join<T>(handle: thread::ScopedJoinHandle<'_, T>) -> T {
    handle.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
}

/// Adds up a state over all ranks.
struct Adder<'a>(&'a dyn Communicator);

impl Visitor for Adder<'_> {
    fn sum(&mut self, words: &mut [i64]) {
        self.0.sum(words);
    }

    fn same(&mut self, _words: &mut [i64]) {}
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Mutex;

    #[test]
    fn every_line_is_traced_once_by_any_number_of_threads() {
        for threads in [1, 2, 3, 7] {
            for lines in [0..0, 5..6, 100..1_000, 7..123_456] {
                let seen = Mutex::new(Vec::new());
                let books = spread(threads, lines.clone(), |thread, block: Range<u64>, books: &mut Books| {
                    assert!(thread < threads);
                    books.counts.lines += block.end - block.start;
                    seen.lock().unwrap().extend(block);
                });
                assert_eq!(books.counts.lines, lines.end - lines.start);
                let mut seen = seen.into_inner().unwrap();
                seen.sort_unstable();
                assert!(seen.into_iter().eq(lines));
            }
        }
    }
}
