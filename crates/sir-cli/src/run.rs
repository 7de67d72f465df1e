//! Running a pipeline, or going on with one.

use std::fs;
use std::io::Write as _;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::time::Duration;

use sir_geom::Rgb;
use sir_parallel::{Alone, Checkpoints, Communicator, Crew, RunError, Saved, StageTime, cores};
use sir_radiosity::{Model, MultipathSettings, Quanta, Shot, Solution};
use sir_view::ViewError;

use crate::Error;
use crate::check;
use crate::directory::{absolute, check_given, make_given, make_new, run_name};
use crate::fingerprint::{self, PROGRAM};
use crate::memory::largest_peak;
use crate::pipeline::{Action, Output, Pipeline, Transport};
use crate::prepare::{Prepared, prepare};
use crate::progress::Progress;
use crate::ranks::{agree, same_everywhere};
use crate::report::{
    DomainReport, FILE_NAME, Facts, LinesReport, PipelineReport, Report, SceneReport, StageReport, Stopwatch,
    Time, VERSION,
};
use crate::resume::{self, CHECKPOINT, Head};
use crate::save::save;

/// How to run a pipeline. None of this changes the result, but for the seed.
#[derive(Clone, Debug)]
pub struct RunOptions {
    /// The run directory; `None` for a new one in `results`.
    pub out: Option<PathBuf>,
    /// Where new run directories are made. Default `results`.
    pub results: PathBuf,
    /// Whether to replace a result in `out`.
    pub force: bool,
    /// Seed instead of the pipeline's.
    pub seed: Option<u64>,
    /// Threads; `None` for one per processor core.
    pub threads: Option<NonZeroUsize>,
    /// Time from one checkpoint to the next. Default five minutes.
    pub checkpoint_every: Duration,
    /// When this becomes true, the run saves a checkpoint and ends.
    pub stop: Arc<AtomicBool>,
    /// How progress is shown.
    pub progress: Progress,
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
            progress: Progress::Silent,
        }
    }
}

/// A finished run.
#[derive(Clone, Debug)]
pub struct RunResult {
    /// Where its files are.
    pub directory: PathBuf,
    /// What `result.json` says.
    pub report: Report,
}

/// Runs a pipeline and writes its files and `result.json`. Nothing is written before the scene has been read.
///
/// # Errors
///
/// If the scene cannot be read, the light cannot be computed, or a file cannot be written.
pub fn run(pipeline: &Pipeline, options: &RunOptions) -> Result<RunResult, Error> {
    run_together(Ok(pipeline.clone()), options, &Alone)
}

/// As [`run`], by several ranks that have all read the pipeline. The first one writes; all return the same report.
///
/// # Errors
///
/// As [`run`], or if the ranks have not read the same pipeline and scene. If one of them fails, all do.
pub fn run_together(
    pipeline: Result<Pipeline, Error>,
    options: &RunOptions,
    comm: &dyn Communicator,
) -> Result<RunResult, Error> {
    let watch = Stopwatch::start();
    let progress = options.progress.of_rank(comm);
    let given = options.out.as_deref().filter(|_| comm.is_first());
    let pipeline = agree(
        comm,
        pipeline.and_then(|pipeline| {
            given.map_or(Ok(()), |directory| check_given(directory, options.force)).map(|()| pipeline)
        }),
    )?;
    progress.note(&format!("Load: {}", pipeline.scene_path().display()));
    let prepared = agree(comm, prepare(&pipeline, progress))?;
    agree(comm, check::check_memory(&prepared.model, &pipeline, progress))?;
    let seed = options.seed.unwrap_or(pipeline.seed);
    let fingerprint = fingerprint::of_run(&pipeline, seed, &prepared.model);
    agree(comm, same_everywhere(comm, fingerprint))?;
    let directory = agree(
        comm,
        match (given, comm.is_first()) {
            (_, false) => Ok(PathBuf::new()),
            (Some(directory), _) => make_given(directory, options.force).map(|()| directory.to_owned()),
            (None, _) => make_new(&options.results, &run_name(&pipeline.path)),
        },
    )?;
    let report = Report {
        version: VERSION,
        program: PROGRAM.into(),
        pipeline: PipelineReport { path: pipeline.path.display().to_string(), text: pipeline.text.clone() },
        seed,
        scene: scene_report(&prepared, pipeline.scene_path()),
        stages: Vec::new(),
        outputs: Vec::new(),
        time: Time::of(0.0),
    };
    let head = Head {
        fingerprint: fingerprint::hex(fingerprint),
        pipeline: absolute(&pipeline.path),
        stage: 0,
        report,
    };
    Run { pipeline, prepared, directory, options, comm, progress, watch, head }.finish(None)
}

