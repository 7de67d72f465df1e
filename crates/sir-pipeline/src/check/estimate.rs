//! Estimates memory and time of a pipeline.

use std::path::Path;

use crate::check::needs::{group_file_bytes, memory, needed_besides_model};
use crate::check::probe::{StageEstimate, probe};
use crate::error::Error;
use crate::memory;
use crate::plan::{Action, Ending, Pipeline};
use crate::prepare::prepared::{Prepared, prepare};
use crate::progress::{NoProgress, Progress};
use crate::units::Units;

/// Estimate of the cost of a pipeline.
#[derive(Clone, Debug)]
pub struct Estimate {
    /// Units of power.
    pub units: Units,
    /// Scene, ready for tracing.
    pub prepared: Prepared,
    /// Memory per part \[bytes\].
    pub memory: Vec<(&'static str, usize)>,
    /// Peak memory use \[bytes\].
    pub peak_memory: usize,
    /// Size of the file of a light group \[bytes\]; zero without light groups.
    pub group_file: usize,
    /// Lines and lines per second of each stage with lines: the rate of one thread in a short trial on this machine,
    /// times the number of its processor cores.
    pub stages: Vec<StageEstimate>,
    /// End of the `Repeat` of these stages, if there is one.
    pub repeat: Option<Ending>,
}

/// Estimates the cost of the pipeline in the file `path`: reads its scene, makes its patches and traces a few lines of
/// each stage. Writes nothing.
///
/// # Errors
///
/// If the pipeline is invalid, or [`prepare`] fails.
pub fn check(path: &Path) -> Result<Estimate, Error> {
    estimate(&Pipeline::read(path)?, &NoProgress)
}

/// Estimates the cost of a pipeline, like [`check`].
///
/// # Errors
///
/// Same as [`prepare`].
pub fn estimate(pipeline: &Pipeline, progress: &dyn Progress) -> Result<Estimate, Error> {
    let prepared = prepare(pipeline, progress)?;
    let (memory, peak_memory) = memory(&prepared, pipeline);
    let group_file = group_file_bytes(&prepared, pipeline);
    // The trial below needs as much memory as the run.
    memory::refuse_more_than_available(needed_besides_model(&memory))?;
    let repeat = pipeline.stages.iter().find_map(|stage| match &stage.action {
        Action::Repeat(repeat) => Some(repeat.ending()),
        _ => None,
    });
    let stages = probe(pipeline, &prepared)?;
    Ok(Estimate { units: pipeline.units, prepared, memory, peak_memory, group_file, stages, repeat })
}
