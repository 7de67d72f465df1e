//! Slices of a stage: several times a second all ranks agree on what to do next.

use std::time::{Duration, Instant};

use sir_radiosity::Visitor;

use crate::checkpoint::Saved;
use crate::communicator::Communicator;
use crate::error::CheckpointError;
use crate::executor::Executor;
use crate::threads::{BLOCK, Threads};
use crate::time::StageTime;

/// Time between two agreements.
const SLICE: Duration = Duration::from_millis(250);

/// Execution of a stage, slice by slice.
pub(crate) struct Slices<'c, 'a> {
    executor: &'c mut Executor<'a>,
    /// Words that identify the stage.
    identity: Vec<i64>,
    start: Instant,
    /// Time spent. `total` holds only the time before a restart.
    time: StageTime,
    /// Lines of all workers until the next agreement.
    lines: u64,
    /// Start of the current slice, and its number of lines.
    since: (Instant, u64),
}

/// Decision on the next slice, the same on all ranks.
pub(crate) struct Control {
    /// Lines of all workers until the next agreement.
    pub(crate) lines: u64,
    /// Number of threads of all ranks.
    pub(crate) workers: u64,
    /// True if the state is to be saved before the slice.
    pub(crate) save: bool,
    /// True if the stage is to stop.
    pub(crate) stop: bool,
}

impl<'c, 'a> Slices<'c, 'a> {
    /// Begins a stage. `identity` distinguishes it from other stages, whose checkpoints it cannot use.
    pub(crate) fn begin(executor: &'c mut Executor<'a>, identity: &[u64]) -> Self {
        let now = Instant::now();
        let lines = BLOCK * (executor.comm.size() * executor.threads.get()) as u64;
        let identity = identity.iter().map(|&word| word as i64).collect();
        Self { executor, identity, start: now, time: StageTime::default(), lines, since: (now, 0) }
    }

    pub(crate) fn comm(&self) -> &'a dyn Communicator {
        self.executor.comm
    }

    /// Returns the threads of this rank.
    pub(crate) fn threads(&self) -> Threads {
        Threads(self.executor.threads)
    }

    /// Returns the time spent so far.
    pub(crate) fn time(&self) -> StageTime {
        StageTime { total: self.time.total + self.start.elapsed(), ..self.time }
    }

    /// Reports the number of lines done, and the total, to the observer.
    pub(crate) fn progress(&mut self, done: u64, total: u64) {
        self.executor.observer.progress(done, total);
    }

    /// Agrees with all ranks on the next slice. The first rank decides, but any rank can ask to stop.
    pub(crate) fn agree(&mut self) -> Control {
        let (since, lines) = self.since;
        if lines > 0 {
            // The change is limited, because the rate of a few lines is not reliable.
            let wanted = lines as f64 * SLICE.as_secs_f64() / since.elapsed().as_secs_f64().max(1e-6);
            self.lines = (wanted as u64).clamp(self.lines / 2, 4 * self.lines).clamp(64, 1 << 40);
        }
        let first = self.executor.comm.is_first();
        let due = first && self.executor.checkpoints.as_ref().is_some_and(|c| c.are_due());
        let stop = self.executor.observer.should_stop();
        let lines = if first { self.lines as i64 } else { 0 };
        let mut words = [i64::from(stop), i64::from(due), lines, self.executor.threads.get() as i64];
        self.communicate(|comm| comm.sum(&mut words));
        let [stop, due, lines, workers] = words;
        self.lines = lines as u64;
        self.since = (Instant::now(), 0);
        Control { lines: self.lines, workers: workers as u64, save: stop + due > 0, stop: stop > 0 }
    }

    /// Records the number of lines that all workers have traced since the last agreement.
    pub(crate) fn traced(&mut self, lines: u64) {
        self.since.1 = lines;
    }

    /// Calls `exchange` with the ranks, and counts its time as communication.
    pub(crate) fn communicate<T>(&mut self, exchange: impl FnOnce(&dyn Communicator) -> T) -> T {
        let start = Instant::now();
        let outcome = exchange(self.executor.comm);
        self.time.communication += start.elapsed();
        outcome
    }

    /// Calls `work` and counts its time as tracing.
    pub(crate) fn tracing<T>(&mut self, work: impl FnOnce() -> T) -> T {
        let start = Instant::now();
        let outcome = work();
        self.time.tracing += start.elapsed();
        outcome
    }

    /// Replaces the visited numbers by their sums over all ranks.
    pub(crate) fn add_up(&mut self, visit: impl FnOnce(&mut dyn Visitor)) {
        if self.executor.comm.size() > 1 {
            self.communicate(|comm| visit(&mut Adder(comm)));
        }
    }

    /// Returns true if a checkpoint is due at the end of a stage, because the last one is old enough.
    pub(crate) fn is_due_at_end(&mut self) -> bool {
        let first = self.executor.comm.is_first();
        let due = first && self.executor.checkpoints.as_ref().is_some_and(|c| c.are_due_at_end());
        let mut due = [i64::from(due)];
        self.communicate(|comm| comm.sum(&mut due));
        due[0] > 0
    }

    /// Restores the state that `visit` passes to its visitor, and returns the result of `visit`.
    pub(crate) fn restore<T>(
        &mut self,
        saved: Saved,
        visit: impl FnOnce(&mut dyn Visitor) -> T,
    ) -> Result<T, CheckpointError> {
        let Executor { comm, prior, .. } = &mut *self.executor;
        let time = &mut self.time;
        saved.restore(*comm, &self.identity, |visitor| {
            if let Some(prior) = prior {
                prior(visitor);
            }
            time.visit(visitor);
            visit(visitor)
        })
    }

    /// Saves the state that `visit` passes to its visitor, if checkpoints are enabled.
    pub(crate) fn save(&mut self, visit: &mut dyn FnMut(&mut dyn Visitor)) -> Result<(), CheckpointError> {
        let mut time = self.time();
        let Executor { comm, checkpoints, prior, .. } = &mut *self.executor;
        match checkpoints {
            Some(checkpoints) => checkpoints.save(*comm, &self.identity, &mut |visitor| {
                if let Some(prior) = prior {
                    prior(visitor);
                }
                time.visit(visitor);
                visit(visitor);
            }),
            None => Ok(()),
        }
    }
}

/// Visitor that sums a state over all ranks.
struct Adder<'a>(&'a dyn Communicator);

impl Visitor for Adder<'_> {
    fn sum(&mut self, words: &mut [i64]) {
        self.0.sum(words);
    }

    fn same(&mut self, _words: &mut [i64]) {}
}
