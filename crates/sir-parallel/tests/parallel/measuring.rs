//! Measurements of sensors do not depend on the number of workers.

use glam::DVec3;
use sir_parallel::{Executor, RunError, StageRun, Start};
use sir_radiosity::{Gatherer, Measurement, Sensor, SensorSettings, SensorStage, SensorTask, Solution};

use crate::jobs::{ROOM, executor};
use crate::observers::StopAfter;
use crate::ranks::run_ranks;

const SEED: u64 = 5;

/// A target for the error, so that some sensors need more rays than others.
const SETTINGS: SensorSettings = SensorSettings::new(8192, 0.02);

fn sensors() -> Vec<Sensor> {
    let at = |i: i32| DVec3::new(-0.9 + 0.13 * f64::from(i), 0.5, -0.8);
    (0..13).map(|i| Sensor::new(at(i), DVec3::new(0.1, -0.3, 1.0)).unwrap()).collect()
}

fn measure(
    solution: &Solution,
    sensors: &[Sensor],
    executor: &mut Executor<'_>,
) -> Result<StageRun<Vec<Measurement>>, RunError> {
    let task = SensorTask { model: &ROOM.model, solution, sensors, settings: SETTINGS, seed: SEED };
    executor.run::<SensorStage<'_>>(task, Start::Fresh(()))
}

#[test]
fn sensors_measure_the_same_by_any_number_of_workers() {
    let (sensors, solution) = (sensors(), ROOM.shot.solution(&ROOM.model));
    let by_hand = Gatherer::new(&ROOM.model, &solution, SETTINGS, SEED);
    let expected: Vec<Measurement> = (0..).zip(&sensors).map(|(i, s)| by_hand.measure(i, s)).collect();
    assert!(expected.iter().any(|m| m.rays < SETTINGS.rays), "some are done with fewer rays");
    assert!(expected.iter().all(|m| m.irradiance.min_element() > 0.0 && m.inherited.x > 0.0));
    for (ranks, threads) in [(1, 1), (1, 3), (2, 1), (3, 2), (4, 1)] {
        let all = run_ranks(ranks, |comm| {
            let executor = &mut executor(comm, threads);
            measure(&solution, &sensors, executor).unwrap().outcome
        });
        for measured in all {
            assert_eq!(measured, expected, "{ranks} ranks, {threads} threads");
        }
    }
}

#[test]
fn measuring_can_be_stopped() {
    let (sensors, solution) = (sensors(), ROOM.shot.solution(&ROOM.model));
    let outcomes = run_ranks(2, |comm| {
        let executor = &mut executor(comm, 1).watched_by(StopAfter(1));
        measure(&solution, &sensors, executor).map(|run| run.outcome)
    });
    for outcome in outcomes {
        let Err(RunError::Interrupted { done, total }) = outcome else { panic!("{outcome:?}") };
        assert!(done > 0 && done < total && total == 13 * 8192, "{done} of {total}");
    }
}
