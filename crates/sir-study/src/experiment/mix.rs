//! Part `mix`: the best share of local lines.

use std::io;

use serde::Serialize;

use crate::error::StudyError;
use crate::experiment::accuracy::{Accuracy, Reference};
use crate::experiment::curves::Diagram;
use crate::experiment::lines::{Lines, Rates};
use crate::experiment::markdown::{Grid, count, percent, whole_percent};
use crate::experiment::paper::BEST_SHARE;
use crate::experiment::runs::{Runs, Wanted};
use crate::experiment::speed;
use crate::experiment::subject::{Changes, Subject, TABLE};
use crate::scaling::table::seconds;

/// Shares of local lines to compare \[%\].
const SHARES: [u32; 10] = [5, 10, 20, 30, 40, 50, 60, 70, 80, 90];

/// Share of the pipeline's lines that is traced, to save time.
const LINE_SHARE: f64 = 0.25;

/// Factor on the smallest error up to which other errors count as equally good.
const EQUALLY_GOOD: f64 = 1.05;

/// Mixture of local and global lines, with its error.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(crate) struct Mixture {
    /// Requested share of local lines.
    pub(crate) share: f64,
    /// Numbers of lines.
    pub(crate) lines: Lines,
    /// Measured time of the first shot and multipath \[s\], on all cores.
    pub(crate) seconds: f64,
    /// Error against the reference.
    #[serde(flatten)]
    pub(crate) accuracy: Accuracy,
}

/// Best of several mixtures.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(crate) struct Best {
    /// Share of local lines of the best mixture.
    pub(crate) share: f64,
    /// Relative RMS of its luminance.
    pub(crate) relative_rms: f64,
    /// Smallest share whose error is at most 5 % larger.
    pub(crate) from: f64,
    /// Largest such share.
    pub(crate) to: f64,
}

/// Results of the part.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Mix {
    /// Lines to divide between the stages: a quarter of the pipeline's, scaled.
    pub(crate) lines: Lines,
    /// Rates of the sequential run.
    pub(crate) rates: Rates,
    /// Mixtures with the same total number of lines.
    pub(crate) equal_lines: Vec<Mixture>,
    /// Mixtures that take the same time at the rates.
    pub(crate) equal_time: Vec<Mixture>,
    /// Best mixture with an equal number of lines.
    pub(crate) best_of_lines: Option<Best>,
    /// Best mixture with equal time.
    pub(crate) best_of_time: Option<Best>,
}

/// Names of the two ways to choose the numbers of lines.
const KINDS: [&str; 2] = ["lines", "time"];

fn wanted(runs: &Runs, subject: &Subject, kind: &str, percent: u32, lines: Lines) -> Wanted {
    let changes = Changes { lines, transport: subject.transport_of(lines.global), ..subject.changes() };
    Wanted::new(&format!("mix-{kind}-{percent:02}"), changes, runs.cores)
}

/// Adds all runs to the agenda. The numbers of lines for equal time are only known after the sequential run.
pub(crate) fn plan(runs: &mut Runs, subject: &Subject) {
    for (kind, percent) in KINDS.iter().flat_map(|kind| SHARES.map(|percent| (kind, percent))) {
        let wanted = wanted(runs, subject, kind, percent, subject.lines.times(LINE_SHARE));
        runs.plan(subject, &wanted);
    }
}

/// Makes the runs and compares them.
pub(crate) fn find(runs: &mut Runs, subject: &Subject, reference: &Reference) -> Result<Mix, StudyError> {
    let rates = speed::rates(runs, subject)?;
    let lines = subject.lines.times(LINE_SHARE);
    let mut mixtures = |kind, of: &dyn Fn(f64) -> Lines| -> Result<Vec<Mixture>, StudyError> {
        let one = |percent: u32| {
            let share = f64::from(percent) / 100.0;
            let lines = of(share);
            let run = runs.get(subject, &wanted(runs, subject, kind, percent, lines))?;
            let seconds = speed::time(&run.report, &["FirstShot", "Multipath"]);
            Ok(Mixture { share, lines, seconds, accuracy: reference.accuracy(&run.table(TABLE)?)? })
        };
        SHARES.into_iter().map(one).collect()
    };
    let equal_lines = mixtures(KINDS[0], &|share| lines.with_share(share))?;
    let equal_time = mixtures(KINDS[1], &|share| lines.in_equal_time(share, rates))?;
    let (best_of_lines, best_of_time) = (best(&equal_lines), best(&equal_time));
    Ok(Mix { lines, rates, equal_lines, equal_time, best_of_lines, best_of_time })
}

