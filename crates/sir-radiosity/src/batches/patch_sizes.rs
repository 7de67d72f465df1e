//! The number of lines that cross a typical patch.

use sir_lines::GlobalLines;

use crate::focus_sides::FocusSides;
use crate::model::Model;
use crate::workers::{OneWorker, Workers, map_sides, no_items};

/// Returns the expected number of global lines, of `lines`, that cross a typical patch in the focus; in the scene, if
/// there is no focus. Patches are weighted by area.
#[must_use]
pub fn crossings_per_patch(model: &Model, domain: &GlobalLines, lines: u64) -> f64 {
    let focus_sides = FocusSides::of(model, domain.focus());
    lines as f64 / PatchSizes::of(model, &focus_sides, &OneWorker).lines_per_crossing(domain, lines)
}

/// Sums over patch areas, for the number of lines that cross a typical patch.
pub(super) struct PatchSizes {
    /// Sum of the areas of the sides in the focus; of all sides, if there are none in the focus.
    area: f64,
    /// Sum of the squares of these areas.
    square: f64,
}

impl PatchSizes {
    pub(super) fn of(model: &Model, focus_sides: &FocusSides, workers: &dyn Workers) -> Self {
        let all = focus_sides.is_empty();
        let sums = map_sides(workers, &model.mesh, no_items(), |sides, ()| {
            let mut sizes = Self { area: 0.0, square: 0.0 };
            for (triangle, side) in sides.iter().filter(|(_, side)| all || focus_sides.contains(*side)) {
                let area = model.area(triangle, side);
                sizes.area += area;
                sizes.square += area * area;
            }
            sizes
        });
        Self {
            area: sums.iter().map(|sizes| sizes.area).sum(),
            square: sums.iter().map(|sizes| sizes.square).sum(),
        }
    }

    /// Returns the number of lines that cross a typical patch once. Patches are weighted by area.
    pub(super) fn lines_per_crossing(&self, domain: &GlobalLines, lines: u64) -> f64 {
        domain.forecast(lines).surface * self.area / (2.0 * self.square)
    }
}
