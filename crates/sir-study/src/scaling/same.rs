//! The check that all runs of a measurement have the same result.

use crate::scaling::error::ScalingError;
use crate::scaling::workers::Workers;
use sir_pipeline::report::{Report, StageReport};

/// Identification of a run: its workers and its repeat, from 1.
pub(crate) type Which = (Workers, usize);

/// Checks that a run has the same result as the first one.
pub(crate) fn check(first: (Which, &Report), this: (Which, &Report)) -> Result<(), ScalingError> {
    let (a, b) = (first.1, this.1);
    let inputs =
        |r: &Report| (r.version, r.program.clone(), r.pipeline.text.clone(), r.seed, r.scene.clone());
    if inputs(a) != inputs(b) {
        return Err(ScalingError::Changed);
    }
    let different = |what| Err(ScalingError::DifferentResults { this: this.0, first: first.0, what });
    if a.stages.len() != b.stages.len() {
        return different("it has a different number of stages".into());
    }
    match a.stages.iter().zip(&b.stages).find_map(|(a, b)| difference(a, b)) {
        Some(what) => different(what),
        None => Ok(()),
    }
}

/// Returns the difference between two stages, apart from the time, if there is one.
fn difference(a: &StageReport, b: &StageReport) -> Option<String> {
    if a.name != b.name {
        return Some(format!("`{}` instead of `{}`", b.name, a.name));
    }
    let (hash_a, hash_b) = (hash(a), hash(b));
    let what = match (&a.lines, &b.lines) {
        _ if hash_a != hash_b => format!("tally_hash {hash_b} instead of {hash_a}"),
        (Some(a), Some(b)) if a.balance != b.balance => {
            format!("balance {:?} instead of {:?}", b.balance, a.balance)
        }
        (lines_a, lines_b) if (lines_a, &a.light, a.repeats) != (lines_b, &b.light, b.repeats) => {
            "the same tallies and balance, but different counts or errors".into()
        }
        _ => return a.stages.iter().zip(&b.stages).find_map(|(a, b)| difference(a, b)),
    };
    Some(format!("`{}` has {what}", a.name))
}

fn hash(stage: &StageReport) -> &str {
    stage.light.as_ref().map_or("", |light| &light.tally_hash)
}
