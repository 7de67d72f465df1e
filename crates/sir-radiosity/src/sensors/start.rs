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

/// Least cosine between the directions of a sensor and of the surface on which it lies, for the sensor to measure what
/// arrives at that surface.
const ALIGNED: f64 = 0.999;

/// Most surfaces on which a sensor lies: three in a corner.
const MAX_SURFACES: usize = 3;

/// Distance of rays from a surface that is not aligned with the sensor, in distances up to which a sensor lies on it.
const ABOVE: f64 = 2.0;

/// Cosine below which a sensor is perpendicular to the normal of a surface.
const PERPENDICULAR: f64 = 1e-6;

/// Start of the rays of a sensor: its position, or the point of a surface on which it lies.
///
/// The positions of sensors and of surfaces are rounded, so a sensor may be just below the surface on which it is meant
/// to lie. A surface counts as this one if the normal of the sensor hits it behind the sensor within the contact distance
/// of the surface, or in front of the sensor within ten of them and 2⁻¹⁷ of the coordinates of the sensor. Rays leave
/// this surface as light does, and surfaces farther away do not matter.
///
/// A sensor may also lie on surfaces that face elsewhere, as an upright sensor on a floor does. It then sees these
/// surfaces, from twice the distances above. It is in front of those that it faces, and of the fronts of those that it
/// is perpendicular to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorStart {
    /// Point at which rays start.
    pub origin: DVec3,
    /// Triangle that contains this point; `None` if the sensor lies on no surface that is aligned with it.
    pub surface: Option<TriangleId>,
}

impl SensorStart {
    /// Returns the start of the rays of a sensor.
    #[must_use]
    pub fn of(sensor: &Sensor, model: &Model, tracer: &mut Tracer<'_>) -> Self {
        Self::at(sensor.position(), sensor.direction(), model, tracer)
    }

    /// Returns the start of the rays of a plane sensor with a unit normal.
    pub(super) fn at(position: DVec3, normal: DVec3, model: &Model, tracer: &mut Tracer<'_>) -> Self {
        let accel = &model.accel;
        let line = Line { origin: position, direction: normal };
        let hits = tracer.all_hits(&line);
        let is_close = |t: f64, triangle: TriangleId| {
            accel
                .contact_distance(triangle)
                .is_some_and(|distance| -distance <= t && t <= reach(distance, line.origin))
        };
        let close = hits.iter().filter(|hit| is_close(hit.t, hit.triangle));
        if let Some(nearest) = close.min_by(|a, b| a.t.abs().total_cmp(&b.t.abs())) {
            // The topmost of the surfaces in contact.
            let is_with =
                |triangle| triangle == nearest.triangle || accel.are_in_contact(triangle, nearest.triangle);
            let top = hits.iter().rfind(|hit| is_with(hit.triangle)).unwrap_or(nearest);
            if model.scene.normal(top.triangle).dot(normal).abs() > ALIGNED {
                return Self { origin: line.at(top.t), surface: Some(top.triangle) };
            }
        }
        Self { origin: above(line.origin, normal, model, tracer), surface: None }
    }

    /// Returns the ray that starts here in a direction.
    #[inline]
    #[must_use]
    pub fn ray(&self, direction: DVec3) -> Ray {
        Ray { leaving: self.surface, ..Ray::new(Line { origin: self.origin, direction }) }
    }

    /// Returns the ray from here to a light without a surface in a direction. The light may lie on a surface, in front
    /// of it.
    pub(crate) fn ray_to_light(&self, direction: DVec3, distance: f64, model: &Model) -> Ray {
        let coordinate = (self.origin + distance * direction).abs().max_element();
        let rounding = ROUNDING * coordinate.min(MAX_COORDINATE * distance) + STEPS * model.accel.grid_step();
        let end = if distance.is_finite() { distance - rounding } else { distance };
        self.ray(direction).within(0.0..end)
    }
}

/// Returns the distance up to which a position in front of a surface with this contact distance lies on it.
fn reach(contact_distance: f64, position: DVec3) -> f64 {
    let rounding = ROUNDING * position.abs().max_element();
    contact_distance.max(rounding.min(MAX_DEPTH * contact_distance))
}

/// Returns a position next to `position` that is in front of all surfaces on which that lies.
fn above(position: DVec3, direction: DVec3, model: &Model, tracer: &mut Tracer<'_>) -> DVec3 {
    // A plane through the position is hit by at least one of three perpendicular lines not far from it. They run along
    // no edge of a room.
    const LINES: [DVec3; 3] = [
        DVec3::new(2.0 / 3.0, -2.0 / 3.0, 1.0 / 3.0),
        DVec3::new(1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0),
        DVec3::new(2.0 / 3.0, 1.0 / 3.0, -2.0 / 3.0),
    ];
    let mut origin = position;
    for _ in 0..MAX_SURFACES {
        let mut moved = None;
        for axis in LINES {
            let line = Line { origin, direction: axis };
            for hit in tracer.all_hits(&line) {
                let Some(distance) = model.accel.contact_distance(hit.triangle) else { continue };
                let front = model.scene.normal(hit.triangle);
                // Where the surface is, seen from the position, along its front.
                let height = hit.t * axis.dot(front);
                let reach = reach(distance, position);
                if height.abs() > reach {
                    continue;
                }
                let cosine = direction.dot(front);
                let side = if cosine < -PERPENDICULAR { -front } else { front };
                let step = ABOVE * reach + side.dot(front) * height;
                if moved.is_none_or(|(most, _)| step > most) {
                    moved = Some((step, side));
                }
            }
        }
        let Some((step, side)) = moved else { break };
        origin += step * side;
    }
    origin
}
