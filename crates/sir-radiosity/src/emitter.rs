//! Where the lines of a source come from.
//!
//! All have the density of the source's radiance over points and directions, so that each carries the same power.

use glam::DVec3;
use sir_accel::Ray;
use sir_geom::{Barycentric, BoundingBox, Line, Scene, Side, Sky, Spread, TriangleId};
use sir_lines::{
    Domain, ParallelLines, Stream, cosine_direction, point_on_triangle, spot_direction, unit_vector,
};
use sir_mesh::PatchId;

/// What a source is.
///
/// Light from outside is let in through the axis-aligned box around the scene; lines that meet nothing in there are booked as
/// *escaped*. Uniform lines through the box, of which those are kept that the sky sends, have the density of its radiance. With a focus there are
/// two sources of each light from outside: what passes `through` a smaller box, and what passes `around` it.
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
    Distant {
        /// The lines through a box.
        lines: ParallelLines,
        /// Those that meet this box do not count.
        around: Option<BoundingBox>,
    },
    /// The scene's sky, above the horizon.
    Dome(SkyAperture),
    /// The ground of the scene's sky.
    Ground(SkyAperture),
}

/// Where light from the sky is let in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkyAperture {
    /// What its lines pass through.
    pub through: BoundingBox,
    /// Those that meet this box do not count.
    pub around: Option<BoundingBox>,
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
                let line = Line { origin, direction: cosine_direction(*normal, stream.point()) };
                Ray::leaving(line, *triangle)
            }
            Self::Point { position, spread } => {
                let direction = match *spread {
                    Spread::Isotropic => unit_vector(stream.point()),
                    Spread::Lambertian { axis } => cosine_direction(axis, stream.point()),
                    Spread::Spot { axis, inner, outer } => spot_direction(axis, inner, outer, stream.point()),
                };
                Line { origin: *position, direction }.into()
            }
            Self::Distant { lines, around } => loop {
                let line = lines.line(stream.point());
                if !around.is_some_and(|bounds| bounds.meets(&line)) {
                    break from_outside(scene, lines.bounds(), line);
                }
            },
            Self::Dome(aperture) => from_sky(scene, aperture, stream, Sky::share),
            Self::Ground(aperture) => from_sky(scene, aperture, stream, |sky, towards| {
                f64::from(u8::from(towards.dot(sky.up()) <= 0.0))
            }),
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
    let mut point = point_on_triangle(stream.point()).point(part);
    if scene.is_transparent(triangle) {
        let corners = scene.corners(triangle);
        for _ in 0..TRIES {
            if stream.unit() < scene.opacity_at(triangle, Barycentric::of(point, corners)) {
                break;
            }
            point = point_on_triangle(stream.point()).point(part);
        }
    }
    point
}

/// A ray from the sky: a uniform one through an aperture that was kept with the probability `share`.
fn from_sky(
    scene: &Scene,
    aperture: &SkyAperture,
    stream: &mut Stream,
    share: impl Fn(&Sky, DVec3) -> f64,
) -> Ray {
    let bounds = Domain::Box(aperture.through);
    loop {
        let line = bounds.line(stream.point());
        if aperture.around.is_some_and(|around| around.meets(&line)) {
            continue;
        }
        // Only a scene with a sky has such sources.
        if scene.sky().is_none_or(|sky| stream.unit() < share(sky, -line.direction)) {
            break from_outside(scene, aperture.through, line);
        }
    }
}

/// The ray of a line that begins where it enters a box: that of the scene, or one in it.
fn from_outside(scene: &Scene, through: BoundingBox, line: Line) -> Ray {
    let bounds = scene.bounding_box();
    let entry = if through == bounds { 0.0 } else { entry(bounds, &line) };
    let back = entry + OUTSIDE * scene.bounding_sphere().radius;
    Line { origin: line.origin - back * line.direction, ..line }.into()
}

/// How far it is from a point in a box back to where its line has entered the box.
fn entry(bounds: BoundingBox, line: &Line) -> f64 {
    let of = |axis: usize| {
        let (to_min, to_max) = (line.origin[axis] - bounds.min[axis], line.origin[axis] - bounds.max[axis]);
        match line.direction[axis] {
            d if d > 0.0 => to_min / d,
            d if d < 0.0 => to_max / d,
            _ => f64::INFINITY,
        }
    };
    of(0).min(of(1)).min(of(2)).max(0.0)
}
