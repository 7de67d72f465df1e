//! The result: irradiances with standard errors.

use sir_geom::{Rgb, Side, TriangleId};
use sir_mesh::SideId;

use crate::model::Model;
use crate::power::PowerUnit;
use crate::received::Received;

/// Returns the standard error of a sum of two independent numbers, per band. An error of zero leaves the bits of the
/// other one.
#[must_use]
pub fn in_quadrature(a: Rgb, b: Rgb) -> Rgb {
    (a * a + b * b).map(f64::sqrt)
}

/// Irradiance of every side of every patch, with standard errors.
#[derive(Clone, Debug, PartialEq)]
pub struct Solution {
    /// Irradiance `E` per band \[W/m²\], indexed by [`SideId`].
    pub irradiance: Vec<Rgb>,
    /// Standard error of `irradiance` per band \[W/m²\], indexed by [`SideId`].
    pub error: Vec<Rgb>,
}

impl Solution {
    /// Returns a solution of this number of sides in which all irradiances are zero.
    #[must_use]
    pub fn dark(sides: usize) -> Self {
        Self { irradiance: vec![Rgb::ZERO; sides], error: vec![Rgb::ZERO; sides] }
    }

    /// Returns the irradiance of all sides: received power over covered area. `unit` is the unit of the power.
    #[must_use]
    pub fn new(model: &Model, received: &Received, unit: PowerUnit) -> Self {
        let sides = model.mesh.side_count();
        let mut solution = Self { irradiance: Vec::with_capacity(sides), error: Vec::with_capacity(sides) };
        model.mesh.for_each_side(|triangle, _, _, side| {
            let area = model.area(triangle, side);
            // No line ends on a patch without covered area.
            let per_area = if area > 0.0 { 1.0 / area } else { 0.0 };
            solution.irradiance.push(unit.watts(received.power[side.index()]) * per_area);
            let deviation = received.variance[side.index()].map(|v| f64::from(v).sqrt() * unit.quantum());
            solution.error.push(Rgb::from_array(deviation) * per_area);
        });
        solution
    }

    /// Adds an independent solution of the same sides, with its light times a factor per band. Variances add.
    pub fn add_dimmed(&mut self, other: &Self, factor: Rgb) {
        for (sum, more) in self.irradiance.iter_mut().zip(&other.irradiance) {
            *sum += factor * more;
        }
        for (sum, more) in self.error.iter_mut().zip(&other.error) {
            *sum = in_quadrature(*sum, factor * more);
        }
    }

    /// Returns the radiosity `B = M + ρ E` \[W/m²\]. `side` must be the side of `triangle` to which `id` belongs.
    #[must_use]
    pub fn radiosity(&self, model: &Model, triangle: TriangleId, side: Side, id: SideId) -> Rgb {
        model.radiosity(triangle, side, id, self.irradiance[id.index()])
    }

    /// Returns the standard error of the radiosity \[W/m²\]. `id` must be a side of a patch of `triangle`.
    #[must_use]
    pub fn standard_error(&self, model: &Model, triangle: TriangleId, id: SideId) -> Rgb {
        model.reflectance(triangle, id) * self.error[id.index()]
    }
}
