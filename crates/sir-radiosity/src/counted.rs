//! The ratio estimator: the power that counted lines have brought, corrected for their number.

use sir_geom::TriangleId;
use sir_lines::GlobalLines;
use sir_mesh::SideId;

use crate::focus_sides::FocusSides;
use crate::model::Model;
use crate::power::Quanta;
use crate::received::Received;
use crate::workers::{BLOCK, Workers, map_sides, no_items};

/// What lines have brought to a side, and how many have crossed it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CountedPower {
    /// Power.
    pub power: Quanta,
    /// Number of lines, counted by their weights.
    pub crossings: u64,
    /// Variance of the power per band \[quanta²\]; in the focus, that for the given number of lines.
    pub variance: [f32; 3],
}

/// What the lines of a transport have brought to all sides, and how many have crossed them.
#[derive(Clone, Debug)]
pub struct Counted {
    /// Domain through which the lines were drawn.
    pub domain: GlobalLines,
    /// Number of lines.
    pub lines: u64,
    /// Sides in the focus. For other sides there is no correction, because lines of different weights are not equivalent.
    pub focus_sides: FocusSides,
    /// Power and crossings, indexed by [`SideId`].
    pub sides: Vec<CountedPower>,
}

/// Returns the factor of the ratio estimator, `λ/((1 − e^−λ) C)` for `λ` expected and `C` actual crossings; 1 if no line
/// crossed.
pub(crate) fn ratio(expected: f64, crossings: f64) -> f64 {
    if crossings == 0.0 {
        return 1.0;
    }
    // `f64::exp_m1` differs between platforms. Beyond 40, the probability of a crossing rounds to 1.
    let met = if expected > 40.0 { 1.0 } else { -libm::expm1(-expected) };
    expected / met / crossings
}

/// Returns the common factors that make the total power of the sides in the focus the same with and without the ratio
/// estimator. `of` returns the power of a side and its factor.
pub(crate) fn common_scale(
    model: &Model,
    workers: &dyn Workers,
    focus_sides: &FocusSides,
    of: impl Fn(TriangleId, SideId) -> ([f64; 3], f64) + Sync,
) -> [f64; 3] {
    let sums = map_sides(workers, &model.mesh, no_items(), |sides, ()| {
        let (mut plain, mut corrected) = ([0.0; 3], [0.0; 3]);
        for (triangle, side) in sides.iter().filter(|(_, side)| focus_sides.contains(*side)) {
            let (power, factor) = of(triangle, side);
            for band in 0..3 {
                plain[band] += power[band];
                corrected[band] += factor * power[band];
            }
        }
        [plain, corrected]
    });
    let sum = |k: usize, band: usize| sums.iter().map(|block| block[k][band]).sum::<f64>();
    [0, 1, 2].map(|band| {
        let (plain, corrected) = (sum(0, band), sum(1, band));
        if corrected > 0.0 { plain / corrected } else { 1.0 }
    })
}

impl Counted {
    /// Returns the factor of the ratio estimator of a side in the focus.
    fn ratio(&self, model: &Model, triangle: TriangleId, side: SideId) -> f64 {
        let expected = self.domain.forecast(self.lines).crossings(model.area(triangle, side));
        ratio(expected, self.sides[side.index()].crossings as f64)
    }

    /// Adds the estimate of the power that lines have brought, and its variance.
    pub fn add_to(&self, received: &mut Received, model: &Model, workers: &dyn Workers) {
        let scale = common_scale(model, workers, &self.focus_sides, |triangle, side| {
            let power = self.sides[side.index()].power.0.map(|power| power as f64);
            (power, self.ratio(model, triangle, side))
        });
        let blocks = received.power.chunks_mut(BLOCK).zip(received.variance.chunks_mut(BLOCK));
        map_sides(workers, &model.mesh, blocks, |sides, (power, variance)| {
            for (((triangle, side), power), sum) in sides.iter().zip(power).zip(variance) {
                let CountedPower { power: brought, variance, .. } = self.sides[side.index()];
                let factor = match self.focus_sides.contains(side) {
                    true => scale.map(|scale| scale * self.ratio(model, triangle, side)),
                    false => [1.0; 3],
                };
                let estimate = |band: usize| (factor[band] * brought.0[band] as f64).round() as i64;
                *power += Quanta([0, 1, 2].map(estimate));
                for band in 0..3 {
                    sum[band] += (factor[band] * factor[band] * f64::from(variance[band])) as f32;
                }
            }
        });
    }
}
