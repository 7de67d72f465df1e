//! The outcome of a shot, and what is asked of one.

use sir_lines::LocalLines;
use sir_mesh::SideId;

use crate::model::Model;
use crate::power::{PowerUnit, Quanta};
use crate::received::Received;
use crate::solution::Solution;
use crate::totals::{Balance, Counts};

/// Settings of a first or second shot.
#[derive(Clone, Copy, Debug)]
pub struct ShotSettings<'m> {
    /// The scene and its patches.
    pub model: &'m Model,
    /// Number of lines, and a focus if there is one.
    pub lines: LocalLines,
    /// Seed of the random numbers.
    pub seed: u64,
}

impl<'m> ShotSettings<'m> {
    /// Returns the settings for this number of lines.
    pub fn new(model: &'m Model, lines: impl Into<LocalLines>, seed: u64) -> Self {
        Self { model, lines: lines.into(), seed }
    }

    /// Returns what tells a shot of this `kind` from other stages.
    pub(crate) fn identity(&self, kind: u64) -> Vec<u64> {
        let mut words = vec![kind, self.model.mesh.side_count() as u64, self.lines.count, self.seed];
        words.extend(self.lines.focus.iter().flat_map(|focus| focus.identity()));
        words
    }
}

/// The outcome of a first shot, or of both shots.
#[derive(Clone, Debug)]
pub struct Shot {
    /// Direct power received by each side.
    pub received: Received,
    /// The size of a quantum, for this and all later stages.
    pub unit: PowerUnit,
    /// Where the power went. Its `unshot` is the reflected direct power that has to be sent on.
    pub balance: Balance,
    /// What the lines met.
    pub counts: Counts,
    /// Power that some sides have sent of the light that they reflect, in a second shot.
    pub sent: Vec<(SideId, Quanta)>,
}

impl Shot {
    /// Returns the power that each side reflects and has not sent, indexed by [`SideId`]. By chance it is a little below
    /// zero where a side has sent all.
    #[must_use]
    pub fn unshot(&self, model: &Model) -> Vec<Quanta> {
        let mut unshot = Vec::with_capacity(model.mesh.side_count());
        model.mesh.for_each_side(|triangle, _, _, side| {
            let reflectance = model.reflectance(triangle, side);
            unshot.push(self.received.power[side.index()].scaled(reflectance));
        });
        for &(side, sent) in &self.sent {
            unshot[side.index()] = unshot[side.index()] - sent;
        }
        unshot
    }

    /// Returns the direct light alone: the irradiance by the sources, before any reflection.
    #[must_use]
    pub fn solution(&self, model: &Model) -> Solution {
        Solution::new(model, &self.received, self.unit)
    }
}
