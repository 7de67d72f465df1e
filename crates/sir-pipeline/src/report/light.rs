//! Report of the light so far, and its error.

use sir_geom::Rgb;
use sir_mesh::SideId;
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
    let Deviation { area, sum, square } = Deviation::of(model, inside, solution);
    std::array::from_fn(|k| if sum[k] > 0.0 { (square[k] * area).sqrt() / sum[k] } else { 0.0 })
}

/// Sums over the patches in the focus.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Deviation {
    /// Area \[m²\].
    area: f64,
    /// Irradiance times area \[W\].
    sum: Rgb,
    /// Squared standard error times area.
    square: Rgb,
}

impl Deviation {
    /// Returns the sums over a solution.
    pub(crate) fn of(model: &Model, inside: &FocusSides, solution: &Solution) -> Self {
        Self::on(model, |side| inside.contains(side), solution)
    }

    /// Returns the sums over some of the sides of a solution.
    pub(crate) fn on(model: &Model, is_counted: impl Fn(SideId) -> bool, solution: &Solution) -> Self {
        let (mut area, mut sum, mut square) = (0.0, Rgb::ZERO, Rgb::ZERO);
        model.mesh.for_each_side(|triangle, _, _, side| {
            if !is_counted(side) {
                return;
            }
            let a = model.area(triangle, side);
            let error = solution.error[side.index()];
            area += a;
            sum += a * solution.irradiance[side.index()];
            square += a * error * error;
        });
        Self { area, sum, square }
    }

    /// Returns the squared errors of a solution that two independent ones show together, on some of the sides. The light is
    /// left out.
    pub(crate) fn between(
        model: &Model,
        on: impl Fn(SideId) -> bool,
        one: &Solution,
        other: &Solution,
    ) -> Self {
        let mut square = Rgb::ZERO;
        model.mesh.for_each_side(|triangle, _, _, side| {
            if on(side) {
                let difference = one.irradiance[side.index()] - other.irradiance[side.index()];
                square += 0.5 * model.area(triangle, side) * difference * difference;
            }
        });
        Self { square, ..Self::default() }
    }

    /// Returns these sums times a factor.
    pub(crate) fn times(self, factor: f64) -> Self {
        Self { area: factor * self.area, sum: factor * self.sum, square: factor * self.square }
    }

    /// Returns the relative variance that has been added since an earlier stage, as a share of the light at the end, in the
    /// mean over the bands with light. It is not negative.
    pub(crate) fn relative_variance_beyond(&self, before: &Self, end: &Self) -> f64 {
        let of_band = |k: usize| {
            let sum = end.sum[k];
            (sum > 0.0).then(|| (self.square[k] - before.square[k]).max(0.0) * end.area / (sum * sum))
        };
        let bands: Vec<f64> = (0..3).filter_map(of_band).collect();
        bands.iter().sum::<f64>() / bands.len().max(1) as f64
    }
}
