//! Watching and stopping a stage.

/// Watches a stage, and may stop it.
pub trait Observer {
    /// Called a few times a second with the number of lines done so far and in all.
    fn progress(&mut self, done: u64, total: u64);

    /// Asked a few times a second: whether to give up. If so, the state is saved where there are checkpoints.
    fn should_stop(&self) -> bool {
        false
    }
}

/// An observer that says nothing and lets everything finish.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoProgress;

impl Observer for NoProgress {
    fn progress(&mut self, _done: u64, _total: u64) {}
}
