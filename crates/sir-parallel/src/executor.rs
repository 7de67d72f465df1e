//! Who runs a stage: ranks, threads, an observer, and where the state is saved.

use std::num::NonZeroUsize;
use std::thread;

use sir_radiosity::Visitor;

use crate::checkpoint::Checkpoints;
use crate::communicator::{Communicator, SingleProcess};
use crate::observer::{NoProgress, Observer};

/// Execution context: ranks, threads, observer, checkpoints.
pub struct Executor<'a> {
    /// The ranks.
    pub comm: &'a dyn Communicator,
    /// Threads of this rank.
    pub threads: NonZeroUsize,
    /// Gets the progress, and may stop the stage.
    pub observer: Box<dyn Observer + 'a>,
    /// Where and how often the state is saved, if it is.
    pub checkpoints: Option<&'a mut Checkpoints>,
    /// Results of stages before that a resumed run still needs: saved and restored with the state of the stage.
    pub prior: Option<Prior<'a>>,
}

/// Shows to a visitor what all ranks hold identically.
pub type Prior<'a> = Box<dyn FnMut(&mut dyn Visitor) + 'a>;

/// Returns the number of processor cores that this process may use.
#[must_use]
pub fn cores() -> NonZeroUsize {
    thread::available_parallelism().unwrap_or(NonZeroUsize::MIN)
}

impl Default for Executor<'_> {
    /// Returns all cores of this machine, without an observer and without checkpoints.
    fn default() -> Self {
        Self::new(cores())
    }
}

impl<'a> Executor<'a> {
    /// Returns some threads of this process, without an observer and without checkpoints.
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
