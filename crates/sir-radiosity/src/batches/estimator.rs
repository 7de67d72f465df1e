//! The estimator: converts the power that lines have brought to the power that sides receive, with its variance.

use sir_lines::GlobalLines;

use crate::batches::schedule::Schedule;
use crate::batches::side_state::SideState;
use crate::focus_sides::FocusSides;
use crate::model::Model;
use crate::power::Quanta;
use crate::received::Received;
use crate::tallies::PatchTallies;

/// The tallies of all batches, with the data needed to evaluate them.
pub(super) struct Counted<'a> {
    pub(super) model: &'a Model,
    pub(super) domain: &'a GlobalLines,
    pub(super) focus_sides: &'a FocusSides,
    pub(super) tallies: &'a PatchTallies,
    pub(super) states: &'a [SideState],
    pub(super) schedule: &'a Schedule,
}

impl Counted<'_> {
    /// Adds the estimate of the indirect power, and its variance, to the direct power that sides have received.
    ///
    /// Returns the extrapolated power: the estimate minus the power that lines have brought.
    pub(super) fn add_to(&self, received: &mut Received) -> Quanta {
        let Self { model, domain, focus_sides, tallies, states, schedule } = *self;
        let (forecast, extrapolations) = (
            domain.forecast(schedule.lines()),
            [false, true].map(|in_focus| schedule.extrapolation(in_focus)),
        );
        let factor =
            |state: &SideState, triangle, side| state.factor(forecast.crossings(model.area(triangle, side)));
        let (mut plain, mut corrected) = ([0.0; 3], [0.0; 3]);
        model.mesh.for_each_side(|triangle, _, _, side| {
            if !focus_sides.contains(side) {
                return;
            }
            let (state, [_, extrapolation]) = (&states[side.index()], extrapolations);
            let factor = factor(state, triangle, side);
            for band in 0..3 {
                let [_, _, power] = state.extrapolated(band, extrapolation[band]);
                plain[band] += power;
                corrected[band] += factor * power;
            }
        });
        let scale = |band| if corrected[band] > 0.0 { plain[band] / corrected[band] } else { 1.0 };
        let mut extrapolated = Quanta::ZERO;
        let Received { power, variance } = received;
        model.mesh.for_each_side(|triangle, _, _, side| {
            let (state, squares) = (&states[side.index()], tallies.squares(side));
            // The ratio estimator does not apply where lines have different weights.
            let in_focus = focus_sides.contains(side);
            let factor = if in_focus { factor(state, triangle, side) } else { 1.0 };
            let extrapolation = extrapolations[usize::from(in_focus)];
            let (power, variance) = (&mut power[side.index()], &mut variance[side.index()]);
            let mut sum = Quanta::ZERO;
            for band in 0..3 {
                let [brought, tail, total] = state.extrapolated(band, extrapolation[band]);
                let factor = if in_focus { factor * scale(band) } else { 1.0 };
                sum.0[band] = (factor * total).round() as i64;
                // Lines bring about the same at all times, so the squares of the tail are in proportion to its power.
                let share = if brought > 0.0 { (tail / brought).clamp(0.0, 1.0) } else { 0.0 };
                let longer = 1.0 - share + share * (1.0 + extrapolation[band]) * (1.0 + extrapolation[band]);
                let squares = longer * squares[band];
                let spread = if in_focus { state.variance(total, squares) } else { squares };
                let more = factor * factor * spread;
                variance[band] = (f64::from(variance[band]) + more) as f32;
            }
            *power += sum;
            extrapolated += sum - state.brought;
        });
        extrapolated
    }
}
