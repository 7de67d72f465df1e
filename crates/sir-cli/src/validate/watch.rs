//! Progress of a validation on standard error.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use sir_validate::Watcher;

use crate::output::print_note;
use crate::progress::Stderr;

/// Time between two progress lines if there is no terminal.
const PAUSE: Duration = Duration::from_secs(10);

/// Display of the current case and the remaining time of all cases.
pub(super) struct Watch {
    progress: Stderr,
    stop: Arc<AtomicBool>,
    bar: ProgressBar,
    start: Instant,
    last: Instant,
    begun: bool,
}

impl Watch {
    pub(super) fn new(progress: Stderr, stop: Arc<AtomicBool>) -> Self {
        let bar = match progress {
            Stderr::Bar => {
                let bar = ProgressBar::new(1);
                let template = "{bar:30} {percent:>3} %  {msg}  {eta} left";
                // Only a mistake in the template above makes it invalid; indicatif's default style is then good enough.
                if let Ok(style) = ProgressStyle::with_template(template) {
                    bar.set_style(style);
                }
                bar
            }
            _ => ProgressBar::hidden(),
        };
        let now = Instant::now();
        Self { progress, stop, bar, start: now, last: now, begun: false }
    }
}

impl Watcher for Watch {
    fn begin(&mut self, case: &str, title: &str) {
        self.begun = true;
        self.bar.set_message(case.to_owned());
        if self.progress == Stderr::Lines {
            print_note(format_args!("{:.0} s: {case}, {title}", self.start.elapsed().as_secs_f64()));
        }
    }

    fn progress(&mut self, done: u64, total: u64) {
        self.bar.set_length(total);
        self.bar.set_position(done);
        if self.progress == Stderr::Lines && self.last.elapsed() >= PAUSE {
            self.last = Instant::now();
            let share = done as f64 / total.max(1) as f64;
            let left = self.start.elapsed().as_secs_f64() * (1.0 - share) / share.max(1e-3);
            print_note(format_args!("{:.0} %, {left:.0} s left", 100.0 * share));
        }
    }

    fn should_stop(&self) -> bool {
        self.stop.load(Relaxed)
    }
}

impl Drop for Watch {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
        if self.begun && self.progress == Stderr::Lines {
            print_note(format_args!("after {:.0} s", self.start.elapsed().as_secs_f64()));
        }
    }
}
