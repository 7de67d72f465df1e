//! Progress and warnings of a run on standard error.

use std::io::IsTerminal;
use std::time::Instant;

use indicatif::{ProgressBar, ProgressStyle};
use sir_pipeline::Progress;
use sir_pipeline::format::grouped;
use sir_pipeline::progress::{Meter, PAUSE, StageKind};

use crate::output::print_note;

/// Maximum number of warnings that are printed one by one.
const MAX_WARNINGS: usize = 10;

/// Display of progress and warnings on standard error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stderr {
    /// Warnings only.
    Quiet,
    /// A line at the start and the end of each stage, and every ten seconds in between.
    Lines,
    /// A bar with rate and remaining time.
    Bar,
}

impl Stderr {
    /// Returns [`Bar`](Self::Bar) if standard error is a terminal, otherwise [`Lines`](Self::Lines).
    #[must_use]
    pub fn new() -> Self {
        if std::io::stderr().is_terminal() { Self::Bar } else { Self::Lines }
    }

    /// Returns [`Quiet`](Self::Quiet) if `quiet` is true, otherwise the same as [`new`](Self::new).
    #[must_use]
    pub fn unless(quiet: bool) -> Self {
        if quiet { Self::Quiet } else { Self::new() }
    }
}

impl Default for Stderr {
    fn default() -> Self {
        Self::new()
    }
}

impl Progress for Stderr {
    fn warnings(&self, warnings: &[String]) {
        for warning in warnings.iter().take(MAX_WARNINGS) {
            print_note(format_args!("warning: {warning}"));
        }
        if warnings.len() > MAX_WARNINGS {
            print_note(format_args!(
                "warning: … and {} more, see result.json",
                warnings.len() - MAX_WARNINGS
            ));
        }
    }

    fn message(&self, text: &str) {
        if *self != Self::Quiet {
            print_note(text);
        }
    }

    fn begin(&self, title: &str, total: u64, kind: StageKind) -> Box<dyn Meter> {
        let unit = if let StageKind::Work(unit) = kind { unit } else { "lines" };
        let bar = match self {
            Self::Bar => {
                let bar = ProgressBar::new(total);
                let template = format!(
                    "{{prefix}}{{bar:30}} {{percent:>3}} %  {{human_pos}} {unit}  {{per_sec}}  {{eta}} left"
                );
                // Only a mistake in the template above makes it invalid; indicatif's default style is then good enough.
                if let Ok(style) = ProgressStyle::with_template(&template) {
                    bar.set_style(style);
                }
                bar
            }
            _ => ProgressBar::hidden(),
        };
        if matches!(kind, StageKind::Part | StageKind::Work(_)) {
            bar.set_prefix(format!("{title}  "));
        }
        let now = Instant::now();
        let lines = *self == Self::Lines;
        Box::new(StageMeter {
            lines,
            announces_end: lines && kind == StageKind::Whole,
            name: title.to_owned(),
            unit,
            bar,
            start: now,
            last: now,
            first: None,
            done: 0,
        })
    }
}

/// Progress meter of one stage.
struct StageMeter {
    lines: bool,
    /// True if the end of the stage is printed as a line.
    announces_end: bool,
    name: String,
    /// Name of what is counted.
    unit: &'static str,
    bar: ProgressBar,
    start: Instant,
    last: Instant,
    /// Number of lines done at the first report of progress; it is large after a resume.
    first: Option<u64>,
    done: u64,
}

impl Meter for StageMeter {
    fn progress(&mut self, done: u64, total: u64) {
        // The estimate of the total may improve during the stage.
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
            print_note(format_args!(
                "{}: {:.0} %, {} {}/s, {:.0} s left",
                self.name,
                100.0 * done as f64 / total.max(1) as f64,
                grouped(rate as u64),
                self.unit,
                total.saturating_sub(done) as f64 / rate
            ));
        }
    }
}

impl Drop for StageMeter {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
        if self.announces_end {
            let seconds = self.start.elapsed().as_secs_f64();
            print_note(format_args!("{}: {} lines after {seconds:.1} s", self.name, grouped(self.done)));
        }
    }
}
