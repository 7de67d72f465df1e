//! Runs a pipeline, or resumes a run.

use std::fs;
use std::io::Write as _;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use sir_geom::Rgb;
use sir_parallel::{Checkpoints, Communicator, RunError, Saved, SingleProcess};
use sir_radiosity::Model;
use sir_view::ViewError;

use crate::check::needs::check_memory;
use crate::error::Error;
use crate::fingerprint;
use crate::fingerprint::PROGRAM;
use crate::memory::largest_peak;
use crate::plan::Pipeline;
use crate::prepare::light_groups::LightGroup;
use crate::prepare::prepared::{Prepared, prepare};
use crate::progress::{NoProgress, Progress, of_rank};
use crate::ranks::{agree, same_everywhere};
use crate::report::result::{PipelineReport, Report, SceneReport, Time, VERSION};
use crate::run::directory::{absolute, check_given, make_given, make_new, run_name};
use crate::run::lock::DirectoryLock;
use crate::run::pages::Pages;
use crate::run::resume as saved_run;
use crate::run::resume::Head;
use crate::run_files::{CHECKPOINT, REPORT};
use crate::stopwatch::Stopwatch;
use crate::watcher::Watcher;

/// Options of a run. Only the seed changes the result.
#[derive(Clone, Debug)]
pub struct RunOptions {
    /// Run directory, or `None` for a new one in `results`.
    pub out: Option<PathBuf>,
    /// Parent of new run directories. Default `results`.
    pub results: PathBuf,
    /// True to replace a result in `out`.
    pub force: bool,
    /// Seed that replaces the pipeline's.
    pub seed: Option<u64>,
    /// Number of threads, or `None` for one per processor core.
    pub threads: Option<NonZeroUsize>,
    /// Time between two checkpoints. Default five minutes.
    pub checkpoint_every: Duration,
    /// Stop flag: when it becomes true, the run saves a checkpoint and ends.
    pub stop: Arc<AtomicBool>,
    /// Observer of the run. Default none.
    pub progress: Arc<dyn Progress>,
    /// Watcher of the light of the run. Default none.
    pub watcher: Option<Arc<dyn Watcher>>,
}

impl Default for RunOptions {
    fn default() -> Self {
        Self {
            out: None,
            results: "results".into(),
            force: false,
            seed: None,
            threads: None,
            checkpoint_every: Duration::from_secs(300),
            stop: Arc::default(),
            progress: Arc::new(NoProgress),
            watcher: None,
        }
    }
}

/// A finished run.
#[derive(Clone, Debug)]
pub struct RunResult {
    /// Run directory.
    pub directory: PathBuf,
    /// Contents of `result.json`.
    pub report: Report,
}

/// Runs the pipeline in the file `path`, and writes its files and `result.json`. Nothing is written before the scene
/// has been read.
///
/// # Errors
///
/// If the pipeline is invalid, the scene cannot be read, the light cannot be computed, or a file cannot be written.
pub fn run(path: &Path, options: &RunOptions) -> Result<RunResult, Error> {
    run_together(Pipeline::read(path), options, &SingleProcess)
}

/// Runs a pipeline, like [`run`].
///
/// # Errors
///
/// Same as [`run`].
pub fn run_pipeline(pipeline: &Pipeline, options: &RunOptions) -> Result<RunResult, Error> {
    run_together(Ok(pipeline.clone()), options, &SingleProcess)
}

