//! Slices of a stage: a few times a second all ranks agree on what to do next.

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

/// A stage that an executor runs, slice by slice.
pub(crate) struct Slices<'c, 'a> {
    executor: &'c mut Executor<'a>,
    /// Numbers that tell the stage from others.
    identity: Vec<i64>,
    start: Instant,
    /// Time spent; `total` is that before a restart.
    time: StageTime,
    /// Lines of all workers until the next agreement.
    lines: u64,
    /// When the current slice began, and its lines.
    since: (Instant, u64),
}

/// What all ranks do next.
pub(crate) struct Control {
    /// Lines of all workers until the next agreement.
    pub(crate) lines: u64,
    /// Number of threads of all ranks.
    pub(crate) workers: u64,
    /// True if the state is to be saved before.
    pub(crate) save: bool,
    /// True if the stage is to be given up.
    pub(crate) stop: bool,
}

impl<'c, 'a> Slices<'c, 'a> {
    /// Begins a stage; `identity` tells it from other stages, whose checkpoints it cannot use.
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

    /// Returns the time so far.
    pub(crate) fn time(&self) -> StageTime {
        StageTime { total: self.time.total + self.start.elapsed(), ..self.time }
    }

    /// Tells the observer how many lines are done, of how many.
    pub(crate) fn progress(&mut self, done: u64, total: u64) {
        self.executor.observer.progress(done, total);
    }

    /// Agrees with all ranks on what to do next: the first one decides, but each may want to stop.
    pub(crate) fn agree(&mut self) -> Control {
        let (since, lines) = self.since;
        if lines > 0 {
            // Not too bold: the rate may be that of a few lucky lines.
            let wanted = lines as f64 * SLICE.as_secs_f64() / since.elapsed().as_secs_f64().max(1e-6);
            self.lines = (wanted as u64).clamp(self.lines / 2, 4 * self.lines).clamp(64, 1 << 40);
        }
        let first = self.executor.comm.is_first();
        let due = first && self.executor.checkpoints.as_ref().is_some_and(|c| c.are_due());
        let stop = self.executor.observer.should_stop();
        let lines = if first { self.lines as i64 } else { 0 };
        let mut words = [i64::from(stop), i64::from(due), lines, self.executor.threads.get() as i64];
        self.talk(|comm| comm.sum(&mut words));
        let [stop, due, lines, workers] = words;
        self.lines = lines as u64;
        self.since = (Instant::now(), 0);
        Control { lines: self.lines, workers: workers as u64, save: stop + due > 0, stop: stop > 0 }
    }

    /// Notes how many lines all workers have traced since the last agreement.
    pub(crate) fn traced(&mut self, lines: u64) {
        self.since.1 = lines;
    }

    /// Exchanges numbers with other ranks.
    pub(crate) fn talk<T>(&mut self, exchange: impl FnOnce(&dyn Communicator) -> T) -> T {
        let start = Instant::now();
        let outcome = exchange(self.executor.comm);
        self.time.communication += start.elapsed();
        outcome
    }

    /// Traces lines: the time of whatever `work` does counts as such.
    pub(crate) fn tracing<T>(&mut self, work: impl FnOnce() -> T) -> T {
        let start = Instant::now();
        let outcome = work();
        self.time.tracing += start.elapsed();
        outcome
    }

    /// Adds up, over all ranks, what is shown; all of them then have the sums.
    pub(crate) fn add_up(&mut self, show: impl FnOnce(&mut dyn Visitor)) {
        if self.executor.comm.size() > 1 {
            self.talk(|comm| show(&mut Adder(comm)));
        }
    }

    /// True if, at the end of a stage, so much time has passed since the last checkpoint that there should be another one.
    pub(crate) fn is_late(&mut self) -> bool {
        let first = self.executor.comm.is_first();
        let late = first && self.executor.checkpoints.as_ref().is_some_and(|c| c.are_late());
        let mut late = [i64::from(late)];
        self.talk(|comm| comm.sum(&mut late));
        late[0] > 0
    }

    /// Restores the state that `show` shows, and returns what `show` returns.
    pub(crate) fn restore<T>(
        &mut self,
        saved: Saved,
        show: impl FnOnce(&mut dyn Visitor) -> T,
    ) -> Result<T, CheckpointError> {
        let Executor { comm, prior, .. } = &mut *self.executor;
        let time = &mut self.time;
        saved.restore(*comm, &self.identity, |visitor| {
            if let Some(prior) = prior {
                prior(visitor);
            }
            time.visit(visitor);
            show(visitor)
        })
    }

    /// Saves the state that `show` shows, if there are checkpoints.
    pub(crate) fn save(&mut self, show: &mut dyn FnMut(&mut dyn Visitor)) -> Result<(), CheckpointError> {
        let mut time = self.time();
        let Executor { comm, checkpoints, prior, .. } = &mut *self.executor;
        match checkpoints {
            Some(checkpoints) => checkpoints.save(*comm, &self.identity, &mut |visitor| {
                if let Some(prior) = prior {
                    prior(visitor);
                }
                time.visit(visitor);
                show(visitor);
            }),
            None => Ok(()),
        }
    }
}

/// Adds up a state over all ranks.
struct Adder<'a>(&'a dyn Communicator);

impl Visitor for Adder<'_> {
    fn sum(&mut self, words: &mut [i64]) {
        self.0.sum(words);
    }

    fn same(&mut self, _words: &mut [i64]) {}
}
