//! Progress of a run: the interface through which a caller observes it.

use std::fmt::Debug;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::time::Duration;

use sir_parallel::{Communicator, Observer};

use crate::format::grouped;

/// Minimum time between two messages about parts of a stage, which may be short.
pub const PAUSE: Duration = Duration::from_secs(10);

/// Observer of a run. All methods do nothing by default.
pub trait Progress: Debug + Send + Sync {
    /// Receives warnings of the scene reader or about the result. The report has them, too.
    fn warnings(&self, warnings: &[String]) {
        let _ = warnings;
    }

    /// Receives a line of text that describes the current activity.
    fn message(&self, text: &str) {
        let _ = text;
    }

    /// Begins a stage of about `total` lines, or of things that `kind` names. The returned meter is dropped when the stage ends.
    fn begin(&self, title: &str, total: u64, kind: StageKind) -> Box<dyn Meter> {
        let _ = (title, total, kind);
        Box::new(NoProgress)
    }
}

/// Kind of a stage that begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StageKind {
    /// A stage of a pipeline. A message announces it; its end deserves a message, too.
    Whole,
    /// One of many stages that may be short, such as a stage of a repeat. Its title says which.
    Part,
    /// The only stage. It has been announced by a message.
    Only,
    /// Work without lines, such as on a lightmap. Counts things of this name.
    Work(&'static str),
}

/// Observer of one stage.
pub trait Meter: Send {
    /// Receives the number of lines traced (or of things done) so far and in total, a few times a second.
    fn progress(&mut self, done: u64, total: u64);
}

/// Observer that shows nothing.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoProgress;

impl Progress for NoProgress {}

impl Meter for NoProgress {
    fn progress(&mut self, _: u64, _: u64) {}
}

/// Returns `progress` on rank 0, and [`NoProgress`] on the others.
pub(crate) fn of_rank<'p>(progress: &'p dyn Progress, comm: &dyn Communicator) -> &'p dyn Progress {
    if comm.is_first() { progress } else { &NoProgress }
}

impl dyn Progress + '_ {
    /// Passes on warnings, if there are any.
    pub(crate) fn warn(&self, warnings: &[String]) {
        if !warnings.is_empty() {
            self.warnings(warnings);
        }
    }

    /// Passes on a message.
    pub(crate) fn note(&self, text: &str) {
        self.message(text);
    }

    /// Announces and begins a stage of `total` lines, which ends early if `stop` becomes true.
    pub(crate) fn stage(&self, name: &str, total: u64, stop: &Arc<AtomicBool>) -> StageProgress {
        self.note(&format!("{name}: {} lines", grouped(total)));
        StageProgress { meter: self.begin(name, total, StageKind::Whole), stop: Arc::clone(stop) }
    }

    /// Like [`stage`](Self::stage), for one of many stages that may be short: without messages at its start and end.
    pub(crate) fn part(&self, title: &str, total: u64, stop: &Arc<AtomicBool>) -> StageProgress {
        StageProgress { meter: self.begin(title, total, StageKind::Part), stop: Arc::clone(stop) }
    }

    /// Like [`stage`](Self::stage), for the only stage: without messages at its start and end.
    pub(crate) fn watch(&self, name: &str, total: u64, stop: &Arc<AtomicBool>) -> StageProgress {
        StageProgress { meter: self.begin(name, total, StageKind::Only), stop: Arc::clone(stop) }
    }
}

/// Observer that passes on the progress of one stage, and stops it on request.
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
