//! Settings and outcome of a shot.

use sir_lines::LocalLines;
use sir_mesh::SideId;

use crate::model::Model;
use crate::power::{PowerUnit, Quanta, visit_quanta};
use crate::received::Received;
use crate::solution::Solution;
use crate::totals::{Balance, Counts};
use crate::visitor::{Visitor, visit_counts};
use crate::workers::{BLOCK, Workers, map_sides};

/// Points of the lines of a shot: where each begins on its source, and its direction.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Points {
    /// Independent random points.
    #[default]
    Random,
    /// Points of one scrambled Sobol' sequence for all lines, see [`SobolPoints`](sir_lines::SobolPoints). The noise is
    /// smaller, but the errors that a shot states are those of independent points. Those from the spread of repeats are
    /// right.
    Sobol,
}

/// Settings of a first or second shot.
#[derive(Clone, Copy, Debug)]
pub struct ShotSettings<'m> {
    /// The scene and its patches.
    pub model: &'m Model,
    /// Number of lines, and an optional focus.
    pub lines: LocalLines,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Points of the lines.
    pub points: Points,
    /// In a second shot: share of the reflected power in the focus that its lines carry, from the brightest patches on. If
    /// `None`, a line carries as much power as a line of the first shot.
    pub reflected_share: Option<f64>,
}

impl<'m> ShotSettings<'m> {
    /// Returns the settings for this number of lines.
    pub fn new(model: &'m Model, lines: impl Into<LocalLines>, seed: u64) -> Self {
        Self { model, lines: lines.into(), seed, points: Points::Random, reflected_share: None }
    }

    /// Returns settings with these points.
    #[must_use]
    pub fn with(self, points: Points) -> Self {
        Self { points, ..self }
    }

    /// Returns settings of a second shot whose lines carry this share of the reflected power.
    #[must_use]
    pub fn of_reflected(self, share: Option<f64>) -> Self {
        Self { reflected_share: share, ..self }
    }

    /// Returns numbers that identify a shot of this `kind` and its settings.
    pub(crate) fn identity(&self, kind: u64) -> Vec<u64> {
        let mut words = vec![kind, self.model.mesh.side_count() as u64, self.lines.count, self.seed];
        words.extend(self.lines.focus.iter().flat_map(|focus| focus.identity()));
        words.extend([self.points as u64, self.reflected_share.map_or(0, f64::to_bits)]);
        words
    }
}

/// The outcome of a first shot, or of both shots.
#[derive(Clone, Debug)]
pub struct Shot {
    /// Direct power received by each side.
    pub received: Received,
    /// Size of a quantum, for this and all later stages.
    pub unit: PowerUnit,
    /// Energy balance. Its `unshot` is the reflected direct power that has yet to be sent.
    pub balance: Balance,
    /// Counts of lines and hits.
    pub counts: Counts,
    /// Power that sides have sent in a second shot, of the light that they reflect.
    pub sent: Vec<(SideId, Quanta)>,
    /// Part of `received` that shadow rays have added or taken away, indexed by [`SideId`]; empty without shadow rays. The
    /// light that is reflected is that of the lines, whose power adds up.
    pub correction: Vec<Quanta>,
}

impl Shot {
    /// Returns a shot without lines.
    pub(crate) fn dark(model: &Model) -> Self {
        Self {
            received: Received::nothing(model.mesh.side_count()),
            unit: PowerUnit::for_total(1.0, 0.0),
            balance: Balance::default(),
            counts: Counts::default(),
            sent: Vec::new(),
            correction: Vec::new(),
        }
    }

    /// Restores a first shot that [`visit`](Self::visit) passed to the visitor that saved it.
    pub(crate) fn restore(model: &Model, visitor: &mut dyn Visitor) -> Self {
        let mut shot = Self::dark(model);
        shot.visit(visitor);
        shot
    }

    /// Visits a first shot.
    pub(crate) fn visit(&mut self, visitor: &mut dyn Visitor) {
        self.received.visit(visitor);
        self.unit.visit(visitor);
        let Balance { emitted, absorbed, blocked, escaped, unshot } = &mut self.balance;
        for quanta in [emitted, absorbed, blocked, escaped, unshot] {
            visitor.same(&mut quanta.0);
        }
        let Counts { lines, empty, odd, crossings } = &mut self.counts;
        let mut corrections = self.correction.len() as u64;
        visit_counts([lines, empty, odd, crossings, &mut corrections], visitor);
        self.correction.resize(corrections as usize, Quanta::ZERO);
        visit_quanta(&mut self.correction, visitor);
    }

    /// Returns the power that each side reflects and has not sent, indexed by [`SideId`]. By chance it is slightly
    /// negative for some sides that have sent all of it.
    #[must_use]
    pub fn unshot(&self, model: &Model, workers: &dyn Workers) -> Vec<Quanta> {
        let mut unshot = vec![Quanta::ZERO; model.mesh.side_count()];
        map_sides(workers, &model.mesh, unshot.chunks_mut(BLOCK), |sides, unshot| {
            for ((triangle, side), unshot) in sides.iter().zip(unshot) {
                let correction = self.correction.get(side.index()).copied().unwrap_or_default();
                let brought = self.received.power[side.index()] - correction;
                *unshot = brought.scaled(model.reflectance(triangle, side));
            }
        });
        for &(side, sent) in &self.sent {
            unshot[side.index()] = unshot[side.index()] - sent;
        }
        unshot
    }

    /// Returns the direct light alone: the irradiance by the sources before any reflection.
    #[must_use]
    pub fn solution(&self, model: &Model) -> Solution {
        Solution::new(model, &self.received, self.unit)
    }
}
