//! Surroundings of a probe: whether it lies on a surface, and how much it sees of the backs of surfaces.

use std::f64::consts::PI;

use glam::{DMat3, DVec3};
use sir_accel::{Ray, Tracer};
use sir_geom::Line;

use crate::model::Model;

/// Number of rays that find out how much of what a probe sees are backs of surfaces.
const VIEW_RAYS: u32 = 256;

/// Difference in azimuth of neighboring points of a spherical Fibonacci lattice \[rad\]: the golden angle.
const GOLDEN_ANGLE: f64 = 2.399_963_229_728_653;

/// Least clearance, in steps of the grid of the acceleration structure, by which surfaces may be displaced.
const MIN_STEPS: f64 = 8.0;

/// Returns the share of the surfaces that are seen from a position, by solid angle, that show their one-sided backs to
/// it: of 256 fixed rays, those that hit a back over those that hit anything; zero if none does. Returns `None` if there
/// is a surface within the distance `clearance` \[m\].
///
/// The share is 1 inside a closed solid and outside of a room without surroundings. In a room it is zero, except for
/// surfaces that show their backs to the room.
#[must_use]
pub fn share_of_backs(
    position: DVec3,
    clearance: f64,
    model: &Model,
    tracer: &mut Tracer<'_>,
) -> Option<f64> {
    if is_near_surface(position, clearance, model, tracer) {
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
    let (mut hits, mut backs) = (0u32, 0u32);
    tracer.closest_each(&rays, |_, hit| {
        let Some(hit) = hit else { return };
        hits += 1;
        backs += u32::from(!model.scene.is_active(hit.triangle, hit.side));
    });
    Some(f64::from(backs) / f64::from(hits.max(1)))
}

/// Returns true if a surface crosses an edge of an icosahedron with this radius around a position.
///
/// A surface that contains the position does so if it takes more than the angle of an edge around it, 63°: faces, edges
/// and the corners of rectangles.
fn is_near_surface(position: DVec3, clearance: f64, model: &Model, tracer: &mut Tracer<'_>) -> bool {
    /// Coordinates of the corners besides zero, for edges of length 2: 1 and the golden ratio.
    const GOLDEN: f64 = 1.618_033_988_749_895;
    // Edges are parallel to no edge of a room.
    let turn = DMat3::from_cols_array(&[2.0, -2.0, 1.0, 1.0, 2.0, 2.0, 2.0, 1.0, -2.0].map(|x| x / 3.0));
    let signs = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)];
    let corners = signs.into_iter().flat_map(|(a, b)| {
        let (a, b) = (a, b * GOLDEN);
        [DVec3::new(0.0, a, b), DVec3::new(a, b, 0.0), DVec3::new(b, 0.0, a)]
    });
    let corners: Vec<DVec3> = corners.map(|corner| turn * corner).collect();
    let scale = clearance.max(MIN_STEPS * model.accel.grid_step()) / corners[0].length();
    let mut edges = Vec::with_capacity(30);
    for (i, a) in corners.iter().enumerate() {
        for b in corners[..i].iter().filter(|b| a.distance_squared(**b) < 5.0) {
            let line = Line { origin: position + scale * *a, direction: 0.5 * (b - a) };
            edges.push(Ray::new(line).within(0.0..2.0 * scale));
        }
    }
    let mut is_near = false;
    tracer.occluded_each(&edges, |_, is_occluded| is_near |= is_occluded);
    is_near
}
