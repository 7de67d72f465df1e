//! The stages of the solver, run by one worker.

use std::time::{Duration, Instant};

use sir_radiosity::{FirstShot, Model, Multipath, MultipathSettings, Shot, Transported};

use crate::walk::{Observer, RunError, share, walk};

/// Lines between two looks at the observer: some milliseconds of work.
const BLOCK: u64 = 1 << 13;

/// The outcome of a stage and how long it took.
#[derive(Clone, Debug)]
pub struct StageRun<T> {
    /// What the stage made.
    pub outcome: T,
    /// Wall-clock time, set-up included.
    pub time: Duration,
}

/// Runs a first shot of `lines` lines.
///
/// # Errors
///
/// If nothing emits, a tally overflowed, or the observer wants to stop.
pub fn first_shot(
    model: &Model,
    lines: u64,
    seed: u64,
    observer: &mut dyn Observer,
) -> Result<StageRun<Shot>, RunError> {
    let start = Instant::now();
    let stage = FirstShot::new(model, lines, seed)?;
    let mut tally = stage.tally();
    walk(share(lines, 0, 1), BLOCK, observer, |block| stage.trace(block, &mut tally))?;
    Ok(StageRun { outcome: stage.finish(tally)?, time: start.elapsed() })
}

/// Runs multipath on the reflected light of a first shot.
///
/// # Errors
///
/// If a tally overflowed, or the observer wants to stop.
pub fn multipath(
    model: &Model,
    shot: Shot,
    settings: MultipathSettings,
    seed: u64,
    observer: &mut dyn Observer,
) -> Result<StageRun<Transported>, RunError> {
    let start = Instant::now();
    let mut stage = Multipath::new(model, shot, settings, seed);
    walk(share(settings.lines, 0, 1), BLOCK, observer, |block| stage.trace(block))?;
    Ok(StageRun { outcome: stage.finish()?, time: start.elapsed() })
}
