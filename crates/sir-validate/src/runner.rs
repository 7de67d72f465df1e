//! Who makes the runs: a executor, and someone who watches it.

use std::num::NonZeroUsize;

use sir_parallel::{Executor, Observer, RunError};

use crate::trial::Sample;

/// Watches a validation, and may stop it.
pub trait Watcher {
    /// A case begins.
    fn begin(&mut self, case: &str, title: &str);
    /// Called a few times a second with the number of lines traced so far and in all, as far as can be told.
    fn progress(&mut self, done: u64, total: u64);
    /// Asked a few times a second: whether to give up.
    fn should_stop(&self) -> bool;
}

/// Makes runs, and counts their lines.
pub(crate) struct Runner<'w> {
    pub(crate) watcher: &'w mut dyn Watcher,
    threads: NonZeroUsize,
    done: u64,
    total: u64,
}

impl<'w> Runner<'w> {
    pub(crate) fn new(watcher: &'w mut dyn Watcher, threads: NonZeroUsize) -> Self {
        Self { watcher, threads, done: 0, total: 0 }
    }

    /// Announces lines.
    pub(crate) fn expect(&mut self, lines: u64) {
        self.total += lines;
    }

    /// Makes a run.
    pub(crate) fn run(&mut self, sample: &Sample<'_>, lines: u64, seed: u64) -> Result<Vec<f64>, RunError> {
        let tick = Tick {
            watcher: &mut *self.watcher,
            before: self.done,
            stage: 0,
            limit: self.done + lines,
            total: self.total,
        };
        let values = sample(lines, seed, &mut Executor::new(self.threads).watched_by(tick))?;
        self.done += lines;
        Ok(values)
    }
}

/// Tells the watcher about the stages of a run.
struct Tick<'w> {
    watcher: &'w mut dyn Watcher,
    /// Lines before this stage, and of it.
    before: u64,
    stage: u64,
    /// Lines when the run is done.
    limit: u64,
    total: u64,
}

impl Observer for Tick<'_> {
    fn progress(&mut self, done: u64, _total: u64) {
        if done < self.stage {
            self.before += self.stage;
        }
        self.stage = done;
        self.watcher.progress((self.before + done).min(self.limit), self.total);
    }

    fn should_stop(&self) -> bool {
        self.watcher.should_stop()
    }
}
