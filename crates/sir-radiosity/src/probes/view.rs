//! What a probe sees of the backs of surfaces.

use std::f64::consts::PI;

use glam::DVec3;
use sir_accel::{Ray, Tracer};
use sir_geom::Line;

use crate::model::Model;
use crate::sensors::is_on_surface;

/// Number of rays that decide how much of the view are backs of surfaces.
const VIEW_RAYS: u32 = 256;

/// Difference in azimuth of neighboring points of a spherical Fibonacci lattice \[rad\]: the golden angle.
const GOLDEN_ANGLE: f64 = 2.399_963_229_728_653;

/// Returns the share of all directions in which the back of a one-sided surface is seen from a position, by 256 fixed
/// rays. Returns `None` if the position lies on a surface.
///
/// Inside a closed solid it is 1. In a room it is zero, except for surfaces that show their backs to the room.
#[must_use]
pub fn share_of_backs(position: DVec3, model: &Model, tracer: &mut Tracer<'_>) -> Option<f64> {
    if is_on_surface(position, model, tracer) {
        return None;
    }
    // Spherical Fibonacci lattice (Marques et al. 2013): equal areas per point.
    let ray = |i: u32| {
        let z = 1.0 - (2.0 * f64::from(i) + 1.0) / f64::from(VIEW_RAYS);
        let (sin, cos) = libm::sincos((f64::from(i) * GOLDEN_ANGLE) % (2.0 * PI));
        let rho = (1.0 - z * z).sqrt();
        Ray::new(Line { origin: position, direction: DVec3::new(rho * cos, rho * sin, z) })
    };
    let rays: Vec<Ray> = (0..VIEW_RAYS).map(ray).collect();
    let mut backs = 0;
    tracer.closest_each(&rays, |_, hit| {
        backs += u32::from(hit.is_some_and(|hit| !model.scene.is_active(hit.triangle, hit.side)));
    });
    Some(f64::from(backs) / f64::from(VIEW_RAYS))
}
