//! Writes a drafted pipeline into a run directory.

use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use sir_view::write_atomically;

use crate::draft::place::path_from;
use crate::draft::text::{Choice, Goal, text};
use crate::error::Error;
use crate::info::inspect::inspect_for;
use crate::plan::Pipeline;
use crate::run::directory::{check_empty, check_given, make_new, run_name};

/// Name of a drafted pipeline in its run directory.
pub const PIPELINE_FILE: &str = "pipeline.ron";

/// Options of a draft.
#[derive(Clone, Debug)]
pub struct DraftOptions {
    /// Run directory, or `None` for a new one in `results`.
    pub out: Option<PathBuf>,
    /// Parent of new run directories. Default `results`.
    pub results: PathBuf,
    /// True to replace a pipeline in `out`, and to accept a result there.
    pub force: bool,
    /// When the pipeline is done.
    pub goal: Goal,
    /// Command that drafts the pipeline, for its first line.
    pub command: String,
}

/// A drafted pipeline.
#[derive(Clone, Debug)]
pub struct Draft {
    /// Run directory, which exists.
    pub directory: PathBuf,
    /// The pipeline, as in the file [`PIPELINE_FILE`] of this directory.
    pub pipeline: Pipeline,
    /// What should be checked.
    pub choices: Vec<Choice>,
}

/// Reads a scene, chooses a pipeline for it, and writes it into a run directory. The same scene and options give the same
/// pipeline. Nothing is written before the scene has been read.
///
/// # Errors
///
/// If the scene cannot be read, or `out` holds a result or another pipeline and `force` is false, or the file cannot be
/// written.
pub fn draft(scene: &Path, options: &DraftOptions) -> Result<Draft, Error> {
    let DraftOptions { out, results, force, goal, command } = options;
    if scene.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("ron")) {
        return Err(Error::IsPipeline { path: scene.to_owned() });
    }
    if let Some(out) = out {
        check_empty(out, *force)?;
    }
    let name = run_name(scene);
    // New directories have the same depth, whatever their number.
    let planned = out.clone().unwrap_or_else(|| results.join(&name));
    let (info, choices) = inspect_for(scene, &path_from(&planned, scene))?;
    let (text, choices) = text(&info, choices, *goal, command);
    let directory = match out {
        Some(directory) => {
            fs::create_dir_all(directory).map_err(Error::directory(directory))?;
            directory.clone()
        }
        None => make_new(results, &name)?,
    };
    let path = directory.join(PIPELINE_FILE);
    let has_other = fs::read(&path).is_ok_and(|bytes| bytes != text.as_bytes());
    if has_other && !force {
        return Err(Error::OtherPipeline { path });
    }
    let pipeline = Pipeline::parse(&text, &path)?;
    check_given(&directory, *force, &pipeline)?;
    write_atomically(&path, |file| file.write_all(text.as_bytes()))?;
    Ok(Draft { directory, pipeline, choices })
}
