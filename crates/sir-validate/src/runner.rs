//! Execution of runs, with progress reports to a watcher.

use std::num::NonZeroUsize;

use sir_parallel::{Executor, Observer, RunError};

use crate::trial::Sample;

/// Watches a validation, and may stop it.
pub trait Watcher {
    /// Called when a case begins.
    fn begin(&mut self, case: &str, title: &str);
    /// Called a few times a second with the number of lines traced so far and the expected total.
    fn progress(&mut self, done: u64, total: u64);
    /// Called a few times a second; returns true to stop the validation.
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

    /// Adds lines to the expected total.
    pub(crate) fn expect(&mut self, lines: u64) {
        self.total += lines;
    }

    /// Makes a run.
    pub(crate) fn run(&mut self, sample: &Sample<'_>, lines: u64, seed: u64) -> Result<Vec<f64>, RunError> {
        let observer = RunObserver {
            watcher: &mut *self.watcher,
            before: self.done,
            stage: 0,
            limit: self.done + lines,
            total: self.total,
        };
        let values = sample(lines, seed, &mut Executor::new(self.threads).watched_by(observer))?;
        self.done += lines;
        Ok(values)
    }
}

/// Reports the stages of a run to the watcher.
struct RunObserver<'w> {
    watcher: &'w mut dyn Watcher,
    /// Lines traced before this stage.
    before: u64,
    /// Lines traced in this stage.
    stage: u64,
    /// Lines traced when the run is done.
    limit: u64,
    total: u64,
}

impl Observer for RunObserver<'_> {
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
