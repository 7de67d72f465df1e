//! Running a pipeline.

use std::fs;
use std::io::Write as _;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

use sir_geom::Rgb;
use sir_lines::Domain;
use sir_parallel::{first_shot, multipath};
use sir_radiosity::{Model, MultipathSettings, Shot, Solution};

use crate::Error;
use crate::directory::{check_given, make_given, make_new, run_name};
use crate::pipeline::{Action, Pipeline};
use crate::prepare::{Prepared, prepare};
use crate::progress::Progress;
use crate::report::{
    FILE_NAME, LinesReport, PipelineReport, Report, SceneReport, StageReport, Stopwatch, Time, VERSION,
};
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
    let watch = Stopwatch::start();
    let progress = options.progress;
    if let Some(directory) = &options.out {
        check_given(directory, options.force)?;
    }
    progress.note(&format!("Load: {}", pipeline.scene_path().display()));
    let prepared = prepare(pipeline, progress)?;
    let directory = match &options.out {
        Some(directory) => {
            make_given(directory, options.force)?;
            directory.clone()
        }
        None => make_new(&options.results, &run_name(&pipeline.path))?,
    };
    let mut report = Report {
        version: VERSION,
        program: concat!("sir ", env!("CARGO_PKG_VERSION")).into(),
        pipeline: PipelineReport { path: pipeline.path.display().to_string(), text: pipeline.text.clone() },
        seed: options.seed.unwrap_or(pipeline.seed),
        scene: scene_report(&prepared, pipeline.scene_path()),
        stages: Vec::new(),
        outputs: Vec::new(),
        time: Time::of(0.0),
    };
    let threads = options.threads.or(std::thread::available_parallelism().ok()).map_or(1, NonZeroUsize::get);
    run_stages(pipeline, &prepared, &directory, threads, progress, &mut report)?;
    report.time = Time::of(watch.seconds());
    write_report(&directory, &report)?;
    Ok(RunResult { directory, report })
}

fn run_stages(
    pipeline: &Pipeline,
    prepared: &Prepared,
    directory: &Path,
    threads: usize,
    progress: Progress,
    report: &mut Report,
) -> Result<(), Error> {
    let model = &prepared.model;
    let seed = report.seed;
    // What the first shot leaves to multipath, and the light so far.
    let mut shot: Option<Shot> = None;
    let mut solution: Option<Solution> = None;
    for stage in &pipeline.stages {
        let name = stage.action.name();
        let watch = Stopwatch::start();
        let mut seconds = None;
        let mut lines_report = None;
        match &stage.action {
            Action::Load { .. } => seconds = Some(prepared.load_seconds),
            Action::Subdivide(_) => seconds = Some(prepared.build_seconds),
            Action::FirstShot { lines } => {
                let done = first_shot(model, *lines, seed, &mut progress.stage(name, *lines))?.outcome;
                let direct = done.solution(model);
                let facts = (done.balance, done.counts);
                lines_report = Some(LinesReport::new(model, done.unit, facts, &done.received, &direct));
                shot = Some(done);
                solution = Some(direct);
            }
            Action::Multipath { lines, tail } => {
                // The decoder lets multipath follow nothing but a first shot.
                let Some(shot) = shot.take() else { continue };
                // The direct light has been saved if it was wanted, and takes much memory.
                drop(solution.take());
                let settings = multipath_settings(model, *lines, *tail);
                let mut observer = progress.stage(name, *lines);
                let done = multipath(model, shot, settings, seed, &mut observer)?.outcome;
                let facts = (done.balance, done.counts);
                let lines = LinesReport::new(model, done.unit, facts, &done.received, &done.solution);
                progress.warn(&unshot_warning(&lines));
                lines_report = Some(lines);
                solution = Some(done.solution);
            }
            Action::Save(outputs) => {
                if let Some(solution) = &solution {
                    report.outputs.extend(save(prepared, solution, outputs, directory, threads, progress)?);
                }
            }
        }
        let seconds = seconds.unwrap_or_else(|| watch.seconds());
        let lines_per_second = lines_report.as_ref().map(|l| l.lines as f64 / seconds.max(1e-9));
        report.stages.push(StageReport {
            name: name.into(),
            lines: lines_report,
            time: Time { seconds, lines_per_second },
        });
    }
    Ok(())
}

/// The lines of a multipath stage: through the sphere around the scene.
pub(crate) fn multipath_settings(model: &Model, lines: u64, tail: u64) -> MultipathSettings {
    MultipathSettings { lines, tail, domain: Domain::Sphere(model.scene.bounding_sphere()) }
}

/// What to say if so much light was not sent on that the result is visibly too dark.
fn unshot_warning(lines: &LinesReport) -> Vec<String> {
    let balance = &lines.balance;
    let shares = balance.unshot.iter().zip(&balance.emitted).filter(|(_, e)| **e > 0.0).map(|(u, e)| u / e);
    let share = shares.fold(0.0, f64::max);
    if share <= 1e-3 {
        return Vec::new();
    }
    vec![format!(
        "{:.1} % of the light that surfaces reflect was not sent on and is missing from the result; give `Multipath` \
         more lines or a longer `tail`, or make fewer patches",
        100.0 * share
    )]
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
