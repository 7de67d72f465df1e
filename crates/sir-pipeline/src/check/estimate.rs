//! What a pipeline will do and cost, without doing it.

use std::path::Path;

use crate::check::needs::{memory, needed_beside_model};
use crate::check::probe::{StageEstimate, probe};
use crate::error::Error;
use crate::memory;
use crate::plan::{Action, Pipeline, Repeat, Until};
use crate::prepare::prepared::{Prepared, prepare};
use crate::progress::{NoProgress, Progress};
use crate::units::Units;

/// What a pipeline will do and cost.
#[derive(Clone, Debug)]
pub struct Estimate {
    /// What power is measured in.
    pub units: Units,
    /// The scene, ready to be lit.
    pub prepared: Prepared,
    /// Memory per part \[bytes\].
    pub memory: Vec<(&'static str, usize)>,
    /// Most memory in use at one time \[bytes\].
    pub peak_memory: usize,
    /// Lines and lines per second of each stage that has any: the rate of one thread in a short try on this machine now,
    /// times its processor cores.
    pub stages: Vec<StageEstimate>,
    /// How often these stages are repeated.
    pub repeat: Option<Repeated>,
}

/// How often stages are repeated, see [`Repeat`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Repeated {
    /// Until when.
    pub until: Until,
    /// How often at most.
    pub at_most: Option<u64>,
}

/// Says what the pipeline in the file `path` will do and cost: reads its scene, makes its patches and tries some lines of each
/// stage. Writes nothing.
///
/// # Errors
///
/// If the pipeline has mistakes, or as [`prepare`].
pub fn check(path: &Path) -> Result<Estimate, Error> {
    estimate(&Pipeline::read(path)?, &NoProgress)
}

/// As [`check`], of a pipeline that has been read: reads the scene of a pipeline, makes its patches and tries some lines of each stage. Writes nothing.
///
/// # Errors
///
/// As [`prepare`].
pub fn estimate(pipeline: &Pipeline, progress: &dyn Progress) -> Result<Estimate, Error> {
    let prepared = prepare(pipeline, progress)?;
    let (memory, peak_memory) = memory(&prepared.model, pipeline);
    // The try below takes as much as the run.
    memory::refuse_more_than_available(needed_beside_model(&memory))?;
    let repeat = pipeline.stages.iter().find_map(|stage| match &stage.action {
        Action::Repeat(repeat) => Some(repeat),
        _ => None,
    });
    let stages = probe(pipeline, &prepared)?;
    let repeat = repeat.map(|&Repeat { until, at_most, .. }| Repeated { until, at_most });
    Ok(Estimate { units: pipeline.units, prepared, memory, peak_memory, stages, repeat })
}
