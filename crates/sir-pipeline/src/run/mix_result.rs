//! Writes the files of a run again, with other factors of its light groups.

use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use sir_geom::Rgb;
use sir_parallel::SingleProcess;

use crate::error::Error;
use crate::fingerprint;
use crate::fingerprint::PROGRAM;
use crate::format::list;
use crate::memory::largest_peak;
use crate::plan::Pipeline;
use crate::prepare::prepared::{Prepared, prepare};
use crate::progress::{NoProgress, Progress};
use crate::report::luminaires::LuminaireReport;
use crate::report::result::{Report, Time};
use crate::run::directory::{absolute, check_given, make_given, make_new};
use crate::run::execute::{Run, RunOptions, RunResult, read_report, scene_report, write_report};
use crate::run::lock::DirectoryLock;
use crate::run::mix::Sum;
use crate::run::pages::Pages;
use crate::run::resume::Head;
use crate::stopwatch::Stopwatch;
use crate::text::suggest::did_you_mean;

/// Largest factor of a light group. It is far above every use, and keeps sums of light finite.
const MAX_FACTOR: f64 = 1e6;

/// Options of [`mix`]. Only the factors change the result.
#[derive(Clone, Debug)]
pub struct MixOptions {
    /// Names of light groups with their factors per band, from 0 to 1,000,000. Other groups have the factor 1.
    pub factors: Vec<(String, Rgb)>,
    /// Directory for the files, or `None` for a new one beside that of the run.
    pub out: Option<PathBuf>,
    /// True to replace a result in `out`.
    pub force: bool,
    /// Number of threads, or `None` for one per processor core.
    pub threads: Option<NonZeroUsize>,
    /// Stop flag: when it becomes true, the work ends with an error.
    pub stop: Arc<AtomicBool>,
    /// Observer. Default none.
    pub progress: Arc<dyn Progress>,
}

impl Default for MixOptions {
    fn default() -> Self {
        Self {
            factors: Vec::new(),
            out: None,
            force: false,
            threads: None,
            stop: Arc::default(),
            progress: Arc::new(NoProgress),
        }
    }
}

/// Writes the files of a finished run again, for other factors of its light groups, and a `result.json`. No lines are
/// traced for the light.
///
/// # Errors
///
/// If the directory holds no result with light groups, a factor is impossible, the scene has changed, or a file cannot be
/// written.
pub fn mix(directory: &Path, options: &MixOptions) -> Result<RunResult, Error> {
    let watch = Stopwatch::start();
    let progress = &*options.progress;
    let of_run = read_report(directory)?;
    let factors = factors(directory, &of_run, &options.factors)?;
    let pipeline = pipeline(directory, &of_run)?;
    if let Some(out) = &options.out {
        if same_file::is_same_file(out, directory).unwrap_or(false) {
            return Err(Error::MixOfItself { directory: out.clone() });
        }
        check_given(out, options.force, &pipeline)?;
    }
    progress.note(&format!("Load: {}", pipeline.scene_path().display()));
    // The warnings were shown by the run.
    let whole = prepare(&pipeline, &NoProgress)?;
    let mut groups = of_run.groups.clone();
    groups.iter_mut().zip(&factors).for_each(|(group, factor)| group.factor = factor.to_array());
    let by_name: Vec<_> = groups.iter().map(|group| (group.name.as_str(), group.dimming())).collect();
    let luminaires = LuminaireReport::mixed(&pipeline, &by_name);
    let prepared = Prepared { luminaires, ..whole.dimmed(&factors) };
    let fingerprint = fingerprint::hex(fingerprint::of_run(&pipeline, of_run.seed, &whole));
    let sum = Sum::open(directory, &groups, &fingerprint)?;
    let (out, lock) = match &options.out {
        Some(out) => (out.clone(), make_given(out, options.force, progress)?),
        None => {
            let run = absolute(directory);
            let name = run.file_name().map_or_else(|| "run".into(), |name| name.to_string_lossy());
            let out = make_new(run.parent().unwrap_or(&run), &format!("{name}-mix"))?;
            let lock = DirectoryLock::acquire(&out, progress)?;
            (out, lock)
        }
    };
    let report = Report {
        scene: scene_report(&prepared, pipeline.scene_path()),
        stages: of_run.stages.iter().take(first_with_lines(&pipeline)).cloned().collect(),
        groups,
        mixed_from: Some(directory.display().to_string()),
        warnings: Vec::new(),
        outputs: Vec::new(),
        ..of_run
    };
    let run_options = RunOptions {
        threads: options.threads,
        stop: options.stop.clone(),
        progress: options.progress.clone(),
        ..RunOptions::default()
    };
    let mut run = Run {
        pipeline: &pipeline,
        prepared: &prepared,
        group: None,
        directory: out,
        lock: Some(lock),
        options: &run_options,
        comm: &SingleProcess,
        progress,
        watch,
        seconds_before: 0.0,
        head: Head::start(fingerprint, pipeline.path.clone(), report),
        pages: Pages::default(),
    };
    run.mix(first_with_lines(&pipeline), sum).map_err(|error| match error {
        Error::InterruptedSaving { directory } => Error::InterruptedMix { directory },
        other => other,
    })?;
    let peak_memory = largest_peak(run.comm);
    run.head.report.time = Time { peak_memory, ..Time::of(run.seconds()) };
    let Run { directory, head: Head { report, .. }, pages, .. } = run;
    pages.write(&prepared, &directory, &report)?;
    write_report(&directory, &report)?;
    Ok(RunResult { directory, report })
}

/// Returns the number of the first stage with lines.
fn first_with_lines(pipeline: &Pipeline) -> usize {
    let stages = &pipeline.stages;
    stages.iter().position(|stage| stage.action.lines() > 0).unwrap_or(stages.len())
}

/// Returns the factor of each group of a result.
fn factors(directory: &Path, report: &Report, given: &[(String, Rgb)]) -> Result<Vec<Rgb>, Error> {
    let directory = directory.to_owned();
    if let Some(run) = report.mixed_from.clone() {
        return Err(Error::MixOfMix { directory, run });
    }
    if report.groups.is_empty() {
        return Err(Error::NoLightGroups { directory });
    }
    let names: Vec<&str> = report.groups.iter().map(|group| group.name.as_str()).collect();
    let mut factors = vec![Rgb::ONE; names.len()];
    for (i, (name, factor)) in given.iter().enumerate() {
        let refuse = |why: String| Err(Error::Factor { name: name.clone(), why });
        let Some(number) = names.iter().position(|known| known == name) else {
            let known = format!("the light groups of the run are {}", list(&names, "and"));
            return refuse(did_you_mean(name, &names).unwrap_or(known));
        };
        if given[..i].iter().any(|(before, _)| before == name) {
            return refuse("it has a factor already; give one factor for each group".into());
        }
        if !factor.to_array().iter().all(|band| (0.0..=MAX_FACTOR).contains(band)) {
            return refuse("its factor must be from 0 to 1,000,000".into());
        }
        factors[number] = *factor;
    }
    Ok(factors)
}

/// Returns the pipeline of a run.
fn pipeline(directory: &Path, report: &Report) -> Result<Pipeline, Error> {
    if report.program != PROGRAM {
        return Err(Error::OtherProgram {
            directory: directory.to_owned(),
            program: report.program.clone(),
            this: PROGRAM,
        });
    }
    let path = report.pipeline.absolute.as_ref().unwrap_or(&report.pipeline.path);
    Ok(Pipeline::parse(&report.pipeline.text, Path::new(path))?)
}