/// Returns the mixture with the smallest error, and the range of shares around it that are equally good.
fn best(mixtures: &[Mixture]) -> Option<Best> {
    let rms = |m: &Mixture| m.accuracy.relative_rms.luminance;
    let best = mixtures.iter().min_by(|a, b| rms(a).total_cmp(&rms(b)))?;
    let good = mixtures.iter().filter(|m| rms(m) <= EQUALLY_GOOD * rms(best));
    let (from, to) = good.fold((best.share, best.share), |(a, b), m| (a.min(m.share), b.max(m.share)));
    Some(Best { share: best.share, relative_rms: rms(best), from, to })
}

impl Best {
    /// Returns true if a share is as good as the best one.
    pub(crate) fn includes(&self, share: f64) -> bool {
        (self.from - 1e-9..=self.to + 1e-9).contains(&share)
    }

    /// Describes the minimum and its flatness.
    pub(crate) fn text(&self) -> String {
        format!(
            "{} at {} local lines, within 5 % of that from {} to {}",
            percent(self.relative_rms),
            whole_percent(self.share),
            whole_percent(self.from),
            whole_percent(self.to)
        )
    }
}

impl Mix {
    /// Draws the errors over the share of local lines.
    pub(crate) fn svg(&self, name: &str) -> io::Result<String> {
        let points = |mixtures: &[Mixture]| -> Vec<(f64, f64)> {
            mixtures.iter().map(|m| (100.0 * m.share, 100.0 * m.accuracy.relative_rms.luminance)).collect()
        };
        let diagram = Diagram {
            title: &format!("{name}: error over the share of local lines"),
            x_label: "share of local lines [%]",
            y_label: "relative RMS of luminance [%]",
            x_last: 100.0,
            mark: (100.0 * BEST_SHARE, "paper"),
            curves: &[
                ("equal number of lines", points(&self.equal_lines)),
                ("equal time", points(&self.equal_time)),
            ],
        };
        diagram.svg()
    }

    /// Returns the section of the report; `figure` is the file name of the diagram.
    pub(crate) fn section(&self, figure: &str) -> String {
        let mut text = format!(
            "### Local and global lines\n\nA quarter of the lines ({} in all), divided between the first \
             shot and multipath, against the reference. For equal time, the numbers of lines are chosen so \
             that both stages take {:.3} s on one thread at the rates of the sequential run ({} local and {} \
             global lines per second). Times were measured on all cores, so they include work that does not \
             depend on the number of lines.\n\n",
            count(self.lines.total()),
            self.lines.seconds(self.rates),
            count(self.rates.local as u64),
            count(self.rates.global as u64),
        );
        for (name, mixtures) in
            [("Equal number of lines", &self.equal_lines), ("Equal time", &self.equal_time)]
        {
            let mut grid = Grid::new(&["local lines", "local", "global", "relative RMS", "time [s]"]);
            for m in mixtures {
                grid.row([
                    whole_percent(m.share),
                    count(m.lines.local),
                    count(m.lines.global),
                    percent(m.accuracy.relative_rms.luminance),
                    seconds(m.seconds),
                ]);
            }
            text += &format!("{name}:\n\n{}", grid.end());
        }
        if let (Some(lines), Some(time)) = (self.best_of_lines, self.best_of_time) {
            text += &format!(
                "With an equal number of lines the smallest error is {}; with equal time it is {}.\n\n",
                lines.text(),
                time.text()
            );
        }
        text + &format!("![Error over the share of local lines]({figure})\n\n")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::experiment::accuracy::Bands;

    #[test]
    fn the_best_share_has_neighbors_that_are_as_good() {
        let all = |x: f64| Bands { luminance: x, red: x, green: x, blue: x };
        let mixture = |(share, rms): (f64, f64)| Mixture {
            share,
            lines: Lines { local: 1, global: 1 },
            seconds: 1.0,
            accuracy: Accuracy { relative_rms: all(rms), relative_bias: all(0.0) },
        };
        let mixtures: Vec<_> =
            [(0.1, 0.03), (0.2, 0.0209), (0.3, 0.02), (0.4, 0.0205), (0.5, 0.022)].map(mixture).into();
        let best = best(&mixtures).unwrap();
        assert_eq!((best.share, best.from, best.to), (0.3, 0.2, 0.4));
        assert!(best.includes(0.4) && !best.includes(0.5));
        assert_eq!(best.text(), "2.00 % at 30 % local lines, within 5 % of that from 20 % to 40 %");
    }
}
