//! The ratio estimator: the power that counted lines have brought, corrected for their number.

use sir_geom::TriangleId;
use sir_lines::GlobalLines;
use sir_mesh::SideId;

use crate::focus_sides::FocusSides;
use crate::model::Model;
use crate::power::Quanta;

/// What lines have brought to a side, and how many have crossed it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CountedPower {
    /// Power.
    pub power: Quanta,
    /// Number of lines, counted by their weights.
    pub crossings: u64,
}

/// What the lines of a transport have brought to all sides, and how many have crossed them.
#[derive(Clone, Debug)]
pub struct Counted {
    /// Domain through which the lines were drawn.
    pub domain: GlobalLines,
    /// Number of lines.
    pub lines: u64,
    /// Power and crossings, indexed by [`SideId`].
    pub sides: Vec<CountedPower>,
    /// Common factors that make the total received power equal to the total sent, per band.
    pub scale: [f64; 3],
}

/// Returns the factor of the ratio estimator, `λ/((1 − e^−λ) C)` for `λ` expected and `C` actual crossings; 1 if no line
/// crossed.
pub(crate) fn ratio(expected: f64, crossings: f64) -> f64 {
    // `f64::exp_m1` differs between platforms.
    if crossings == 0.0 { 1.0 } else { expected / -libm::expm1(-expected) / crossings }
}

/// Returns the common factors that make the total power the same with and without the ratio estimator. `of` returns the
/// power of a side and its factor.
pub(crate) fn common_scale(
    model: &Model,
    in_focus: &FocusSides,
    of: impl Fn(TriangleId, SideId) -> ([f64; 3], f64),
) -> [f64; 3] {
    let (mut plain, mut corrected) = ([0.0; 3], [0.0; 3]);
    model.mesh.for_each_side(|triangle, _, _, side| {
        if in_focus.contains(side) {
            let (power, factor) = of(triangle, side);
            for band in 0..3 {
                plain[band] += power[band];
                corrected[band] += factor * power[band];
            }
        }
    });
    [0, 1, 2].map(|band| if corrected[band] > 0.0 { plain[band] / corrected[band] } else { 1.0 })
}

impl Counted {
    /// Returns the estimate of the power that lines have brought to a side in the focus; for other sides, the power
    /// itself, because lines of different weights are not equivalent.
    #[must_use]
    pub fn estimate(
        &self,
        model: &Model,
        in_focus: &FocusSides,
        triangle: TriangleId,
        side: SideId,
    ) -> Quanta {
        let CountedPower { power, crossings } = self.sides[side.index()];
        if !in_focus.contains(side) {
            return power;
        }
        let expected = self.domain.forecast(self.lines).crossings(model.area(triangle, side));
        let factor = ratio(expected, crossings as f64);
        Quanta([0, 1, 2].map(|band| (factor * self.scale[band] * power.0[band] as f64).round() as i64))
    }
}
