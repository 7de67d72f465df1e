//! Probes as a stage. Any worker may measure any probe.

use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

use glam::DVec3;

use crate::error::SolveError;
use crate::model::Model;
use crate::probes::gatherer::ProbeGatherer;
use crate::probes::measurement::{ProbeMeasurement, WORDS};
use crate::sensors::SensorSettings;
use crate::solution::Solution;
use crate::stage::{AnyOrder, Stage};
use crate::totals::StageTotals;
use crate::visitor::Visitor;
use crate::workers::Workers;

/// Input of the measurement.
#[derive(Clone, Copy, Debug)]
pub struct ProbeTask<'s> {
    /// The scene and its patches.
    pub model: &'s Model,
    /// Irradiance of the patches whose reflected light is gathered.
    pub solution: &'s Solution,
    /// Positions of the probes.
    pub positions: &'s [DVec3],
    /// Number of rays of each of the six sensors of a probe, and target error.
    pub settings: SensorSettings,
    /// Seed of the random numbers.
    pub seed: u64,
}

/// Measures probes in any order. The outcome is their measurements in the order of the probes.
#[derive(Debug)]
pub struct ProbeStage<'s> {
    positions: &'s [DVec3],
    gatherer: ProbeGatherer<'s>,
    rays: u64,
    /// Measurements as bit patterns; zero where nothing has been measured yet.
    measured: Vec<[AtomicU64; WORDS]>,
}

impl<'s> Stage for ProbeStage<'s> {
    type Settings = ProbeTask<'s>;
    type Input = ();
    type Outcome = Vec<ProbeMeasurement>;
    type Chain = AnyOrder;

    fn identity(task: &Self::Settings) -> Vec<u64> {
        let ProbeTask { model, positions, settings, seed, .. } = task;
        let sides = model.mesh.side_count() as u64;
        let SensorSettings { rays, error, replications, .. } = *settings;
        vec![9, sides, positions.len() as u64, rays, error.to_bits(), replications, *seed]
    }

    fn begin(task: Self::Settings, (): (), _workers: &dyn Workers) -> Result<Self, SolveError> {
        let ProbeTask { model, solution, positions, settings, seed } = task;
        let gatherer = ProbeGatherer::new(model, solution, settings, seed);
        let measured = positions.iter().map(|_| [const { AtomicU64::new(0) }; WORDS]).collect();
        Ok(Self { positions, gatherer, rays: 6 * settings.rays.max(1), measured })
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
        0..self.positions.len() as u64
    }

    fn lines_per_unit(&self) -> u64 {
        self.rays
    }

    fn chain(&self, _number: u64) -> AnyOrder {
        AnyOrder
    }

    fn trace(&self, _worker: usize, _chain: &mut AnyOrder, probes: Range<u64>, totals: &mut StageTotals) {
        for number in probes {
            let index = number as usize;
            let (Some(&position), Some(slot)) = (self.positions.get(index), self.measured.get(index)) else {
                continue;
            };
            let measurement = self.gatherer.measure(number, position);
            totals.counts.lines += measurement.rays;
            slot.iter().zip(measurement.to_words()).for_each(|(word, bits)| word.store(bits, Relaxed));
        }
    }

    /// Each probe is measured by one process, and all others have zeros, so the sum of the bit patterns is the
    /// measurement.
    fn visit_round(&mut self, visitor: &mut dyn Visitor) {
        let words = || self.measured.iter().flatten();
        let mut sums: Vec<i64> = words().map(|word| word.load(Relaxed) as i64).collect();
        visitor.sum(&mut sums);
        words().zip(sums).for_each(|(word, bits)| word.store(bits as u64, Relaxed));
    }

    fn visit(&mut self, visitor: &mut dyn Visitor) {
        self.visit_round(visitor);
    }

    fn finish(
        self,
        _totals: StageTotals,
        _workers: &dyn Workers,
    ) -> Result<Vec<ProbeMeasurement>, SolveError> {
        let measurement =
            |slot: [AtomicU64; WORDS]| ProbeMeasurement::from_words(&slot.map(AtomicU64::into_inner));
        Ok(self.measured.into_iter().map(measurement).collect())
    }
}
