//! Part `scaling`: times, speed-ups and efficiencies, as in figures 6 and 7 of the paper.

use std::io;

use serde::Serialize;

use crate::error::StudyError;
use crate::experiment::lines::Rates;
use crate::experiment::markdown::{Grid, megabytes};
use crate::experiment::paper;
use crate::experiment::paper::{MACHINE, P, Published, Times};
use crate::experiment::runs::{Runs, Wanted};
use crate::experiment::subject::Subject;
use crate::scaling::measure::measure;
use crate::scaling::plot::svg_beside;
use crate::scaling::statistics::Part;
use crate::scaling::study::{Row, Study};
use crate::scaling::table::{markdown, seconds};
use crate::scaling::workers::{Plan, Workers};
use sir_pipeline::NoProgress;
use sir_pipeline::report::Report;

/// Times of the parts of one run \[s\], and its memory.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(crate) struct Stages {
    /// Ranks and threads.
    #[serde(flatten)]
    pub(crate) workers: Workers,
    /// Reading the scene and making patches.
    pub(crate) loading: f64,
    /// The first shot.
    pub(crate) first_shot: f64,
    /// Multipath.
    pub(crate) multipath: f64,
    /// Writing the table.
    pub(crate) saving: f64,
    /// The whole run.
    pub(crate) whole: f64,
    /// Peak memory of the largest rank \[bytes\].
    pub(crate) peak_memory: Option<u64>,
}

/// Results of the part.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Speed {
    /// Speed-ups and efficiencies.
    pub(crate) study: Study,
    /// Times of all stages, in the order of the study's rows.
    pub(crate) stages: Vec<Stages>,
    /// Numbers of the paper, if the task is the same.
    pub(crate) published: Option<Published>,
}

/// Function that takes a part of a run from its row.
type Pick = fn(&Row) -> Option<Part>;

/// Returns the run on these workers.
pub(crate) fn wanted(subject: &Subject, workers: Workers) -> Wanted {
    let name = format!("scaling-{}x{}", workers.ranks, workers.threads);
    Wanted { name, changes: subject.changes(), workers, timed: true }
}

/// Returns the lines per second of the sequential run.
pub(crate) fn rates(runs: &mut Runs, subject: &Subject) -> Result<Rates, StudyError> {
    let report = runs.get(subject, &wanted(subject, Workers::BASELINE))?.report;
    let rate = |name, lines: u64| lines as f64 / time(&report, &[name]).max(1e-9);
    Ok(Rates {
        local: rate("FirstShot", subject.lines.local),
        global: rate("Multipath", subject.lines.global),
    })
}

/// Returns the total time of the stages with these names \[s\].
pub(crate) fn time(report: &Report, names: &[&str]) -> f64 {
    report.stages.iter().filter(|s| names.contains(&s.name.as_str())).map(|s| s.time.seconds).sum()
}

/// Makes the runs of a plan.
pub(crate) fn find(
    runs: &mut Runs,
    subject: &Subject,
    plan: &Plan,
    patches: usize,
) -> Result<Speed, StudyError> {
    let mut stages = Vec::new();
    let cores = runs.cores.get();
    let study = measure(&subject.name, cores, plan, &NoProgress, &mut |workers| {
        let report = runs.get(subject, &wanted(subject, workers))?.report;
        stages.push(Stages {
            workers,
            loading: time(&report, &["Load", "Subdivide"]),
            first_shot: time(&report, &["FirstShot"]),
            multipath: time(&report, &["Multipath"]),
            saving: time(&report, &["Save"]),
            whole: report.time.seconds,
            peak_memory: report.time.peak_memory,
        });
        Ok(report)
    })?;
    Ok(Speed { study, stages, published: paper::published(&subject.name, patches, subject.asked) })
}

impl Speed {
    /// Draws figures 6 and 7.
    pub(crate) fn svg(&self) -> io::Result<String> {
        let others: Vec<Row> = self.published.iter().map(Published::row).collect();
        svg_beside(&self.study, &others, "paper")
    }

    /// Returns the section of the report; `figure` is the file name of the diagram.
    pub(crate) fn section(&self, figure: &str, scale: f64) -> String {
        let columns = [
            "workers",
            "loading [s]",
            "first shot [s]",
            "multipath [s]",
            "saving [s]",
            "all [s]",
            "peak memory",
        ];
        let mut grid = Grid::new(&columns);
        for s in &self.stages {
            let times = [s.loading, s.first_shot, s.multipath, s.saving, s.whole].map(seconds);
            let cells = std::iter::once(s.workers.to_string()).chain(times);
            grid.row(cells.chain([megabytes(s.peak_memory)]));
        }
        let mut text = format!(
            "### Speed-up and efficiency\n\n{}Loading is reading the scene and making patches; saving is \
             writing the table. Memory is that of the largest rank.\n\n{}\n![Speed-up and efficiency over \
             the number of workers]({figure})\n\n",
            grid.end(),
            markdown(&self.study)
        );
        if !sir_parallel::HAS_MPI {
            text += "This program was built without MPI, so ranks were not measured (`cargo build --release \
                --features mpi`).\n\n";
        }
        if let Some(published) = &self.published {
            text += &self.comparison(published, scale);
        }
        text
    }

    /// Returns the comparison of these times with those of the paper.
    fn comparison(&self, published: &Published, scale: f64) -> String {
        let mut text = format!(
            "The paper measured a different scene of the same subject, with the same numbers of patches and \
             lines, on {MACHINE}. Its speed-ups and efficiencies are computed from its times.\n\n"
        );
        if scale < 1.0 {
            text += &format!(
                "**Here only {scale} times as many lines were traced**, so times cannot be compared, and \
                 work that does not depend on the number of lines weighs more here.\n\n"
            );
        }
        let mut grid = Grid::new(&["", "T(1) [s]", "T(8) [s]", "S(8)", "E(8)"]);
        let here = |pick: Pick, p| {
            let row = self.study.rows.iter().find(|row| row.p == p && row.workers.ranks.get() == 1);
            row.and_then(pick)
        };
        let parts: [(&str, Times, Pick); 3] = [
            ("first shot", published.first_shot, |row| row.first_shot),
            ("multipath", published.multipath, |row| row.multipath),
            ("all", published.whole, |row| Some(row.whole)),
        ];
        for (name, times, pick) in parts {
            let part = times.part();
            let ratios = [part.speed_up, part.efficiency].map(|x| format!("{x:.2}"));
            let [one, many] = [times.sequential, times.parallel].map(|t| format!("{t:.1}"));
            let cells = [format!("{name}, paper"), one, many];
            grid.row(cells.into_iter().chain(ratios));
            let one = here(pick, 1).map_or("-".into(), |one| seconds(one.seconds.median));
            let eight = here(pick, P).map_or_else(
                || ["not measured".into(), "-".into(), "-".into()],
                |part| {
                    [
                        seconds(part.seconds.median),
                        format!("{:.2}", part.speed_up),
                        format!("{:.2}", part.efficiency),
                    ]
                },
            );
            grid.row([format!("{name}, here (threads)"), one].into_iter().chain(eight));
        }
        text += &grid.end();
        if let Some(one) = here(|row| Some(row.whole), 1).filter(|_| scale >= 1.0) {
            text += &format!(
                "One processor is {:.1} times as fast here.\n\n",
                published.whole.sequential / one.seconds.median.max(1e-9)
            );
        }
        text
    }
}
