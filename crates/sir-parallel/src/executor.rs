//! Execution context of stages.

use std::num::NonZeroUsize;
use std::thread;

use sir_radiosity::Visitor;

use crate::checkpoint::Checkpoints;
use crate::communicator::{Communicator, SingleProcess};
use crate::observer::{NoProgress, Observer};

/// Execution context: ranks, threads, observer, checkpoints.
pub struct Executor<'a> {
    /// Ranks of the run.
    pub comm: &'a dyn Communicator,
    /// Number of threads of this rank.
    pub threads: NonZeroUsize,
    /// Observer, which receives the progress and can stop the stage.
    pub observer: Box<dyn Observer + 'a>,
    /// Checkpoint settings; `None` if no state is saved.
    pub checkpoints: Option<&'a mut Checkpoints>,
    /// Results of earlier stages that a resumed run still needs. They are saved and restored with the state of the
    /// stage.
    pub prior: Option<Prior<'a>>,
}

/// Function that passes results of earlier stages to a visitor. All ranks must hold them identically.
pub type Prior<'a> = Box<dyn FnMut(&mut dyn Visitor) + 'a>;

/// Returns the number of processor cores that this process may use.
#[must_use]
pub fn cores() -> NonZeroUsize {
    thread::available_parallelism().unwrap_or(NonZeroUsize::MIN)
}

impl Default for Executor<'_> {
    /// Returns an executor with all cores of this machine, without an observer and without checkpoints.
    fn default() -> Self {
        Self::new(cores())
    }
}

impl<'a> Executor<'a> {
    /// Returns an executor with this number of threads in one process, without an observer and without checkpoints.
    #[must_use]
    pub fn new(threads: NonZeroUsize) -> Self {
        Self { comm: &SingleProcess, threads, observer: Box::new(NoProgress), checkpoints: None, prior: None }
    }

    /// Returns the same executor with an observer.
    #[must_use]
    pub fn watched_by(mut self, observer: impl Observer + 'a) -> Self {
        self.observer = Box::new(observer);
        self
    }
}
