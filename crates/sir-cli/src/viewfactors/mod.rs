//! `sir viewfactors`: view factors between the materials or the named parts of a scene.

mod files;
pub(crate) mod options;
mod report;
mod text;

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use sir_geom::{LoadOptions, Scene};
use sir_mesh::{MeshError, Subdivision};
use sir_parallel::{Communicator, Crew, cores, view_factors};
use sir_radiosity::{ClosureError, Grouping, Model};
use thiserror::Error as ThisError;

pub use options::{By, SidesOption, ViewFactorsArgs};

use crate::error::Error;
use crate::fields::grouped;
use crate::fingerprint;
use crate::progress::Progress;
use crate::ranks::{agree, same_everywhere};
use report::Report;

/// Why there are no view factors.
#[derive(Debug, ThisError)]
pub enum ViewFactorsError {
    /// View factors between named parts are asked for, and no part has a name.
    #[error(
        "{} names no groups (glTF: names of nodes or meshes; OBJ: statements `o` or `g`); use --by material",
        scene.display()
    )]
    NoGroups {
        /// The scene file.
        scene: PathBuf,
    },
    /// The output directory holds view factors already.
    #[error("{} holds view factors already; choose another --out, or replace them with --force", directory.display())]
    Exists {
        /// The directory.
        directory: PathBuf,
    },
    /// The scene has too many triangles.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// The factors cannot be adjusted as --closure asks.
    #[error("--closure is impossible")]
    Closure(#[from] ClosureError),
}

impl ViewFactorsError {
    /// The exit code of the program.
    pub(crate) fn exit_code(&self) -> u8 {
        match self {
            Self::NoGroups { .. } | Self::Exists { .. } => 2,
            Self::Closure(_) | Self::Mesh(_) => 1,
        }
    }
}

/// The command, by several ranks together, until it is done or `stop` becomes true: computes, writes the files, and returns what
/// the first rank is to print.
///
/// # Errors
///
/// If the scene cannot be read, has no or too many groups, or files cannot be written. If one rank fails, all do.
pub(crate) fn command(
    args: &ViewFactorsArgs,
    comm: &dyn Communicator,
    stop: &Arc<AtomicBool>,
) -> Result<String, Error> {
    let progress = if args.quiet { Progress::Quiet } else { Progress::for_stderr() }.of_rank(comm);
    let (model, grouping, warnings) = agree(comm, prepare(args, comm, progress))?;
    let settings = args.settings();
    agree(comm, same_everywhere(comm, fingerprint::of_view_factors(&model, &grouping, &settings)))?;

    let target = match settings.accuracy {
        Some(accuracy) => format!("to standard errors of {}", accuracy.error),
        None => format!("{} lines", grouped(settings.lines)),
    };
    progress.note(&format!("ViewFactors: {} groups, {target}", grouping.names().len()));
    let factors = {
        let observer = progress.watch("ViewFactors", settings.lines, stop);
        let crew = Crew { comm, ..Crew::of(args.threads.unwrap_or_else(cores)) };
        view_factors(&model, &grouping, settings, &mut crew.watched_by(observer))?
    };
    let report = agree(
        comm,
        Report::new(args, &factors, warnings).map_err(|error| ViewFactorsError::from(error).into()),
    )?;
    let written = match &args.out {
        Some(directory) if comm.is_first() => files::write(&report, directory),
        _ => Ok(Vec::new()),
    };
    let paths = agree(comm, written)?;
    Ok(match (comm.is_first(), args.json) {
        (false, _) => String::new(),
        (true, true) => report.to_json(),
        (true, false) => text::text(&report, &paths),
    })
}

/// Reads the scene and makes the groups; on the first rank, also looks whether the files can be written.
fn prepare(
    args: &ViewFactorsArgs,
    comm: &dyn Communicator,
    progress: Progress,
) -> Result<(Model, Grouping, Vec<String>), Error> {
    if let Some(directory) = args.out.as_deref().filter(|_| comm.is_first()) {
        check(directory, args.force)?;
    }
    progress.note(&format!("Load: {}", args.scene.display()));
    let built = sir_geom::load(&args.scene, &LoadOptions { sides: args.sides.into() })?;
    let warnings: Vec<String> = built.warnings.iter().map(ToString::to_string).collect();
    progress.warn(&warnings);
    let grouping = groups(args, &built.scene)?;
    // One patch per triangle is always possible.
    let model = Model::new(built.scene, Subdivision::PerTriangle).map_err(ViewFactorsError::from)?;
    if let Some(directory) = args.out.as_deref().filter(|_| comm.is_first()) {
        fs::create_dir_all(directory).map_err(Error::directory(directory))?;
    }
    Ok((model, grouping, warnings))
}

fn groups(args: &ViewFactorsArgs, scene: &Scene) -> Result<Grouping, ViewFactorsError> {
    let grouping = match args.by {
        By::Material => return Ok(Grouping::by_material(scene)),
        By::Group => Grouping::by_part(scene),
    };
    if grouping.names().iter().all(String::is_empty) {
        return Err(ViewFactorsError::NoGroups { scene: args.scene.clone() });
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
