//! Updates of sides between two batches.

use sir_lines::GlobalLines;

use crate::batches::schedule::Schedule;
use crate::batches::side_state::SideState;
use crate::batches::sums::BatchSums;
use crate::counted::CountedPower;
use crate::focus_sides::FocusSides;
use crate::model::Model;
use crate::power::Quanta;
use crate::tallies::PatchTallies;
use crate::workers::Sides;

/// Consecutive sides between two batches.
pub(super) struct SideRange<'a> {
    pub(super) model: &'a Model,
    pub(super) domain: &'a GlobalLines,
    pub(super) focus_sides: &'a FocusSides,
    pub(super) tallies: &'a PatchTallies,
    pub(super) schedule: &'a Schedule,
    pub(super) sides: Sides<'a>,
}

impl SideRange<'_> {
    /// Sets the power that these sides send with each line of the batch that begins.
    pub(super) fn open(&self, states: &[SideState]) {
        let batch = self.schedule.batch();
        let forecast = self.domain.forecast(batch.end - batch.start);
        let heavy = f64::from(self.domain.weight());
        let withheld = self.schedule.withheld();
        for ((triangle, side), state) in self.sides.iter().zip(states) {
            let weight = if self.focus_sides.contains(side) { 1.0 } else { heavy };
            let expected = forecast.crossings(self.model.area(triangle, side)) / weight;
            let lines = weight * (expected + 1.0 + expected.sqrt() * expected.min(1.0));
            let kept = |band: usize| withheld * f64::from(state.source[band]);
            let share = |band: usize| (state.unshot.0[band] as f64 - kept(band)) / lines;
            self.tallies.set_share(side, [0, 1, 2].map(share));
        }
    }

    /// Adds up the power that the lines of the batch that ends have brought to these sides and taken from them.
    pub(super) fn close(&self, states: &mut [SideState]) -> BatchSums {
        let mut sums = BatchSums::default();
        for ((triangle, side), state) in self.sides.iter().zip(states) {
            let (power, crossings) = self.tallies.take(side);
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
        sums
    }

    /// Computes what the lines of all batches have brought to these sides.
    pub(super) fn count(&self, states: &[SideState], counted: &mut [CountedPower]) {
        for (((_, side), state), counted) in self.sides.iter().zip(states).zip(counted) {
            let SideState { brought, crossings, .. } = *state;
            let (squares, lines) = (self.tallies.squares(side), crossings as f64);
            let is_ratio = self.focus_sides.contains(side) && crossings >= 2;
            let variance = [0, 1, 2].map(|band| {
                let (square, brought) = (squares[band], brought.0[band] as f64);
                match is_ratio {
                    true => ((square - brought * brought / lines).max(0.0) * lines / (lines - 1.0)) as f32,
                    false => square as f32,
                }
            });
            *counted = CountedPower { power: brought, crossings, variance };
        }
    }
}
