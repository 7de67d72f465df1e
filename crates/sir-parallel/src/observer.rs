//! Progress reports and interruption of a stage.

/// Observer of a stage. It receives progress reports and can stop the stage.
pub trait Observer {
    /// Reports the number of lines done and the total. Called several times a second.
    fn progress(&mut self, done: u64, total: u64);

    /// Returns true if the stage should stop; its state is then saved if checkpoints are enabled. Called several times
    /// a second.
    fn should_stop(&self) -> bool {
        false
    }
}

/// Observer that ignores progress and never stops a stage.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoProgress;

impl Observer for NoProgress {
    fn progress(&mut self, _done: u64, _total: u64) {}
}