/// Goes on with the run in `directory`, which was interrupted. Of the options, those that say where to write, and the
/// seed, have no effect: they are those of the run.
///
/// # Errors
///
/// If there is no checkpoint, it is of another program, pipeline or scene, or as [`run_together`].
pub fn resume_together(
    directory: &Path,
    options: &RunOptions,
    comm: &dyn Communicator,
) -> Result<RunResult, Error> {
    let watch = Stopwatch::start();
    let progress = options.progress.of_rank(comm);
    let (saved, head) = resume::open(directory, comm)?;
    let pipeline = agree(comm, resume::pipeline(directory, &head))?;
    progress.note(&format!("Load: {}", pipeline.scene_path().display()));
    // The warnings have been shown when the run began.
    let prepared = agree(comm, prepare(&pipeline, Progress::Silent))?;
    agree(comm, check::check_memory(&prepared.model, &pipeline, progress))?;
    let fingerprint = fingerprint::of_run(&pipeline, head.report.seed, &prepared.model);
    agree(comm, resume::check_fingerprint(directory, &head, fingerprint))?;
    if comm.is_first() {
        resume::clean_up(directory);
    }
    let directory = directory.to_owned();
    // A run that had not begun a stage begins with the first.
    let saved = (head.stage > 0).then_some(saved);
    Run { pipeline, prepared, directory, options, comm, progress, watch, head }.finish(saved)
}

/// A run that is under way.
struct Run<'a> {
    pipeline: Pipeline,
    prepared: Prepared,
    directory: PathBuf,
    options: &'a RunOptions,
    comm: &'a dyn Communicator,
    progress: Progress,
    watch: Stopwatch,
    /// How far it is.
    head: Head,
}

