//! Who is told how far a run is.

use std::fmt::Debug;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::time::Duration;

use sir_parallel::{Communicator, Observer};

use crate::format::grouped;

/// Time between two notes about parts of a stage that may be short.
pub const PAUSE: Duration = Duration::from_secs(10);

/// Is told what a run does, and shows it if it likes. All methods do nothing by default.
pub trait Progress: Debug + Send + Sync {
    /// Takes warnings: of the reader of the scene, or about the result. They are in the report, too.
    fn warnings(&self, warnings: &[String]) {
        let _ = warnings;
    }

    /// Takes a line of text that says what is being done.
    fn message(&self, text: &str) {
        let _ = text;
    }

    /// Begins a stage of about `total` lines; the meter is dropped when the stage ends.
    fn begin(&self, title: &str, total: u64, kind: StageKind) -> Box<dyn Meter> {
        let _ = (title, total, kind);
        Box::new(NoProgress)
    }
}

/// What kind of stage begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StageKind {
    /// A stage of a pipeline, announced by a message: its end is worth one, too.
    Whole,
    /// One of many that may be short, such as a stage of a repeat: its title says which.
    Part,
    /// All there is to do, which has been announced by a message.
    Only,
}

/// Is told how many lines of a stage are done.
pub trait Meter {
    /// Called a few times a second with the number of lines done so far and in all.
    fn progress(&mut self, done: u64, total: u64);
}

/// Shows nothing.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoProgress;

impl Progress for NoProgress {}

impl Meter for NoProgress {
    fn progress(&mut self, _: u64, _: u64) {}
}

/// `progress`, if `comm` is the rank that speaks.
pub(crate) fn of_rank<'p>(progress: &'p dyn Progress, comm: &dyn Communicator) -> &'p dyn Progress {
    if comm.is_first() { progress } else { &NoProgress }
}

impl dyn Progress + '_ {
    /// Passes on warnings.
    pub(crate) fn warn(&self, warnings: &[String]) {
        if !warnings.is_empty() {
            self.warnings(warnings);
        }
    }

    /// Says what is being done.
    pub(crate) fn note(&self, text: &str) {
        self.message(text);
    }

    /// Begins to watch a stage of `total` lines, which ends early if `stop` becomes true.
    pub(crate) fn stage(&self, name: &str, total: u64, stop: &Arc<AtomicBool>) -> StageProgress {
        self.note(&format!("{name}: {} lines", grouped(total)));
        StageProgress { meter: self.begin(name, total, StageKind::Whole), stop: Arc::clone(stop) }
    }

    /// As [`stage`](Self::stage), for one of many that may be short: nothing is said at its start and end.
    pub(crate) fn part(&self, title: &str, total: u64, stop: &Arc<AtomicBool>) -> StageProgress {
        StageProgress { meter: self.begin(title, total, StageKind::Part), stop: Arc::clone(stop) }
    }

    /// As [`stage`](Self::stage), without a word at the beginning and at the end.
    pub(crate) fn watch(&self, name: &str, total: u64, stop: &Arc<AtomicBool>) -> StageProgress {
        StageProgress { meter: self.begin(name, total, StageKind::Only), stop: Arc::clone(stop) }
    }
}

/// Watches one stage: passes on its progress, and ends it when it is to stop.
pub(crate) struct StageProgress {
    meter: Box<dyn Meter>,
    stop: Arc<AtomicBool>,
}

impl Observer for StageProgress {
    fn progress(&mut self, done: u64, total: u64) {
        self.meter.progress(done, total);
    }

    fn should_stop(&self) -> bool {
        self.stop.load(Relaxed)
    }
}
