//! The whole experiment, from pipelines to the report.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use sir_pipeline::fingerprint::PROGRAM;
use sir_pipeline::run::{absolute, make_new};
use sir_pipeline::{Error, Progress};

use crate::error::StudyError;
use crate::experiment::agenda::Agenda;
use crate::experiment::document::{Findings, VERSION};
use crate::experiment::error::ExperimentError;
use crate::experiment::files::write_file;
use crate::experiment::machine;
use crate::experiment::machine::Machine;
use crate::experiment::options::{ExperimentOptions, Part};
use crate::experiment::runs::Runs;
use crate::experiment::scene;
use crate::experiment::subject::Subject;
use crate::scaling::error::ScalingError;
use crate::scaling::launch::Launcher;

/// Pipelines of the paper's two scenes.
const SCENES: [&str; 2] = ["scenes/museum-stairs/pipeline.ron", "scenes/airplane-cabin/pipeline.ron"];

/// Parent and name of new output directories.
const OUT: (&str, &str) = ("results", "experiment");

/// Makes the runs, writes the report, and returns the paths of its files. Ends early if `stop` becomes true.
///
/// # Errors
///
/// If a pipeline is missing or invalid, a run fails, or files cannot be written.
pub fn experiment(
    options: &ExperimentOptions,
    progress: Arc<dyn Progress>,
    stop: Arc<AtomicBool>,
) -> Result<Vec<PathBuf>, StudyError> {
    // Reports mistakes before anything runs.
    let subjects = subjects(options)?;
    let cores = sir_parallel::cores();
    let plan = options.plan(cores, sir_parallel::HAS_MPI);
    // Only measuring speed-ups needs MPI.
    let most_ranks = if options.parts().contains(&Part::Scaling) { plan.most_ranks() } else { 1 };
    let launcher = Launcher::new(&options.mpirun, most_ranks, stop)?;
    let folder = folder(options.out.as_deref())?;
    let agenda = Agenda::default();
    let mut runs = Runs { launcher, folder: folder.clone(), cores, agenda, progress };
    let mut findings = Findings {
        version: VERSION,
        program: PROGRAM.into(),
        command: machine::command_line(),
        date: String::new(),
        machine: Machine::this(),
        scale: options.scale,
        reference: options.reference,
        parts: options.parts(),
        scenes: Vec::new(),
    };
    for subject in &subjects {
        scene::plan(&mut runs, subject, options, &plan);
    }
    for subject in &subjects {
        let found =
            scene::find(&mut runs, subject, options, &plan).map_err(|error| name_folder(error, &folder))?;
        findings.scenes.push(found);
        findings.date = machine::today();
        // The results so far can be read while the next scene is computed.
        write_file(&folder.join("report.json"), &findings.json())?;
        write_file(&folder.join("report.md"), &findings.markdown())?;
    }
    Ok(["report.md", "report.json"].map(|name| folder.join(name)).into())
}

fn subjects(options: &ExperimentOptions) -> Result<Vec<Subject>, StudyError> {
    let mut paths = options.pipelines.clone();
    if paths.is_empty() {
        paths = SCENES.map(PathBuf::from).to_vec();
        if let Some(path) = paths.iter().find(|path| !path.exists()) {
            return Err(ExperimentError::NoScenes { path: path.clone() }.into());
        }
    }
    let mut subjects: Vec<Subject> = Vec::new();
    for path in &paths {
        let subject = Subject::read(path, options.scale)?;
        if subjects.iter().any(|other| other.name == subject.name) {
            return Err(ExperimentError::SameName { name: subject.name }.into());
        }
        subjects.push(subject);
    }
    Ok(subjects)
}

/// Creates the output directory. Returns its absolute path, because it is passed to other processes, perhaps on other
/// machines.
fn folder(given: Option<&Path>) -> Result<PathBuf, StudyError> {
    let Some(path) = given else {
        return Ok(absolute(&make_new(Path::new(OUT.0), OUT.1)?));
    };
    fs::create_dir_all(path).map_err(Error::directory(path))?;
    Ok(absolute(path))
}

/// Adds the output directory, where the experiment can be continued, to the error of an interrupt.
fn name_folder(error: StudyError, folder: &Path) -> StudyError {
    match error {
        StudyError::Scaling(ScalingError::Interrupted) => {
            ExperimentError::Interrupted { directory: folder.to_owned() }.into()
        }
        other => other,
    }
}