/// Runs a pipeline on several ranks, each of which has read it, like [`run`]. Rank 0 writes the files; all ranks return
/// the same report.
///
/// # Errors
///
/// If [`run`] would fail, or the ranks have not read the same pipeline and scene. If one rank fails, all do.
pub fn run_together(
    pipeline: Result<Pipeline, Error>,
    options: &RunOptions,
    comm: &dyn Communicator,
) -> Result<RunResult, Error> {
    let watch = Stopwatch::start();
    let progress = of_rank(&*options.progress, comm);
    let given = options.out.as_deref().filter(|_| comm.is_first());
    let pipeline = agree(
        comm,
        pipeline.and_then(|pipeline| {
            given
                .map_or(Ok(()), |directory| check_given(directory, options.force, &pipeline))
                .map(|()| pipeline)
        }),
    )?;
    progress.note(&format!("Load: {}", pipeline.scene_path().display()));
    let prepared = agree(comm, prepare(&pipeline, progress))?;
    agree(comm, check_memory(&prepared, &pipeline, progress))?;
    let seed = options.seed.unwrap_or(pipeline.seed);
    let fingerprint = fingerprint::of_run(&pipeline, seed, &prepared);
    agree(comm, same_everywhere(comm, fingerprint))?;
    let (directory, lock) = agree(
        comm,
        match (given, comm.is_first()) {
            (_, false) => Ok((PathBuf::new(), None)),
            (Some(directory), _) => {
                make_given(directory, options.force, progress).map(|lock| (directory.to_owned(), Some(lock)))
            }
            (None, _) => make_new(&options.results, &run_name(&pipeline.path)).and_then(|directory| {
                let lock = DirectoryLock::acquire(&directory, progress)?;
                Ok((directory, Some(lock)))
            }),
        },
    )?;
    let has_groups = !prepared.groups.is_empty();
    let report = Report {
        version: VERSION,
        program: PROGRAM.into(),
        pipeline: PipelineReport {
            path: pipeline.path.display().to_string(),
            text: pipeline.text.clone(),
            absolute: has_groups.then(|| absolute(&pipeline.path).display().to_string()),
        },
        seed,
        units: pipeline.units,
        scene: scene_report(&prepared, pipeline.scene_path()),
        stages: Vec::new(),
        groups: Vec::new(),
        mixed_from: None,
        warnings: prepared.suspicions.clone(),
        outputs: Vec::new(),
        time: Time::of(0.0),
    };
    let head = Head::start(fingerprint::hex(fingerprint), absolute(&pipeline.path), report);
    let (pipeline, prepared) = (&pipeline, &prepared);
    let (group, seconds_before, pages) = (None, 0.0, Pages::default());
    let run = Run {
        pipeline,
        prepared,
        group,
        directory,
        lock,
        options,
        comm,
        progress,
        watch,
        seconds_before,
        head,
        pages,
    };
    run.finish(None)
}

/// Resumes the interrupted run in `directory`.
///
/// # Errors
///
/// Same as [`resume_together`].
pub fn resume(directory: &Path, options: &RunOptions) -> Result<RunResult, Error> {
    resume_together(directory, options, &SingleProcess)
}

/// Resumes an interrupted run on several ranks. The options for the run directory and the seed are ignored: those of
/// the interrupted run apply.
///
/// # Errors
///
/// If there is no checkpoint, if it belongs to another program, pipeline or scene, if another run uses the directory, or
/// if [`run_together`] would fail.
pub fn resume_together(
    directory: &Path,
    options: &RunOptions,
    comm: &dyn Communicator,
) -> Result<RunResult, Error> {
    let watch = Stopwatch::start();
    let progress = of_rank(&*options.progress, comm);
    let (lock, saved, head) = saved_run::open(directory, comm, progress)?;
    let pipeline = agree(comm, saved_run::pipeline(directory, &head))?;
    progress.note(&format!("Load: {}", pipeline.scene_path().display()));
    // The warnings were shown when the run began.
    let prepared = agree(comm, prepare(&pipeline, &NoProgress))?;
    agree(comm, check_memory(&prepared, &pipeline, progress))?;
    let fingerprint = fingerprint::of_run(&pipeline, head.report.seed, &prepared);
    agree(comm, saved_run::check_fingerprint(directory, &head, fingerprint))?;
    if comm.is_first() {
        saved_run::clean_up(directory, &pipeline);
    }
    let directory = directory.to_owned();
    // A run that had not begun a stage with lines starts with the first stage.
    let saved = (head.stage > 0).then_some(saved);
    let (pipeline, prepared, seconds_before) = (&pipeline, &prepared, head.report.time.seconds);
    let (group, pages) = (None, Pages::default());
    let run = Run {
        pipeline,
        prepared,
        group,
        directory,
        lock,
        options,
        comm,
        progress,
        watch,
        seconds_before,
        head,
        pages,
    };
    run.finish(saved)
}

/// A run in progress.
pub(crate) struct Run<'a> {
    pub(crate) pipeline: &'a Pipeline,
    pub(crate) prepared: &'a Prepared,
    /// Light group to which the lights of `prepared` are limited.
    pub(crate) group: Option<&'a LightGroup>,
    pub(crate) directory: PathBuf,
    /// Lock of the directory; only on the first rank.
    pub(crate) lock: Option<DirectoryLock>,
    pub(crate) options: &'a RunOptions,
    pub(crate) comm: &'a dyn Communicator,
    pub(crate) progress: &'a dyn Progress,
    pub(crate) watch: Stopwatch,
    /// Time before the run was resumed \[s\].
    pub(crate) seconds_before: f64,
    /// Progress of the run, as stored in checkpoints.
    pub(crate) head: Head,
    /// Pages that are written at the end.
    pub(crate) pages: Pages,
}