impl Run<'_> {
    fn finish(mut self, saved: Option<Saved>) -> Result<RunResult, Error> {
        let earlier = self.head.report.time.seconds;
        let path = self.directory.join(CHECKPOINT);
        let mut checkpoints = Checkpoints::new(path, self.options.checkpoint_every);
        if saved.is_none() {
            checkpoints.set_head(self.head.to_line());
            agree(
                self.comm,
                checkpoints.save_start(self.comm).map_err(|error| RunError::from(error).into()),
            )?;
        }
        self.stages(&mut checkpoints, saved, earlier)
            .map_err(|error| name_directory(error, &self.directory))?;
        let Self { directory, comm, mut head, watch, .. } = self;
        let peak_memory = largest_peak(comm);
        head.report.time = Time { peak_memory, ..Time::of(earlier + watch.seconds()) };
        let written = if comm.is_first() { write_report(&directory, &head.report) } else { Ok(()) };
        agree(comm, written.map_err(|error| name_directory(error, &directory)))?;
        if comm.is_first() {
            checkpoints.remove();
        }
        Ok(RunResult { directory, report: head.report })
    }

    /// Runs all stages, or those from the one that `saved` is of.
    fn stages(
        &mut self,
        checkpoints: &mut Checkpoints,
        mut saved: Option<Saved>,
        earlier: f64,
    ) -> Result<(), Error> {
        let model = &self.prepared.model;
        let seed = self.head.report.seed;
        let threads = self.options.threads.unwrap_or_else(cores);
        // What the first shot leaves to multipath, and the light so far.
        let mut shot: Option<Shot> = None;
        let mut solution: Option<Solution> = None;
        for (number, stage) in self.pipeline.stages.iter().enumerate().skip(self.head.stage) {
            let name = stage.action.name();
            let watch = Stopwatch::start();
            let mut time = None;
            let mut lines_report = None;
            let mut crew = Crew::of(threads);
            crew.comm = self.comm;
            if let Action::FirstShot { lines }
            | Action::SecondShot { lines }
            | Action::Multipath { lines, .. } = stage.action
            {
                crew.observer = Box::new(self.progress.stage(name, lines, &self.options.stop));
                self.head.stage = number;
                self.head.report.time.seconds = earlier + self.watch.seconds();
                checkpoints.set_head(self.head.to_line());
                crew.checkpoints = Some(&mut *checkpoints);
            }
            match &stage.action {
                Action::Load { .. } => time = Some(Time::of(self.prepared.load_seconds)),
                Action::Subdivide(_) => time = Some(Time::of(self.prepared.build_seconds)),
                Action::FirstShot { lines } | Action::SecondShot { lines } => {
                    let done = if let Action::FirstShot { .. } = stage.action {
                        sir_parallel::first_shot(model, *lines, seed, &mut crew, saved.take())
                    } else {
                        // The decoder lets it follow nothing but a first shot; if that is not in memory, the state of
                        // this stage was saved. The same holds for multipath.
                        let shot = shot.take().unwrap_or_else(|| Shot::nothing(model));
                        drop(solution.take());
                        sir_parallel::second_shot(model, shot, *lines, seed, &mut crew, saved.take())
                    };
                    let done = agree(self.comm, done.map_err(Error::from))?;
                    drop(crew);
                    let Shot { unit, balance, counts, ref received, .. } = done.outcome;
                    let direct = done.outcome.solution(model);
                    let (batches, made_up) = (done.batches, Quanta::ZERO);
                    let facts = Facts {
                        unit,
                        balance,
                        counts,
                        batches,
                        made_up,
                        received,
                        solution: &direct,
                        domain: None,
                    };
                    lines_report = Some(LinesReport::new(model, facts));
                    time = Some(stage_time(done.time, *lines));
                    shot = Some(done.outcome);
                    solution = Some(direct);
                }
                Action::Multipath { lines, transport, body } => {
                    let shot = shot.take().unwrap_or_else(|| Shot::nothing(model));
                    // The direct light has been saved if it was wanted, and takes much memory.
                    drop(solution.take());
                    let (lines, saved) = (*lines, saved.take());
                    let domain = body.around(&model.scene);
                    let report = DomainReport::of(&domain);
                    let done = match *transport {
                        Transport::Batches => {
                            sir_parallel::batches(model, shot, lines, domain, seed, &mut crew, saved)
                        }
                        Transport::Replicas { replicas, tail } => {
                            let settings = MultipathSettings { lines, tail, replicas, domain };
                            sir_parallel::multipath(model, shot, settings, seed, &mut crew, saved)
                        }
                    };
                    let done = agree(self.comm, done.map_err(Error::from))?;
                    drop(crew);
                    let (batches, done, stage_times) = (done.batches, done.outcome, done.time);
                    let facts = Facts {
                        unit: done.unit,
                        balance: done.balance,
                        counts: done.counts,
                        batches,
                        made_up: done.made_up,
                        received: &done.received,
                        solution: &done.solution,
                        domain: Some(report),
                    };
                    let report = LinesReport::new(model, facts);
                    self.progress.warn(&unshot_warning(&report, *transport));
                    lines_report = Some(report);
                    time = Some(stage_time(stage_times, lines));
                    solution = Some(done.solution);
                }
                Action::Save(outputs) => {
                    drop(crew);
                    let saved = match &solution {
                        Some(solution) if self.comm.is_first() => self.save(solution, outputs, threads.get()),
                        _ => Ok(Vec::new()),
                    };
                    self.head.report.outputs.extend(agree(self.comm, saved)?);
                }
            }
            let time = time.unwrap_or_else(|| Time::of(watch.seconds()));
            self.head.report.stages.push(StageReport { name: name.into(), lines: lines_report, time });
        }
        Ok(())
    }

    /// Writes the outputs of a stage, unless the run is to be stopped.
    fn save(
        &self,
        solution: &Solution,
        outputs: &[Output],
        threads: usize,
    ) -> Result<Vec<crate::report::OutputReport>, Error> {
        let mut reports = Vec::new();
        save(&self.prepared, solution, outputs, &self.directory, threads, self.progress, &mut |report| {
            reports.push(report);
            !self.options.stop.load(Relaxed)
        })?;
        if reports.len() < outputs.len() {
            return Err(Error::InterruptedSaving { directory: self.directory.clone() });
        }
        Ok(reports)
    }
}

