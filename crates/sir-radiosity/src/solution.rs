//! The result: irradiances with standard errors.

use sir_geom::{Rgb, Side, TriangleId};
use sir_mesh::SideId;

use crate::model::Model;
use crate::power::PowerUnit;
use crate::received::Received;

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
