//! Sensors, shared among threads and ranks.

use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

use sir_radiosity::{Measurement, Model, Sensor, SensorSettings, Sensors, Solution, share};

use crate::communicator::Communicator;
use crate::crew::Crew;
use crate::crew::{Shift, each};
use crate::error::RunError;
use crate::stages::StageRun;

/// Measures the light of a solution at sensors, in their order. Each is measured by one thread; the numbers are the same whoever it is.
///
/// There are no checkpoints: what takes minutes to measure has taken hours to solve.
///
/// # Errors
///
/// If the observer wants to stop.
pub fn measure(
    model: &Model,
    solution: &Solution,
    sensors: &[Sensor],
    settings: SensorSettings,
    seed: u64,
    crew: &mut Crew<'_>,
) -> Result<StageRun<Vec<Measurement>>, RunError> {
    let rays = settings.rays.max(1);
    let total = rays.saturating_mul(sensors.len() as u64);
    let mut shift = Shift::begin(crew, total, &[]);
    let prepared = Sensors::new(model, solution, settings, seed);
    let (rank, ranks) = (shift.comm().rank() as u64, shift.comm().size() as u64);
    let threads = shift.threads();
    let mut workers = [threads as i64];
    shift.talk(|comm| comm.sum(&mut workers));
    let mut measured = vec![Measurement::default(); sensors.len()];
    let mut done = 0;
    while done < sensors.len() {
        let orders = shift.orders();
        if orders.stop {
            return Err(RunError::Interrupted { done: rays * done as u64, total });
        }
        let count = (orders.slice / rays).max(workers[0] as u64).min((sensors.len() - done) as u64);
        let mine = share(count, rank, ranks);
        let mine = done + mine.start as usize..done + mine.end as usize;
        let next = AtomicUsize::new(mine.start);
        let work = |_| {
            let mut found = Vec::new();
            loop {
                let i = next.fetch_add(1, Relaxed);
                let Some(sensor) = sensors.get(i).filter(|_| i < mine.end) else { return found };
                found.push((i, prepared.measure(i as u64, sensor)));
            }
        };
        let found = shift.tracing(|| each(0..threads.min(mine.len().max(1)), work));
        for (i, measurement) in found.into_iter().flatten() {
            measured[i] = measurement;
        }
        shift.traced(rays * count);
        done += count as usize;
        shift.progress(rays * done as u64);
    }
    if ranks > 1 {
        shift.talk(|comm| join(comm, &mut measured));
    }
    Ok(StageRun { outcome: measured, time: shift.time(), batches: 1 })
}

/// Gives all ranks what each of them has measured: every number is zero on all ranks but one, so the sum of the bit patterns is
/// that of the number.
fn join(comm: &dyn Communicator, measured: &mut [Measurement]) {
    let mut words: Vec<i64> =
        measured.iter().flat_map(Measurement::to_bits).map(|word| word as i64).collect();
    comm.sum(&mut words);
    for (measurement, words) in measured.iter_mut().zip(words.as_chunks().0) {
        *measurement = Measurement::from_bits(words.map(|word| word as u64));
    }
}
