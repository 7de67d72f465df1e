//! Sensors as a stage. Any worker may measure any sensor.

use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

use crate::error::SolveError;
use crate::model::Model;
use crate::sensors::gatherer::Gatherer;
use crate::sensors::measurement::Measurement;
use crate::sensors::sensor::{Sensor, SensorSettings};
use crate::solution::Solution;
use crate::stage::{AnyOrder, Stage};
use crate::totals::StageTotals;
use crate::visitor::Visitor;
use crate::workers::Workers;

/// Input of the measurement.
#[derive(Clone, Copy, Debug)]
pub struct SensorTask<'s> {
    /// The scene and its patches.
    pub model: &'s Model,
    /// Irradiance of the patches whose reflected light is gathered.
    pub solution: &'s Solution,
    /// Sensors to measure.
    pub sensors: &'s [Sensor],
    /// Number of rays and target error.
    pub settings: SensorSettings,
    /// Seed of the random numbers.
    pub seed: u64,
}

/// Bits of a [`Measurement`].
type Slot = [AtomicU64; 15];

/// Measures sensors in any order. The outcome is their measurements in the order of the sensors.
#[derive(Debug)]
pub struct SensorStage<'s> {
    sensors: &'s [Sensor],
    gatherer: Gatherer<'s>,
    rays: u64,
    /// Measurements as bit patterns; zero where nothing has been measured yet.
    measured: Vec<Slot>,
}

impl<'s> Stage for SensorStage<'s> {
    type Settings = SensorTask<'s>;
    type Input = ();
    type Outcome = Vec<Measurement>;
    type Chain = AnyOrder;

    fn identity(task: &Self::Settings) -> Vec<u64> {
        let SensorTask { model, sensors, settings, seed, .. } = task;
        let sides = model.mesh.side_count() as u64;
        vec![
            6,
            sides,
            sensors.len() as u64,
            settings.rays,
            settings.error.to_bits(),
            settings.replications,
            *seed,
        ]
    }

    fn begin(task: Self::Settings, (): (), _workers: &dyn Workers) -> Result<Self, SolveError> {
        let SensorTask { model, solution, sensors, settings, seed } = task;
        let gatherer = Gatherer::new(model, solution, settings, seed);
        let measured = sensors.iter().map(|_| Slot::default()).collect();
        let hemispheres = sensors.iter().map(Sensor::hemispheres).max().unwrap_or(1);
        Ok(Self { sensors, gatherer, rays: hemispheres * settings.rays.max(1), measured })
    }

    fn restore(
        task: Self::Settings,
        workers: &dyn Workers,
        visitor: &mut dyn Visitor,
    ) -> Result<Self, SolveError> {
        let mut stage = Self::begin(task, (), workers)?;
        stage.visit(visitor);
        Ok(stage)
    }

    fn round(&self) -> Range<u64> {
        0..self.sensors.len() as u64
    }

    fn lines_per_unit(&self) -> u64 {
        self.rays
    }

    fn chain(&self, _number: u64) -> AnyOrder {
        AnyOrder
    }

    fn trace(&self, _worker: usize, _chain: &mut AnyOrder, sensors: Range<u64>, totals: &mut StageTotals) {
        for number in sensors {
            let index = number as usize;
            let (Some(sensor), Some(slot)) = (self.sensors.get(index), self.measured.get(index)) else {
                continue;
            };
            let measurement = self.gatherer.measure(number, sensor);
            totals.counts.lines += measurement.rays;
            slot.iter().zip(measurement.to_bits()).for_each(|(word, bits)| word.store(bits, Relaxed));
        }
    }

    /// Each sensor is measured by one process, and all others have zeros, so the sum of the bit patterns is the
    /// measurement.
    fn visit_round(&mut self, visitor: &mut dyn Visitor) {
        let mut words: Vec<i64> =
            self.measured.iter_mut().flatten().map(|word| *word.get_mut() as i64).collect();
        visitor.sum(&mut words);
        self.measured.iter_mut().flatten().zip(words).for_each(|(word, bits)| *word.get_mut() = bits as u64);
    }

    fn visit(&mut self, visitor: &mut dyn Visitor) {
        self.visit_round(visitor);
    }

    fn finish(self, _totals: StageTotals, _workers: &dyn Workers) -> Result<Vec<Measurement>, SolveError> {
        let bits = |slot: Slot| slot.map(AtomicU64::into_inner);
        Ok(self.measured.into_iter().map(|slot| Measurement::from_bits(bits(slot))).collect())
    }
}
