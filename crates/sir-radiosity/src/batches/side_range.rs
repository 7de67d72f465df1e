//! Updates of sides between two batches.

use std::ops::Range;

use sir_geom::TriangleId;
use sir_lines::GlobalLines;
use sir_mesh::SideId;

use crate::batches::schedule::Schedule;
use crate::batches::side_state::SideState;
use crate::batches::sums::BatchSums;
use crate::focus_sides::FocusSides;
use crate::model::Model;
use crate::power::Quanta;
use crate::tallies::PatchTallies;

/// A range of consecutive sides between two batches. All ranges together contain all sides, and may be processed
/// concurrently.
#[derive(Debug)]
pub(super) struct SideRange<'a> {
    pub(super) model: &'a Model,
    pub(super) domain: &'a GlobalLines,
    pub(super) focus_sides: &'a FocusSides,
    pub(super) tallies: &'a PatchTallies,
    pub(super) schedule: Schedule,
    pub(super) first: u32,
    pub(super) states: &'a mut [SideState],
}

impl<'a> SideRange<'a> {
    /// Sets the power that these sides send with each line of the batch that begins.
    pub(super) fn open(&mut self) {
        let batch = self.schedule.batch();
        let forecast = self.domain.forecast(batch.end - batch.start);
        let heavy = f64::from(self.domain.weight());
        let withheld = self.schedule.withheld();
        for (triangle, sides) in self.sides() {
            for i in sides {
                let weight = if self.focus_sides.contains(SideId(i)) { 1.0 } else { heavy };
                let expected = forecast.crossings(self.model.area(triangle, SideId(i))) / weight;
                let lines = weight * (expected + 1.0 + expected.sqrt() * expected.min(1.0));
                let k = (i - self.first) as usize;
                let state = &self.states[k];
                let kept = |band: usize| withheld * f64::from(state.source[band]);
                let share = |band: usize| (state.unshot.0[band] as f64 - kept(band)) / lines;
                self.tallies.set_share(SideId(i), [0, 1, 2].map(share));
            }
        }
    }

    /// Adds up the power that the lines of the batch that ends have brought to the sides of this range and taken from
    /// them.
    pub(super) fn close(&mut self) -> BatchSums {
        let mut sums = BatchSums::default();
        for (triangle, sides) in self.sides() {
            for i in sides {
                let side = SideId(i);
                let (power, crossings) = self.tallies.take(side);
                let state = &mut self.states[(i - self.first) as usize];
                let in_focus = self.focus_sides.contains(side);
                // Lines of a small batch meet few of many small patches.
                if crossings == 0 && power == Quanta::ZERO {
                    sums.unshot.add(state.unshot, in_focus);
                    continue;
                }
                let reflectance = self.model.reflectance(triangle, side);
                let sent = self.tallies.share(side).times(i64::from(crossings));
                let reflected = power.scaled(reflectance);
                state.brought += power;
                state.unshot += reflected - sent;
                state.crossings += u64::from(crossings);
                sums.unshot.add(state.unshot, in_focus);
                sums.sent.add(sent, in_focus);
                sums.reflected.add(reflected, in_focus);
                sums.absorbed += power - reflected;
            }
        }
        sums
    }

    /// Returns the sides of this range: triangles, and consecutive sides of each.
    fn sides(&self) -> impl Iterator<Item = (TriangleId, Range<u32>)> + use<'a> {
        self.model.mesh.sides_within(self.first..self.first + self.states.len() as u32)
    }
}
