//! The whole measurement, from a pipeline to the files.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use sir_pipeline::plan::Pipeline;
use sir_pipeline::run::{absolute, make_new, run_name};
use sir_pipeline::{Error, Progress};

use crate::error::StudyError;
use crate::scaling::error::ScalingError;
use crate::scaling::files;
use crate::scaling::files::write;
use crate::scaling::launch::Launcher;
use crate::scaling::measure::measure;
use crate::scaling::options::ScalingOptions;
use crate::scaling::study::Study;
use crate::scaling::workers::Workers;

/// Parent of new output directories, the same as for runs.
const RESULTS: &str = "results";

/// Measurement and its files.
#[derive(Clone, Debug)]
pub struct Measured {
    /// Times, speed-ups and efficiencies.
    pub study: Study,
    /// Paths of the files.
    pub files: Vec<PathBuf>,
}

/// Measures the speed-up of a pipeline and writes the files. Ends early if `stop` becomes true.
///
/// # Errors
///
/// If the pipeline is invalid, a run fails or has a different result from the others, or files cannot be written.
pub fn scaling(
    options: &ScalingOptions,
    progress: &dyn Progress,
    stop: Arc<AtomicBool>,
) -> Result<Measured, StudyError> {
    // Reports mistakes in the pipeline once, before anything runs.
    let pipeline = Pipeline::read(&options.pipeline)?;
    let cores = sir_parallel::cores();
    let plan = options.plan(cores);
    let launcher = Launcher::new(&options.mpirun, plan.most_ranks(), stop)?;
    let name = run_name(&pipeline.path);
    let folder = Folder::make(options.out.as_deref(), &format!("{name}-scaling"))?;
    if plan.baseline_added {
        progress.message(&format!("{} is also measured: speed-ups are relative to it", Workers::BASELINE));
    }
    let path = absolute(&pipeline.path);
    let run = &mut |workers| launcher.run(&path, workers, &folder.path);
    let study = measure(&name, cores.get(), &plan, progress, run).and_then(|study| {
        write(&study, &folder.path)?;
        Ok(study)
    });
    let study = study.inspect_err(|_| folder.remove())?;
    Ok(Measured { study, files: folder.list() })
}

/// Output directory.
struct Folder {
    /// Absolute path, because it is passed to other processes, perhaps on other machines.
    path: PathBuf,
    /// True if this measurement created it.
    new: bool,
}

impl Folder {
    /// Creates the directory `given`, or a new one named `name`.
    fn make(given: Option<&Path>, name: &str) -> Result<Self, StudyError> {
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

    /// Removes the directory after a failure, unless it existed before or is not empty.
    fn remove(&self) {
        if self.new {
            // Fails if the directory is not empty, as intended.
            let _ = fs::remove_dir(&self.path);
        }
    }

    /// Returns the paths of the files.
    fn list(&self) -> Vec<PathBuf> {
        let names = ["scaling.svg", "scaling.md", "scaling.csv", files::JSON];
        names.iter().map(|name| self.path.join(name)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sir_pipeline::ErrorKind;

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
        let error = Folder::make(Some(&path), "").err().map(|error| error.kind());
        assert_eq!(error, Some(ErrorKind::Usage));
    }
}
