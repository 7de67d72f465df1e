//! Runs of derived pipelines. Each run has its own directory, which is kept.

use std::ffi::OsStr;
use std::fs;
use std::io::Write as _;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use sir_view::Table;

use crate::error::StudyError;
use crate::experiment::agenda::Agenda;
use crate::experiment::subject::{Changes, Subject, TABLE};
use crate::scaling::launch::{Launcher, NO_CHECKPOINTS};
use crate::scaling::workers::Workers;
use sir_pipeline::fingerprint::PROGRAM;
use sir_pipeline::format::duration;
use sir_pipeline::report::Report;
use sir_pipeline::run::CHECKPOINT;
use sir_pipeline::run::read_report;
use sir_pipeline::stopwatch::Stopwatch;
use sir_pipeline::{ErrorKind, Progress};

/// Name of the pipeline file in a run's directory.
const PIPELINE: &str = "pipeline.ron";

/// Description of a run to make.
#[derive(Clone, Debug)]
pub(crate) struct Wanted {
    /// Name of the run, unique among the runs of a subject.
    pub(crate) name: String,
    pub(crate) changes: Changes,
    pub(crate) workers: Workers,
    /// True if the time of the run is evaluated. The run then writes no checkpoints, is never resumed, and its table is
    /// not kept.
    pub(crate) timed: bool,
}

/// Finished run.
pub(crate) struct Done {
    pub(crate) directory: PathBuf,
    pub(crate) report: Report,
}

/// Runs in the output directory; missing ones are made on demand.
pub(crate) struct Runs {
    pub(crate) launcher: Launcher,
    /// Absolute path of the output directory.
    pub(crate) folder: PathBuf,
    pub(crate) cores: NonZeroUsize,
    pub(crate) agenda: Agenda,
    pub(crate) progress: Arc<dyn Progress>,
}

impl Wanted {
    /// Returns a run on all cores of the machine.
    pub(crate) fn new(name: &str, changes: Changes, cores: NonZeroUsize) -> Self {
        let workers = Workers { ranks: NonZeroUsize::MIN, threads: cores };
        Self { name: name.into(), changes, workers, timed: false }
    }

    fn label(&self, subject: &Subject) -> String {
        format!("{}/{}", subject.name, self.name)
    }
}

impl Done {
    /// Reads a table of the run.
    pub(crate) fn table(&self, name: &str) -> Result<Table, StudyError> {
        Ok(Table::read(&self.directory.join(name))?)
    }
}

impl Runs {
    /// Adds a run to the agenda.
    pub(crate) fn plan(&mut self, subject: &Subject, wanted: &Wanted) {
        let workers = wanted.workers.count().min(self.cores.get());
        self.agenda.add(wanted.label(subject), wanted.changes.lines.total() as f64 / workers as f64);
    }

    /// Makes a run, unless its result already exists.
    pub(crate) fn get(&mut self, subject: &Subject, wanted: &Wanted) -> Result<Done, StudyError> {
        self.launcher.check_stop()?;
        let label = wanted.label(subject);
        let text = subject.derived(&wanted.changes);
        let directory = self.folder.join("runs").join(&subject.name).join(&wanted.name);
        if let Some(report) = finished(&directory, &text, wanted.timed) {
            self.agenda.done(&label, None);
            return Ok(Done { directory, report });
        }
        self.progress.message(&format!("{}: {label} on {}", self.agenda.place(), wanted.workers));
        let watch = Stopwatch::start();
        let report = self.make(&directory, &text, wanted)?;
        if wanted.timed {
            // The tables of timed runs are all the same, and large. A failure to remove one does no harm.
            let _ = fs::remove_file(directory.join(TABLE));
        }
        self.agenda.done(&label, Some(watch.seconds()));
        self.progress.message(&format!("  {}{}", duration(watch.seconds()), self.agenda.left()));
        Ok(Done { directory, report })
    }

    /// Runs a pipeline, or resumes an interrupted run of it from its checkpoint.
    fn make(&self, directory: &Path, text: &str, wanted: &Wanted) -> Result<Report, StudyError> {
        fs::create_dir_all(directory).map_err(sir_pipeline::Error::directory(directory))?;
        let pipeline = directory.join(PIPELINE);
        let same = fs::read_to_string(&pipeline).is_ok_and(|old| old == text);
        if same && !wanted.timed && directory.join(CHECKPOINT).exists() {
            match self.launcher.execute(wanted.workers, &["resume".as_ref(), directory.as_os_str()]) {
                // The checkpoint is from another program or scene: start a new run.
                Err(error) if error.kind() == ErrorKind::Usage => {}
                done => return done,
            }
        }
        sir_view::write_atomically(&pipeline, |file| file.write_all(text.as_bytes()))?;
        let words: [&OsStr; 5] = [
            "run".as_ref(),
            pipeline.as_os_str(),
            "--out".as_ref(),
            directory.as_os_str(),
            "--force".as_ref(),
        ];
        let more = if wanted.timed { &NO_CHECKPOINTS[..] } else { &[] };
        let more: Vec<&OsStr> = more.iter().map(OsStr::new).collect();
        self.launcher.execute(wanted.workers, &[&words[..], &more].concat())
    }
}

/// Returns the report of a finished run of this pipeline by this program, if all its files exist.
fn finished(directory: &Path, text: &str, timed: bool) -> Option<Report> {
    let report = read_report(directory).ok()?;
    let complete = timed || report.outputs.iter().all(|output| directory.join(&output.path).exists());
    (report.program == PROGRAM && report.pipeline.text == text && complete).then_some(report)
}

#[cfg(test)]
mod tests {
    use super::*;
    use sir_pipeline::report::{OutputReport, PipelineReport, SceneReport, Time, VERSION};

    #[test]
    fn a_run_counts_if_it_is_of_the_same_pipeline_and_program_and_complete() {
        let folder = tempfile::tempdir().unwrap();
        let there = |text: &str, timed| finished(folder.path(), text, timed).is_some();
        assert!(!there("x", true));
        let scene = SceneReport {
            path: String::new(),
            triangles: 1,
            patches: 1,
            sides: 1,
            area: 1.0,
            power: [1.0; 3],
            up: [0.0, 1.0, 0.0],
            up_from: String::new(),
            luminaires: Vec::new(),
            warnings: Vec::new(),
        };
        let mut report = Report {
            version: VERSION,
            program: PROGRAM.into(),
            units: sir_pipeline::Units::default(),
            pipeline: PipelineReport { path: String::new(), text: "x".into(), absolute: None },
            seed: 1,
            scene,
            stages: Vec::new(),
            groups: Vec::new(),
            mixed_from: None,
            warnings: Vec::new(),
            outputs: vec![OutputReport {
                path: TABLE.into(),
                kind: "table".into(),
                bytes: Some(1),
                camera: None,
            }],
            time: Time::of(1.0),
        };
        let mut write = |program: &str| {
            report.program = program.into();
            fs::write(folder.path().join("result.json"), report.to_json()).unwrap();
        };
        write(PROGRAM);
        assert!(there("x", true) && !there("y", true) && !there("x", false));
        fs::write(folder.path().join(TABLE), "").unwrap();
        assert!(there("x", false));
        write("another");
        assert!(!there("x", false));
    }
}