/// Says where a run that was not finished can be resumed.
fn name_directory(error: Error, directory: &Path) -> Error {
    let directory = directory.to_owned();
    match error {
        Error::Run(RunError::Interrupted { done, total }) => Error::Interrupted { done, total, directory },
        Error::View(source @ ViewError::Io { .. }) => Error::NotWritten { directory, source },
        other => other,
    }
}

fn stage_time(time: StageTime, lines: u64) -> Time {
    let seconds = time.total.as_secs_f64();
    Time {
        seconds,
        lines_per_second: Some(lines as f64 / seconds.max(1e-9)),
        sequential: Some(time.sequential().as_secs_f64()),
        communication: Some(time.communication.as_secs_f64()),
        peak_memory: None,
    }
}

/// What to say if so much light was not sent on that the result is visibly wrong.
fn unshot_warning(lines: &LinesReport, transport: Transport) -> Vec<String> {
    let balance = &lines.balance;
    let share = |parts: &[f64; 3]| {
        let shares = parts.iter().zip(&balance.emitted).filter(|(_, e)| **e > 0.0).map(|(part, e)| part / e);
        shares.fold(0.0, f64::max)
    };
    let unshot = share(&balance.unshot);
    let made_up =
        balance.unshot.iter().zip(&lines.made_up).all(|(unshot, more)| *unshot <= 0.0 || *more > 0.0);
    match transport {
        Transport::Batches if made_up && unshot > 0.1 => vec![format!(
            "{:.0} % of the light that surfaces reflect was not sent on; it was made up for as if it spread like the \
             light before it; give `Multipath` more lines, or make fewer patches",
            100.0 * unshot
        )],
        Transport::Batches if made_up || unshot <= 1e-3 => Vec::new(),
        Transport::Replicas { .. } if unshot <= 1e-3 => Vec::new(),
        _ => {
            let help = match transport {
                Transport::Batches => "more lines",
                Transport::Replicas { .. } => "more lines, fewer replicas or a longer `tail`",
            };
            vec![format!(
                "{:.1} % of the light that surfaces reflect was not sent on and is missing from the result; give \
                 `Multipath` {help}, or make fewer patches",
                100.0 * unshot
            )]
        }
    }
}

fn scene_report(prepared: &Prepared, path: &Path) -> SceneReport {
    let Model { scene, mesh, .. } = &prepared.model;
    SceneReport {
        path: path.display().to_string(),
        triangles: scene.triangles().len(),
        patches: mesh.patch_count(),
        sides: mesh.side_count(),
        area: scene.total_area(),
        power: prepared.sources.iter().map(|s| s.power).sum::<Rgb>().to_array(),
        warnings: prepared.warnings.clone(),
    }
}

fn write_report(directory: &Path, report: &Report) -> Result<(), Error> {
    sir_view::write_atomically(&directory.join(FILE_NAME), |file| {
        file.write_all(report.to_json().as_bytes())
    })?;
    Ok(())
}

/// Reads the report of a run directory.
///
/// # Errors
///
/// If there is none, or it has another version.
pub fn read_report(directory: &Path) -> Result<Report, Error> {
    let no_result = |why: String| Error::NoResult { directory: directory.to_owned(), why };
    let text = fs::read_to_string(directory.join(FILE_NAME)).map_err(|e| no_result(e.to_string()))?;
    let report: Report = serde_json::from_str(&text).map_err(|e| no_result(e.to_string()))?;
    if report.version == VERSION {
        return Ok(report);
    }
    Err(no_result(format!("it has version {}, but this program reads version {VERSION}", report.version)))
}
