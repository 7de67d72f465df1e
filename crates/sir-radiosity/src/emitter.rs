//! Where the lines of a source come from.
//!
//! All have the density of the source's radiance over points and directions, so that each carries the same power.

use glam::DVec3;
use sir_accel::Ray;
use sir_geom::{Barycentric, Line, Scene, Side, Sky, Spread, TriangleId};
use sir_lines::{
    Domain, ParallelLines, Stream, cosine_direction, point_on_triangle, spot_direction, unit_vector,
};
use sir_mesh::PatchId;

/// What a source is.
///
/// Light from outside is let in through the axis-aligned box around the scene; lines that meet nothing in there are booked as
/// *escaped*. Uniform lines through the box, of which those are kept that the sky sends, have the density of its radiance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Emitter {
    /// A side of a triangle, or of a part of one.
    Surface {
        /// The triangle.
        triangle: TriangleId,
        /// The patch of it; `None` for all of it.
        patch: Option<PatchId>,
        /// Which side of it.
        side: Side,
        /// Corners of the part that emits.
        corners: [DVec3; 3],
        /// Unit normal on that side.
        normal: DVec3,
    },
    /// A point.
    Point {
        /// Where it is.
        position: DVec3,
        /// Where it sends its light.
        spread: Spread,
    },
    /// Parallel light.
    Distant(ParallelLines),
    /// The scene's sky, above the horizon.
    Dome,
    /// The ground of the scene's sky.
    Ground,
}

/// How far outside of the box lines from outside begin, in radii of the scene: a surface in a face of the box must be met.
const OUTSIDE: f64 = 0.25;

impl Emitter {
    /// A random ray.
    #[inline]
    pub(crate) fn ray(&self, scene: &Scene, stream: &mut Stream) -> Ray {
        match self {
            Self::Surface { triangle, corners, normal, .. } => {
                let origin = point_on_surface(scene, *triangle, *corners, stream);
                let line = Line { origin, direction: cosine_direction(*normal, stream) };
                Ray { line, leaving: Some(*triangle) }
            }
            Self::Point { position, spread } => {
                let direction = match *spread {
                    Spread::Isotropic => unit_vector(stream),
                    Spread::Lambertian { axis } => cosine_direction(axis, stream),
                    Spread::Spot { axis, inner, outer } => spot_direction(axis, inner, outer, stream),
                };
                Line { origin: *position, direction }.into()
            }
            Self::Distant(lines) => from_outside(scene, lines.sample(stream)),
            Self::Dome => from_sky(scene, stream, Sky::share),
            Self::Ground => {
                from_sky(scene, stream, |sky, towards| f64::from(u8::from(towards.dot(sky.up()) <= 0.0)))
            }
        }
    }
}

/// How often a point is drawn anew that lies in a gap.
const TRIES: u32 = 1000;

/// A uniform random point of what a part of a triangle covers.
pub(crate) fn point_on_surface(
    scene: &Scene,
    triangle: TriangleId,
    part: [DVec3; 3],
    stream: &mut Stream,
) -> DVec3 {
    let mut point = point_on_triangle(stream).point(part);
    if scene.lets_light_through(triangle) {
        let corners = scene.corners(triangle);
        for _ in 0..TRIES {
            if stream.unit() < scene.opacity_at(triangle, Barycentric::of(point, corners)) {
                break;
            }
            point = point_on_triangle(stream).point(part);
        }
    }
    point
}

/// A ray from the sky: a uniform one through the box that was kept with the probability `share`.
fn from_sky(scene: &Scene, stream: &mut Stream, share: impl Fn(&Sky, DVec3) -> f64) -> Ray {
    let bounds = Domain::Box(scene.bounding_box());
    loop {
        let line = bounds.sample(stream);
        // Only a scene with a sky has such sources.
        if scene.sky().is_none_or(|sky| stream.unit() < share(sky, -line.direction)) {
            break from_outside(scene, line);
        }
    }
}

/// The ray of a line that enters the box.
fn from_outside(scene: &Scene, line: Line) -> Ray {
    let back = OUTSIDE * scene.bounding_sphere().radius;
    Line { origin: line.origin - back * line.direction, ..line }.into()
}
