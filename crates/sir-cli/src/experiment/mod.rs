//! `sir experiment`: section 5 of Martínez, Forés and Martín (2009), repeated on any pipelines.
//!
//! The program runs *itself* on pipelines that are derived from those it is given, one run after the other, and compares
//! their results; what needs no solution it counts in its own process. Each run has a directory that is kept, with its
//! pipeline and its report: an experiment that was interrupted goes on with the runs that are missing.
//!
//! * `subject`: a pipeline, and those derived from it; `runs`: making them, once; `scene`: what is made for one.
//! * A module for each part finds numbers and writes a section: `speed` (scaling), `precision` (error), `mix`, `bodies`
//!   (domains), `spread`, `farm`.
//! * `paper`: what was published; `verdict`: whether the numbers agree; `document`: the report.

mod accuracy;
mod agenda;
mod bodies;
mod crossings;
mod curves;
mod document;
pub(crate) mod error;
mod farm;
mod lines;
mod machine;
mod markdown;
mod mix;
pub(crate) mod options;
mod paper;
mod precision;
mod ron_text;
mod runs;
mod scene;
mod speed;
mod spread;
mod subject;
mod verdict;

use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};

pub use error::ExperimentError;
pub use options::{ExperimentArgs, Part};

use crate::directory::{absolute, make_new};
use crate::error::Error;
use crate::fingerprint::PROGRAM;
use crate::interrupt;
use crate::progress::Progress;
use crate::scaling::error::ScalingError;
use crate::scaling::launch::Launcher;
use agenda::Agenda;
use document::Findings;
use machine::Machine;
use runs::Runs;
use subject::Subject;

/// The pipelines of the paper's two scenes.
const SCENES: [&str; 2] = ["scenes/museum-stairs/pipeline.ron", "scenes/airplane-cabin/pipeline.ron"];

/// Where new directories are made, and their name.
const OUT: (&str, &str) = ("results", "experiment");

/// The command: makes the runs, writes the report, and returns what is to be printed.
///
/// # Errors
///
/// If a pipeline is missing or wrong, a run fails, or files cannot be written.
pub fn command(args: &ExperimentArgs) -> Result<String, Error> {
    // Mistakes are told before anything runs.
    let subjects = subjects(args)?;
    let cores = sir_parallel::cores();
    let plan = args.plan(cores, sir_parallel::HAS_MPI);
    // Who does not measure speed-ups needs no MPI.
    let most_ranks = if args.parts().contains(&Part::Scaling) { plan.most_ranks() } else { 1 };
    let launcher = Launcher::new(&args.mpirun, most_ranks, interrupt::flag())?;
    let folder = folder(args.out.as_deref())?;
    let agenda = Agenda::default();
    let mut runs = Runs { launcher, folder: folder.clone(), cores, agenda, progress: Progress::Lines };
    let mut findings = Findings {
        version: document::VERSION,
        program: PROGRAM.into(),
        command: machine::command_line(),
        date: String::new(),
        machine: Machine::this(),
        scale: args.scale,
        reference: args.reference,
        parts: args.parts(),
        scenes: Vec::new(),
    };
    for subject in &subjects {
        scene::plan(&mut runs, subject, args, &plan);
    }
    for subject in &subjects {
        let found =
            scene::find(&mut runs, subject, args, &plan).map_err(|error| name_folder(error, &folder))?;
        findings.scenes.push(found);
        findings.date = machine::today();
        // What is finished can be read while the next scene is on its way.
        write_file(&folder.join("report.json"), &findings.json())?;
        write_file(&folder.join("report.md"), &findings.markdown())?;
    }
    let files = ["report.md", "report.json"].map(|name| format!("{}\n", folder.join(name).display()));
    Ok(files.concat())
}

fn subjects(args: &ExperimentArgs) -> Result<Vec<Subject>, Error> {
    let mut paths = args.pipelines.clone();
    if paths.is_empty() {
        paths = SCENES.map(PathBuf::from).to_vec();
        if let Some(path) = paths.iter().find(|path| !path.exists()) {
            return Err(ExperimentError::NoScenes { path: path.clone() }.into());
        }
    }
    let mut subjects: Vec<Subject> = Vec::new();
    for path in &paths {
        let subject = Subject::read(path, args.scale)?;
        if subjects.iter().any(|other| other.name == subject.name) {
            return Err(ExperimentError::SameName { name: subject.name }.into());
        }
        subjects.push(subject);
    }
    Ok(subjects)
}

/// The output directory, from the root: other processes, perhaps on other machines, get it.
fn folder(given: Option<&Path>) -> Result<PathBuf, Error> {
    let Some(path) = given else {
        return Ok(absolute(&make_new(Path::new(OUT.0), OUT.1)?));
    };
    fs::create_dir_all(path).map_err(Error::directory(path))?;
    Ok(absolute(path))
}

/// Says where an interrupted experiment goes on.
fn name_folder(error: Error, folder: &Path) -> Error {
    match error {
        Error::Scaling(ScalingError::Interrupted) => {
            ExperimentError::Interrupted { directory: folder.to_owned() }.into()
        }
        other => other,
    }
}

fn write_file(path: &Path, text: &str) -> Result<(), Error> {
    sir_view::write_atomically(path, |file| file.write_all(text.as_bytes()))?;
    Ok(())
}
