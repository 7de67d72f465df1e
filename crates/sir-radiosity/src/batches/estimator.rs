//! Converts the power that lines have brought to the power that sides receive, with its variance.

use sir_lines::GlobalLines;

use crate::batches::side_state::SideState;
use crate::counted::{Counted, CountedPower, common_scale, ratio};
use crate::focus_sides::FocusSides;
use crate::model::Model;
use crate::received::Received;
use crate::tallies::PatchTallies;

/// Returns what the lines of all batches have brought.
pub(super) fn counted(
    model: &Model,
    domain: GlobalLines,
    lines: u64,
    in_focus: &FocusSides,
    states: Vec<SideState>,
) -> Counted {
    let sides: Vec<CountedPower> = states
        .into_iter()
        .map(|state| CountedPower { power: state.brought, crossings: state.crossings })
        .collect();
    let forecast = domain.forecast(lines);
    let scale = common_scale(model, in_focus, |triangle, side| {
        let CountedPower { power, crossings } = sides[side.index()];
        let factor = ratio(forecast.crossings(model.area(triangle, side)), crossings as f64);
        (power.0.map(|power| power as f64), factor)
    });
    Counted { domain, lines, sides, scale }
}

/// Adds the estimate of the power that lines have brought, and its variance, to the other power that sides have received.
pub(super) fn add_to(
    received: &mut Received,
    model: &Model,
    counted: &Counted,
    in_focus: &FocusSides,
    tallies: &PatchTallies,
) {
    let Received { power, variance } = received;
    model.mesh.for_each_side(|triangle, _, _, side| {
        let CountedPower { power: brought, crossings } = counted.sides[side.index()];
        let estimate = counted.estimate(model, in_focus, triangle, side);
        let squares = tallies.squares(side);
        let variance = &mut variance[side.index()];
        for band in 0..3 {
            let (brought, lines) = (brought.0[band] as f64, crossings as f64);
            let factor = if brought == 0.0 { 1.0 } else { estimate.0[band] as f64 / brought };
            // The number of lines is given by the ratio estimator, which applies in the focus.
            let spread = if in_focus.contains(side) && lines >= 2.0 {
                (squares[band] - brought * brought / lines).max(0.0) * lines / (lines - 1.0)
            } else {
                squares[band]
            };
            variance[band] = (f64::from(variance[band]) + factor * factor * spread) as f32;
        }
        power[side.index()] += estimate;
    });
}
