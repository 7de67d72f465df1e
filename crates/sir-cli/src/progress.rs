//! What a run says while it runs, on the standard error stream.

use std::io::IsTerminal;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use sir_parallel::{Communicator, Observer};

use crate::fields::grouped;

/// Time between two lines of progress where there is no terminal.
pub(crate) const PAUSE: Duration = Duration::from_secs(10);

/// Most warnings that are shown one by one.
const WARNINGS: usize = 10;

/// How progress is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Progress {
    /// Not at all; warnings are not shown either. For callers that read them from the report.
    Silent,
    /// Warnings only.
    Quiet,
    /// A line at the start and the end of each stage, and every ten seconds in between.
    Lines,
    /// A bar with rate and remaining time.
    Bar,
}

impl Progress {
    /// A bar if the standard error stream is a terminal, else lines.
    #[must_use]
    pub fn for_stderr() -> Self {
        if std::io::stderr().is_terminal() { Self::Bar } else { Self::Lines }
    }

    /// This, if `comm` is the rank that speaks.
    pub(crate) fn of_rank(self, comm: &dyn Communicator) -> Self {
        if comm.is_first() { self } else { Self::Silent }
    }

    /// Shows the warnings of the scene's reader.
    pub(crate) fn warn(self, warnings: &[String]) {
        if self == Self::Silent {
            return;
        }
        for warning in warnings.iter().take(WARNINGS) {
            eprintln!("warning: {warning}");
        }
        if warnings.len() > WARNINGS {
            eprintln!("warning: … and {} more, see result.json", warnings.len() - WARNINGS);
        }
    }

    /// Says what is being done.
    pub(crate) fn note(self, text: &str) {
        if matches!(self, Self::Lines | Self::Bar) {
            eprintln!("{text}");
        }
    }

    /// Begins to watch a stage of `total` lines, which ends early if `stop` becomes true.
    pub(crate) fn stage(self, name: &str, total: u64, stop: &Arc<AtomicBool>) -> StageProgress {
        self.note(&format!("{name}: {} lines", grouped(total)));
        let mut watching = self.watch(name, total, stop);
        watching.says_end = self == Self::Lines;
        watching
    }

    /// As [`stage`](Self::stage), for one of many that may be short: nothing is said at its start and end.
    pub(crate) fn part(self, title: &str, total: u64, stop: &Arc<AtomicBool>) -> StageProgress {
        let watching = self.watch(title, total, stop);
        watching.bar.set_prefix(format!("{title}  "));
        watching
    }

    /// As [`stage`](Self::stage), without a word at the beginning and at the end.
    pub(crate) fn watch(self, name: &str, total: u64, stop: &Arc<AtomicBool>) -> StageProgress {
        let bar = match self {
            Self::Bar => {
                let bar = ProgressBar::new(total);
                let template = "{prefix}{bar:30} {percent:>3} %  {human_pos} lines  {per_sec}  {eta} left";
                // A wrong template would be a slip in the line above; indicatif's own style then serves as well.
                if let Ok(style) = ProgressStyle::with_template(template) {
                    bar.set_style(style);
                }
                bar
            }
            _ => ProgressBar::hidden(),
        };
        let now = Instant::now();
        let stop = Arc::clone(stop);
        StageProgress {
            lines: self == Self::Lines,
            says_end: false,
            name: name.to_owned(),
            bar,
            start: now,
            last: now,
            first: None,
            done: 0,
            stop,
        }
    }
}

/// Watches one stage.
pub(crate) struct StageProgress {
    lines: bool,
    /// Whether the end is worth a line.
    says_end: bool,
    name: String,
    bar: ProgressBar,
    start: Instant,
    last: Instant,
    /// Lines done when the first progress was reported: more than a few after a restart.
    first: Option<u64>,
    done: u64,
    stop: Arc<AtomicBool>,
}

impl Observer for StageProgress {
    fn progress(&mut self, done: u64, total: u64) {
        // How many lines it takes may be known better in the course of them.
        self.bar.set_length(total);
        self.bar.set_position(done);
        let first = *self.first.get_or_insert(done);
        if self.done == 0 {
            self.bar.reset_eta();
        }
        self.done = done;
        if self.lines && self.last.elapsed() >= PAUSE {
            self.last = Instant::now();
            let seconds = self.start.elapsed().as_secs_f64();
            let rate = ((done - first) as f64 / seconds).max(1.0);
            eprintln!(
                "{}: {:.0} %, {} lines/s, {:.0} s left",
                self.name,
                100.0 * done as f64 / total.max(1) as f64,
                grouped(rate as u64),
                (total - done) as f64 / rate
            );
        }
    }

    fn should_stop(&self) -> bool {
        self.stop.load(Relaxed)
    }
}

impl Drop for StageProgress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
        if self.says_end {
            let seconds = self.start.elapsed().as_secs_f64();
            eprintln!("{}: {} lines after {seconds:.1} s", self.name, grouped(self.done));
        }
    }
}
