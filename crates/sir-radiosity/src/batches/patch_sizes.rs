//! The number of lines that cross a typical patch.

use sir_lines::GlobalLines;

use crate::focus_sides::FocusSides;
use crate::model::Model;

/// Returns the expected number of global lines, of `lines`, that cross a typical patch in the focus; in the scene, if
/// there is no focus. Patches are weighted by area.
#[must_use]
pub fn crossings_per_patch(model: &Model, domain: &GlobalLines, lines: u64) -> f64 {
    let focus_sides = FocusSides::of(model, domain.focus());
    lines as f64 / PatchSizes::of(model, &focus_sides).lines_per_crossing(domain, lines)
}

/// Sums over patch areas, for the number of lines that cross a typical patch.
pub(super) struct PatchSizes {
    /// Sum of the areas of the sides in the focus; of all sides, if there are none in the focus.
    area: f64,
    /// Sum of the squares of these areas.
    square: f64,
}

impl PatchSizes {
    pub(super) fn of(model: &Model, focus_sides: &FocusSides) -> Self {
        let mut sizes = Self { area: 0.0, square: 0.0 };
        model.mesh.for_each_side(|triangle, _, _, side| {
            if focus_sides.contains(side) || focus_sides.is_empty() {
                let area = model.area(triangle, side);
                sizes.area += area;
                sizes.square += area * area;
            }
        });
        sizes
    }

    /// Returns the number of lines that cross a typical patch once. Patches are weighted by area.
    pub(super) fn lines_per_crossing(&self, domain: &GlobalLines, lines: u64) -> f64 {
        domain.forecast(lines).surface * self.area / (2.0 * self.square)
    }
}
