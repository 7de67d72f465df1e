//! Observers that stop a stage, slow it down, or copy its checkpoints.

use std::path::{Path, PathBuf};
use std::time::Duration;

use sir_parallel::Observer;

/// Observer that asks to stop after this number of progress reports.
pub(crate) struct StopAfter(pub(crate) u32);

impl StopAfter {
    /// Never asks to stop.
    pub(crate) const NEVER: Self = Self(u32::MAX);
}

impl Observer for StopAfter {
    fn progress(&mut self, done: u64, total: u64) {
        assert!(done <= total, "{done} of {total}");
        self.0 = self.0.saturating_sub(1);
    }

    fn should_stop(&self) -> bool {
        self.0 == 0
    }
}

/// Observer that delays the first few progress reports.
pub(crate) struct Dawdle(pub(crate) u32);

impl Observer for Dawdle {
    fn progress(&mut self, _done: u64, _total: u64) {
        if self.0 > 0 {
            self.0 -= 1;
            std::thread::sleep(Duration::from_millis(150));
        }
    }
}

/// Observer that copies the checkpoint, if there is one, at every progress report.
pub(crate) struct Collect<'a> {
    pub(crate) checkpoint: &'a Path,
    /// Copies, each with the number of lines done at that time.
    pub(crate) copies: &'a mut Vec<(u64, PathBuf)>,
}

impl Observer for Collect<'_> {
    fn progress(&mut self, done: u64, _total: u64) {
        if self.checkpoint.exists() {
            let copy = self.checkpoint.with_extension(format!("copy{}", self.copies.len()));
            std::fs::copy(self.checkpoint, &copy).unwrap();
            self.copies.push((done, copy));
        }
    }
}
