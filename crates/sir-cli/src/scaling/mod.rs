//! `sir scaling`: how much faster more workers are.
//!
//! As Martínez, Forés and Martín (2009) do, the speed-up `S(p) = T(1) / T(p)` and the efficiency
//! `E(p) = S(p) / p` of `p` workers are reported for the first shot, for multipath, and for the whole run.
//!
//! The program runs *itself*, once per measurement, and reads the report of the run: memory that an earlier
//! run left warm, or threads that it left behind, cannot help or hinder a later one, and ranks are started as
//! they always are. As every run makes the same result, bit by bit, a measurement is a test, too: it fails if
//! one does not.
//!
//! * [`Plan`]: which combinations of ranks and threads, and in which order.
//! * [`measure`]: makes the runs, by a function that is given to it.
//! * [`Study`]: times, speed-ups and efficiencies, as [`text`], [`markdown`], [`csv`], [`json`] and [`svg`].

pub(crate) mod axis;
pub(crate) mod error;
mod files;
pub(crate) mod launch;
pub(crate) mod legend;
mod measure;
pub(crate) mod options;
pub(crate) mod plot;
mod same;
mod series;
pub(crate) mod statistics;
pub(crate) mod study;
pub(crate) mod table;
pub(crate) mod workers;

use std::fs;
use std::path::{Path, PathBuf};

pub use error::ScalingError;
pub use files::{csv, json, write};
pub use measure::measure;
pub use options::ScalingArgs;
pub use plot::{svg, svg_beside};
pub use statistics::{Overhead, Part, Spread};
pub use study::{Row, Study, Timing, VERSION};
pub use table::{markdown, text};
pub use workers::{Plan, Workers};

use crate::directory::{absolute, make_new, run_name};
use crate::error::Error;
use crate::interrupt;
use crate::pipeline::Pipeline;
use crate::progress::Progress;
use launch::Launcher;

/// Where new directories are made, as those of runs.
const RESULTS: &str = "results";

/// The command: measures, writes the files, and returns what is to be printed.
///
/// # Errors
///
/// If the pipeline is wrong, a run fails or has another result than the others, or files cannot be written.
pub fn command(args: &ScalingArgs) -> Result<String, Error> {
    // A mistake in the pipeline is told once, before anything runs.
    let pipeline = Pipeline::read(&args.pipeline)?;
    let cores = sir_parallel::cores();
    let plan = args.plan(cores);
    let launcher = Launcher::new(&args.mpirun, plan.most_ranks(), interrupt::flag())?;
    let name = run_name(&pipeline.path);
    let folder = Folder::make(args.out.as_deref(), &format!("{name}-scaling"))?;
    let progress = Progress::Lines;
    if plan.baseline_added {
        progress.note(&format!("{} is measured, too: speed-ups are relative to it", Workers::BASELINE));
    }
    let path = absolute(&pipeline.path);
    let run = &mut |workers| launcher.run(&path, workers, &folder.path);
    let study = measure(&name, cores.get(), &plan, progress, run).and_then(|study| {
        write(&study, &folder.path)?;
        Ok(study)
    });
    let study = study.inspect_err(|_| folder.remove())?;
    Ok(if args.json { json(&study) } else { format!("{}\n{}", text(&study), folder.list()) })
}

/// The output directory.
struct Folder {
    /// From the root: other processes, perhaps on other machines, get it.
    path: PathBuf,
    /// Whether it was not there before.
    new: bool,
}

impl Folder {
    /// The one that was asked for, or a new one of this name.
    fn make(given: Option<&Path>, name: &str) -> Result<Self, Error> {
        let Some(path) = given else {
            return Ok(Self { path: absolute(&make_new(Path::new(RESULTS), name)?), new: true });
        };
        if path.join(files::JSON).exists() {
            return Err(ScalingError::Exists { directory: path.to_owned() }.into());
        }
        let new = !path.exists();
        fs::create_dir_all(path).map_err(Error::directory(path))?;
        Ok(Self { path: absolute(path), new })
    }

    /// Removes it after a failure, unless it was there before or has something in it.
    fn remove(&self) {
        if self.new {
            // It fails if there is something, and that is as it should be.
            let _ = fs::remove_dir(&self.path);
        }
    }

    /// The files in it that people may want to open.
    fn list(&self) -> String {
        let names = ["scaling.svg", "scaling.md", "scaling.csv", files::JSON];
        names.iter().map(|name| format!("{}\n", self.path.join(name).display())).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn measurements_are_not_overwritten_and_failures_leave_nothing() {
        let base = tempfile::tempdir().unwrap();
        let path = base.path().join("deep/x");
        let folder = Folder::make(Some(&path), "").unwrap();
        folder.remove();
        assert!(!path.exists());
        fs::create_dir_all(&path).unwrap();
        Folder::make(Some(&path), "").unwrap().remove();
        assert!(path.exists());
        fs::write(path.join(files::JSON), "{}").unwrap();
        let error = Folder::make(Some(&path), "").err().map(|error| error.exit_code());
        assert_eq!(error, Some(2));
    }
}