impl Run<'_> {
    fn finish(mut self, saved: Option<Saved>) -> Result<RunResult, Error> {
        let path = self.directory.join(CHECKPOINT);
        let mut checkpoints = Checkpoints::new(path, self.options.checkpoint_every);
        if saved.is_none() {
            checkpoints.set_head(self.head.to_line());
            agree(
                self.comm,
                checkpoints.save_start(self.comm).map_err(|error| RunError::from(error).into()),
            )?;
        }
        self.stages(&mut checkpoints, saved).map_err(|error| name_directory(error, &self.directory))?;
        let peak_memory = largest_peak(self.comm);
        self.head.report.time = Time { peak_memory, ..Time::of(self.seconds()) };
        let Self { directory, lock, comm, head, mut pages, prepared, options, .. } = self;
        let written = match comm.is_first() {
            true => pages
                .write(prepared, &directory, &head.report)
                .and_then(|()| write_report(&directory, &head.report)),
            false => Ok(()),
        };
        if let (Some(watcher), true) = (&options.watcher, comm.is_first()) {
            pages.show_last(&**watcher, prepared, &head.report);
        }
        agree(comm, written.map_err(|error| name_directory(error, &directory)))?;
        if comm.is_first() {
            checkpoints.remove();
        }
        drop(lock);
        Ok(RunResult { directory, report: head.report })
    }

    /// Passes on warnings about the result, and records them.
    pub(crate) fn warn(&mut self, mut warnings: Vec<String>) {
        if let Some(LightGroup { name, .. }) = self.group {
            warnings.iter_mut().for_each(|warning| *warning = format!("light group {name}: {warning}"));
        }
        self.progress.warn(&warnings);
        self.head.report.warnings.extend(warnings);
    }

    /// Returns the seed of all random numbers.
    pub(crate) fn seed(&self) -> u64 {
        let seed = self.head.report.seed;
        self.group.map_or(seed, |group| group.seed(seed))
    }

    /// Returns the time so far \[s\].
    pub(crate) fn seconds(&self) -> f64 {
        self.seconds_before + self.watch.seconds()
    }
}

/// Adds the run directory to the error of a run that can be resumed.
fn name_directory(error: Error, directory: &Path) -> Error {
    let directory = directory.to_owned();
    match error {
        Error::Run(RunError::Interrupted { done, total }) => Error::Interrupted { done, total, directory },
        Error::View(source @ ViewError::Io { .. }) => Error::NotWritten { directory, source },
        other => other,
    }
}

pub(super) fn scene_report(prepared: &Prepared, path: &Path) -> SceneReport {
    let Model { scene, mesh, .. } = &prepared.model;
    SceneReport {
        path: path.display().to_string(),
        triangles: scene.triangles().len(),
        patches: mesh.patch_count(),
        sides: mesh.side_count(),
        area: scene.total_area(),
        power: prepared.sources.iter().map(|s| s.power).sum::<Rgb>().to_array(),
        up: prepared.up.to_array(),
        up_from: prepared.up_from.clone(),
        luminaires: prepared.luminaires.clone(),
        warnings: prepared.warnings.clone(),
    }
}

pub(super) fn write_report(directory: &Path, report: &Report) -> Result<(), Error> {
    sir_view::write_atomically(&directory.join(REPORT), |file| file.write_all(report.to_json().as_bytes()))?;
    Ok(())
}

/// Reads the report of a run directory.
///
/// # Errors
///
/// If there is no report, it is invalid, or it has another version.
pub fn read_report(directory: &Path) -> Result<Report, Error> {
    let no_result = |why: String| Error::NoResult { directory: directory.to_owned(), why };
    let text = fs::read_to_string(directory.join(REPORT)).map_err(|e| no_result(e.to_string()))?;
    let report: Report = serde_json::from_str(&text).map_err(|e| no_result(e.to_string()))?;
    if report.version == VERSION {
        return Ok(report);
    }
    Err(no_result(format!("it has version {}, but this program reads version {VERSION}", report.version)))
}
