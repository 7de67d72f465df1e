//! Computation of view factors by one or more ranks.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use sir_geom::{LoadOptions, Scene};
use sir_mesh::Subdivision;
use sir_parallel::{Communicator, Executor, Start, cores};
use sir_radiosity::{Grouping, Model, ViewFactorLines, ViewFactorTask};

use crate::error::Error;
use crate::fingerprint;
use crate::format::grouped;
use crate::progress::{Progress, of_rank};
use crate::ranks::{agree, same_everywhere};
use crate::run::lock::{DirectoryLock, check_unused};
use crate::view_factors::error::ViewFactorsError;
use crate::view_factors::files;
use crate::view_factors::options::{By, ViewFactorsOptions};
use crate::view_factors::report::Report;

/// View factors and their files.
#[derive(Clone, Debug)]
pub struct ViewFactorsResult {
    /// All factors with their errors.
    pub report: Report,
    /// Paths of the written files, if an output directory was given; only on the first rank.
    pub files: Vec<PathBuf>,
}

/// Computes view factors together with the other ranks, until they are accurate enough, and writes the files. Ends
/// early if `stop` becomes true.
///
/// # Errors
///
/// If the scene cannot be read, has no groups or too many, or if files cannot be written. If one rank fails, all ranks
/// fail.
pub fn view_factors(
    options: &ViewFactorsOptions,
    comm: &dyn Communicator,
    progress: &dyn Progress,
    stop: &Arc<AtomicBool>,
) -> Result<ViewFactorsResult, Error> {
    let progress = of_rank(progress, comm);
    let (model, grouping, warnings, lock) = agree(comm, prepare(options, comm, progress))?;
    let settings = options.settings;
    agree(comm, same_everywhere(comm, fingerprint::of_view_factors(&model, &grouping, &settings)))?;

    let target = match settings.accuracy {
        Some(accuracy) => format!("to standard errors of {}", accuracy.error),
        None => format!("{} lines", grouped(settings.lines)),
    };
    progress.note(&format!("ViewFactors: {} groups, {target}", grouping.names().len()));
    let factors = {
        let observer = progress.watch("ViewFactors", settings.lines, stop);
        let threads = options.threads.unwrap_or_else(cores);
        let mut executor = Executor { comm, ..Executor::new(threads) }.watched_by(observer);
        let task = ViewFactorTask { model: &model, grouping: &grouping, settings };
        executor.run::<ViewFactorLines<'_>>(task, Start::Fresh(()))?.outcome
    };
    let report = agree(
        comm,
        Report::new(options, &factors, warnings).map_err(|error| ViewFactorsError::from(error).into()),
    )?;
    let written = match &options.out {
        Some(directory) if comm.is_first() => files::write(&report, directory),
        _ => Ok(Vec::new()),
    };
    let files = agree(comm, written)?;
    drop(lock);
    Ok(ViewFactorsResult { report, files })
}

/// Reads the scene and makes the groups. On the first rank, also checks, creates and locks the output directory.
fn prepare(
    options: &ViewFactorsOptions,
    comm: &dyn Communicator,
    progress: &dyn Progress,
) -> Result<(Model, Grouping, Vec<String>, Option<DirectoryLock>), Error> {
    let directory = options.out.as_deref().filter(|_| comm.is_first());
    if let Some(directory) = directory {
        check_unused(directory)?;
        check(directory, options.force)?;
    }
    progress.note(&format!("Load: {}", options.scene.display()));
    let built =
        sir_geom::load(&options.scene, &LoadOptions { sides: options.sides, ..LoadOptions::default() })?;
    let warnings: Vec<String> = built.warnings.iter().map(ToString::to_string).collect();
    progress.warn(&warnings);
    let grouping = groups(options, &built.scene)?;
    // One patch per triangle is always possible.
    let model = Model::new(built.scene, Subdivision::PerTriangle).map_err(ViewFactorsError::from)?;
    let lock = directory.map(|directory| {
        fs::create_dir_all(directory).map_err(Error::directory(directory))?;
        DirectoryLock::acquire(directory, progress)
    });
    Ok((model, grouping, warnings, lock.transpose()?))
}

fn groups(options: &ViewFactorsOptions, scene: &Scene) -> Result<Grouping, ViewFactorsError> {
    let grouping = match options.by {
        By::Material => return Ok(Grouping::by_material(scene)),
        By::Group => Grouping::by_part(scene),
    };
    if grouping.names().iter().all(String::is_empty) {
        return Err(ViewFactorsError::NoGroups { scene: options.scene.clone() });
    }
    Ok(grouping)
}

/// Refuses to overwrite view factors, unless forced to.
fn check(directory: &Path, force: bool) -> Result<(), ViewFactorsError> {
    if !force && directory.join(files::JSON).exists() {
        return Err(ViewFactorsError::Exists { directory: directory.to_owned() });
    }
    Ok(())
}
