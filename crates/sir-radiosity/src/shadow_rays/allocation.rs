//! How many points each side has.

use sir_geom::TriangleId;
use sir_mesh::SideId;

use crate::focus_sides::FocusSides;
use crate::model::Model;
use crate::shot::Shot;
use crate::workers::{Workers, map_sides, no_items};

/// Fewest and most points of a side. The spread of one point is not known.
pub(super) const POINTS: (u64, u64) = (2, 1 << 16);

/// How many points the sides have: two, and more in proportion to the root of the area times the irradiance by the lines of
/// the first shot, to which the mean is added. If the noise of one point is in proportion to the light, this has the smallest
/// area-weighted variance (Neyman 1934).
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PointAllocation {
    /// Mean irradiance \[quanta/m²\].
    mean: f64,
    /// Further points per weight.
    density: f64,
}

impl PointAllocation {
    /// Returns the allocation of `points` to the sides in the focus, whether all of these have rays or not.
    pub(super) fn new(
        model: &Model,
        in_focus: &FocusSides,
        shot: &Shot,
        points: u64,
        workers: &dyn Workers,
    ) -> Self {
        let sum = |of: &(dyn Fn(TriangleId, SideId) -> [f64; 2] + Sync)| {
            let blocks = map_sides(workers, &model.mesh, no_items(), |sides, ()| {
                let sides = sides.iter().filter(|(_, side)| in_focus.contains(*side));
                sides.map(|(triangle, side)| of(triangle, side)).fold([0.0; 2], add)
            });
            blocks.into_iter().fold([0.0; 2], add)
        };
        let [power, area] =
            sum(&|triangle, side| [shot.received.power[side.index()].total(), model.area(triangle, side)]);
        let mut all = Self { mean: if area > 0.0 { power / area } else { 0.0 }, density: 0.0 };
        let [count, weight] = sum(&|triangle, side| [1.0, all.weight(model, shot, triangle, side)]);
        let further = (points as f64 - POINTS.0 as f64 * count).max(0.0);
        all.density = if weight > 0.0 { further / weight } else { 0.0 };
        all
    }

    fn weight(&self, model: &Model, shot: &Shot, triangle: TriangleId, side: SideId) -> f64 {
        let area = model.area(triangle, side);
        if area > 0.0 {
            area.sqrt() * (shot.received.power[side.index()].total() / area + self.mean)
        } else {
            0.0
        }
    }

    /// Returns the number of points of a side.
    pub(super) fn points(&self, model: &Model, shot: &Shot, triangle: TriangleId, side: SideId) -> u64 {
        let further = self.density * self.weight(model, shot, triangle, side);
        (POINTS.0 + further as u64).min(POINTS.1)
    }
}

fn add([a, b]: [f64; 2], [c, d]: [f64; 2]) -> [f64; 2] {
    [a + c, b + d]
}
