//! Report of the light so far, and its error.

use sir_geom::Rgb;
use sir_radiosity::{FocusSides, Model, Solution};

use crate::report::result::{ErrorsReport, LightReport};

impl LightReport {
    /// Creates the report. `tally_hash` is the hash of the received power from which the solution was made.
    pub(crate) fn new(
        model: &Model,
        inside: &FocusSides,
        solution: &Solution,
        errors: ErrorsReport,
        tally_hash: String,
    ) -> Self {
        Self { relative_error: relative_error(model, inside, solution), errors, tally_hash }
    }
}

/// Returns [`LightReport::relative_error`].
pub(crate) fn relative_error(model: &Model, inside: &FocusSides, solution: &Solution) -> [f64; 3] {
    let (mut area, mut sum, mut square) = (0.0, Rgb::ZERO, Rgb::ZERO);
    model.mesh.for_each_side(|triangle, _, _, side| {
        if !inside.contains(side) {
            return;
        }
        let a = model.area(triangle, side);
        let error = solution.error[side.index()];
        area += a;
        sum += a * solution.irradiance[side.index()];
        square += a * error * error;
    });
    std::array::from_fn(|k| if sum[k] > 0.0 { (square[k] * area).sqrt() / sum[k] } else { 0.0 })
}
