//! Measures the line rate of each stage in a short trial.

use std::time::{Duration, Instant};

use sir_lines::LocalLines;
use sir_parallel::cores;
use sir_radiosity::{
    AnyOrder, BatchSettings, Batches, FirstShot, OneWorker, Points, ProbeStage, ProbeTask, SecondShot,
    SensorStage, SensorTask, ShadowRaySettings, ShadowRays, ShotSettings, Solution, SolveError, Stage,
    StageTotals,
};

use crate::plan;
use crate::plan::{Action, Pipeline};
use crate::prepare::layout::{Layout, Placed};
use crate::prepare::prepared::Prepared;
use crate::prepare::probe_grid::ProbeGrid;
use crate::run::split::Split;

/// Duration of the trial of a stage.
const PROBE: Duration = Duration::from_millis(300);

/// Number of lines between two checks of the clock.
const BLOCK: u64 = 1 << 10;

/// Estimated cost of a stage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StageEstimate {
    /// Name of the stage.
    pub name: &'static str,
    /// Number of lines.
    pub lines: u64,
    /// Lines per second.
    pub rate: f64,
}

/// Measures the line rate of each stage of a pipeline.
pub(super) fn probe(pipeline: &Pipeline, prepared: &Prepared) -> Result<Vec<StageEstimate>, SolveError> {
    let Prepared { model, focus, .. } = prepared;
    let (focus, seed) = (*focus, pipeline.seed);
    let (mut shot, mut direct) = (None, None);
    let mut estimates = Vec::new();
    let actions = pipeline.flat_stages().flat_map(|stage| match &stage.action {
        Action::Solve(solve) => Split::usual(solve.lines).actions(),
        action => vec![action.clone()],
    });
    for action in actions {
        let name = action.name();
        match action {
            Action::FirstShot(plan::FirstShot { lines }) => {
                let settings = ShotSettings::new(model, LocalLines { count: lines, focus }, seed);
                let stage = FirstShot::begin(settings, (), &OneWorker)?;
                let (rate, totals) = try_stage(&stage, lines);
                let first = stage.finish(totals, &OneWorker)?;
                if !prepared.placed.is_empty() {
                    direct = Some(first.solution(model));
                }
                shot = Some(first);
                estimates.push(StageEstimate { name, lines, rate });
            }
            Action::ShadowRays(plan::ShadowRays { rays }) => {
                let Some(first) = &shot else { continue };
                let lines = LocalLines { count: rays, focus };
                let settings =
                    ShadowRaySettings { model, rays: lines, seed, points: Points::Sobol, every: 1 };
                let stage = ShadowRays::begin(settings, first.clone(), &OneWorker)?;
                let (rate, _) = try_stage(&stage, stage.round().end);
                estimates.push(StageEstimate { name, lines: rays, rate });
            }
            Action::SecondShot(plan::SecondShot { lines, share }) => {
                let Some(first) = shot.take() else { continue };
                let settings = ShotSettings::new(model, LocalLines { count: lines, focus }, seed);
                let settings = settings.of_reflected(share);
                let stage = SecondShot::begin(settings, first, &OneWorker)?;
                let (rate, _) = try_stage(&stage, stage.round().end);
                shot = Some(stage.into_input());
                estimates.push(StageEstimate { name, lines, rate });
            }
            Action::Multipath(plan::Multipath { lines, domain, .. }) => {
                let Some(shot) = shot.take() else { continue };
                // Both transports trace the same lines, at about the same rate.
                let domain = domain.lines_around(&model.scene, focus);
                let settings = BatchSettings { model, domain, lines, seed };
                let stage = Batches::begin(settings, shot, &OneWorker)?;
                let (rate, _) = try_stage(&stage, lines);
                estimates.push(StageEstimate { name, lines, rate });
            }
            _ => {}
        }
    }
    if let Some(solution) = &direct {
        estimates.extend(try_sensors(pipeline, prepared, solution)?);
    }
    Ok(estimates)
}

/// Measures the ray rate of each stage `Sensors`. The light is that of another trial: only the time matters.
fn try_sensors(
    pipeline: &Pipeline,
    prepared: &Prepared,
    solution: &Solution,
) -> Result<Vec<StageEstimate>, SolveError> {
    let (model, seed) = (&prepared.model, pipeline.seed);
    let repeats = pipeline.stages.iter().find_map(|stage| match &stage.action {
        Action::Repeat(repeat) => Some(repeat.ending().share_rays()),
        _ => None,
    });
    let mut estimates = Vec::new();
    for (number, stage) in pipeline.stages.iter().enumerate() {
        let (Action::Sensors(sensors), Some(placed)) = (&stage.action, prepared.placed.get(&number)) else {
            continue;
        };
        let settings = sensors.settings();
        let (rate, _) = match placed {
            Placed::Sensors(Layout { sensors, .. }) => {
                let task = SensorTask { model, solution, sensors, settings, seed };
                try_stage(&SensorStage::begin(task, (), &OneWorker)?, sensors.len() as u64)
            }
            Placed::Probes(ProbeGrid { valid, .. }) => {
                let task = ProbeTask { model, solution, positions: valid, settings, seed };
                try_stage(&ProbeStage::begin(task, (), &OneWorker)?, valid.len() as u64)
            }
        };
        let lines = settings.shared(repeats.unwrap_or(1)).rays * placed.hemispheres();
        estimates.push(StageEstimate { name: stage.action.name(), lines, rate });
    }
    Ok(estimates)
}

/// Traces some of the units of a stage for a short time on one core. Returns the lines per second, times the number of cores,
/// and the stage totals.
fn try_stage<S: Stage<Chain = AnyOrder>>(stage: &S, units: u64) -> (f64, StageTotals) {
    let mut totals = StageTotals::default();
    let block = (BLOCK / stage.lines_per_unit()).max(1);
    let seconds = seconds(units, block, |block| stage.trace(0, &mut AnyOrder, block, &mut totals));
    (cores().get() as f64 * totals.counts.lines.max(1) as f64 / seconds, totals)
}

/// Returns the time of a short trial.
fn seconds(units: u64, block: u64, mut trace: impl FnMut(std::ops::Range<u64>)) -> f64 {
    let start = Instant::now();
    let mut done = 0;
    while done < units && start.elapsed() < PROBE {
        let end = units.min(done + block);
        trace(done..end);
        done = end;
    }
    start.elapsed().as_secs_f64().max(1e-9)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_trial_traces_every_unit_once() {
        let mut seen = 0;
        let seconds = seconds(2500, 1024, |block| {
            assert_eq!(block.start, seen);
            seen = block.end;
        });
        assert!(seen == 2500 && seconds > 0.0);
    }
}
