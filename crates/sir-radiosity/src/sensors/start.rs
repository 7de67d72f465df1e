//! Start of the rays of a sensor.

use glam::DVec3;
use sir_accel::{Ray, Tracer, TriangleId};
use sir_geom::Line;

use crate::model::Model;
use crate::sensors::sensor::Sensor;

/// Largest distance of a sensor below the surface on which it lies, in contact distances of the surface.
const MAX_DEPTH: f64 = 10.0;

/// The same in coordinates of the sensor: its position may be given to five digits.
const ROUNDING: f64 = 1.0 / (1u64 << 17) as f64;

/// Largest coordinate that counts in the rounding of the position of a light, in distances from the light.
const MAX_COORDINATE: f64 = 64.0;

/// Steps of the grid of the acceleration structure by which hits may be displaced.
const STEPS: f64 = 8.0;

/// Start of the rays of a sensor: its position, or the point of a surface on which it lies.
///
/// The positions of sensors and of surfaces are rounded, so a sensor may be just below the surface on which it is meant
/// to lie. A surface counts as this one if the normal of the sensor hits it behind the sensor within the contact distance
/// of the surface, or in front of the sensor within ten of them and 2⁻¹⁷ of the coordinates of the sensor. Rays leave
/// this surface as light does, and surfaces farther away do not matter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorStart {
    /// Point at which rays start.
    pub origin: DVec3,
    /// Triangle that contains this point; `None` if the sensor lies on no surface.
    pub surface: Option<TriangleId>,
}

impl SensorStart {
    /// Returns the start of the rays of a sensor.
    #[must_use]
    pub fn of(sensor: &Sensor, model: &Model, tracer: &mut Tracer<'_>) -> Self {
        let accel = &model.accel;
        let line = Line { origin: sensor.position(), direction: sensor.direction() };
        let rounding = ROUNDING * sensor.position().abs().max_element();
        let hits = tracer.all_hits(&line);
        let is_close = |t: f64, triangle: TriangleId| {
            accel.contact_distance(triangle).is_some_and(|distance| {
                -distance <= t && t <= distance.max(rounding.min(MAX_DEPTH * distance))
            })
        };
        let close = hits.iter().filter(|hit| is_close(hit.t, hit.triangle));
        let Some(nearest) = close.min_by(|a, b| a.t.abs().total_cmp(&b.t.abs())) else {
            return Self { origin: line.origin, surface: None };
        };
        // The topmost of the surfaces in contact.
        let is_with =
            |triangle| triangle == nearest.triangle || accel.are_in_contact(triangle, nearest.triangle);
        let top = hits.iter().rfind(|hit| is_with(hit.triangle)).unwrap_or(nearest);
        Self { origin: line.at(top.t), surface: Some(top.triangle) }
    }

    /// Returns the ray that starts here in a direction.
    #[inline]
    #[must_use]
    pub fn ray(&self, direction: DVec3) -> Ray {
        Ray { leaving: self.surface, ..Ray::new(Line { origin: self.origin, direction }) }
    }

    /// Returns the ray from here to a light without a surface in a direction. The light may lie on a surface, in front
    /// of it.
    pub(super) fn ray_to_light(&self, direction: DVec3, distance: f64, model: &Model) -> Ray {
        let coordinate = (self.origin + distance * direction).abs().max_element();
        let rounding = ROUNDING * coordinate.min(MAX_COORDINATE * distance) + STEPS * model.accel.grid_step();
        let end = if distance.is_finite() { distance - rounding } else { distance };
        self.ray(direction).within(0.0..end)
    }
}
