//! Emitters, which generate the lines of sources.
//!
//! Lines are distributed in proportion to the radiance of the source over points and directions, so that each carries
//! the same power.

use glam::DVec3;
use sir_accel::Ray;
use sir_geom::{Barycentric, BoundingBox, Line, Scene, Side, Sky, Spread, TriangleId};
use sir_lines::{
    Domain, Numbers, ParallelLines, continuous_point_on_triangle, cosine_direction, spot_direction,
    unit_vector,
};
use sir_mesh::PatchId;

/// Kind and geometry of a source.
///
/// Light from outside enters through the axis-aligned box around the scene. Lines that hit nothing in the box are
/// counted as *escaped*. Lines of the sky are uniform lines through the box that are accepted in proportion to the
/// radiance of the sky. With a focus, each light from outside is two sources: what passes `through` a smaller box, and
/// what passes `around` it.
#[derive(Clone, Debug, PartialEq)]
pub enum Emitter {
    /// A side of a triangle or of a part of it.
    Surface {
        /// The triangle.
        triangle: TriangleId,
        /// The patch of the triangle; `None` for the whole triangle.
        patch: Option<PatchId>,
        /// Side that emits.
        side: Side,
        /// Corners of the part that emits.
        corners: [DVec3; 3],
        /// Unit normal on the emitting side.
        normal: DVec3,
    },
    /// A point light.
    Point {
        /// Position of the light.
        position: DVec3,
        /// Angular distribution of its intensity.
        spread: Spread,
    },
    /// Parallel light.
    Distant {
        /// The lines through a box.
        lines: ParallelLines,
        /// Box that the lines must not meet; `None` for no such box.
        around: Option<BoundingBox>,
    },
    /// The scene's sky, above the horizon.
    Dome(SkyAperture),
    /// The ground of the scene's sky.
    Ground(SkyAperture),
}

/// The opening through which light from the sky enters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkyAperture {
    /// Box through which the lines pass.
    pub through: BoundingBox,
    /// Box that the lines must not meet; `None` for no such box.
    pub around: Option<BoundingBox>,
}

/// Distance outside the box at which lines from outside begin, in radii of the scene, so that a surface in a face of
/// the box is hit.
const OUTSIDE: f64 = 0.25;

/// Distance from a point light within which its rays meet nothing, in its largest coordinate: positions may be given to
/// five digits.
const ROUNDING: f64 = 1.0 / (1u64 << 17) as f64;

impl Emitter {
    /// Returns the ray that belongs to the numbers of a line. The first four are the most important ones: they choose a
    /// point and a direction.
    #[inline]
    #[must_use]
    pub fn ray(&self, scene: &Scene, numbers: &mut impl Numbers) -> Ray {
        match self {
            Self::Surface { triangle, corners, normal, .. } => {
                let origin = point_on_surface(scene, *triangle, *corners, numbers);
                let direction = match &scene.material(*triangle).beam {
                    None => cosine_direction(*normal, numbers.point()),
                    Some(beam) => beam.sample(|| numbers.unit()),
                };
                let line = Line { origin, direction };
                Ray::leaving(line, *triangle)
            }
            Self::Point { position, spread } => {
                let direction = match *spread {
                    Spread::Tabulated(ref tabulated) => tabulated.sample(numbers.point()),
                    Spread::Isotropic => unit_vector(numbers.point()),
                    Spread::Lambertian { axis } => cosine_direction(axis, numbers.point()),
                    Spread::Spot { axis, inner, outer } => {
                        spot_direction(axis, inner, outer, numbers.point())
                    }
                };
                // A lamp in a surface, or just below it for rounding, sends light to both sides.
                let start = ROUNDING * position.abs().max_element();
                Ray::new(Line { origin: *position, direction }).within(start..f64::INFINITY)
            }
            Self::Distant { lines, around } => loop {
                let line = lines.line(numbers.point());
                if !around.is_some_and(|bounds| bounds.meets(&line)) {
                    break from_outside(scene, lines.bounds(), line);
                }
            },
            Self::Dome(aperture) => from_sky(scene, aperture, numbers, Sky::share),
            Self::Ground(aperture) => from_sky(scene, aperture, numbers, |sky, towards| {
                f64::from(u8::from(towards.dot(sky.up()) <= 0.0))
            }),
        }
    }
}

/// Largest number of attempts to draw a point that is not in a gap.
pub(crate) const MAX_TRIES: u32 = 1000;

/// Returns a uniform random point of the covered area of a part of a triangle.
pub(crate) fn point_on_surface(
    scene: &Scene,
    triangle: TriangleId,
    part: [DVec3; 3],
    numbers: &mut impl Numbers,
) -> DVec3 {
    let mut point = continuous_point_on_triangle(numbers.point()).point(part);
    if scene.is_transparent(triangle) {
        let corners = scene.corners(triangle);
        for _ in 0..MAX_TRIES {
            if numbers.unit() < scene.opacity_at(triangle, Barycentric::of(point, corners)) {
                break;
            }
            point = continuous_point_on_triangle(numbers.point()).point(part);
        }
    }
    point
}

/// Returns a ray from the sky: a uniform line through an aperture, accepted with the probability `share`.
fn from_sky(
    scene: &Scene,
    aperture: &SkyAperture,
    numbers: &mut impl Numbers,
    share: impl Fn(&Sky, DVec3) -> f64,
) -> Ray {
    let bounds = Domain::Box(aperture.through);
    loop {
        let line = bounds.line(numbers.point());
        if aperture.around.is_some_and(|around| around.meets(&line)) {
            continue;
        }
        // Only a scene with a sky has such sources.
        if scene.sky().is_none_or(|sky| numbers.unit() < share(sky, -line.direction)) {
            break from_outside(scene, aperture.through, line);
        }
    }
}

/// Returns the ray of a line that begins where it enters `through`, which is the box of the scene or a box in it. The
/// ray begins outside the box of the scene.
fn from_outside(scene: &Scene, through: BoundingBox, line: Line) -> Ray {
    let bounds = scene.bounding_box();
    let entry = if through == bounds { 0.0 } else { entry(bounds, &line) };
    let back = entry + OUTSIDE * scene.bounding_sphere().radius;
    Line { origin: line.origin - back * line.direction, ..line }.into()
}

/// Returns the distance from the origin of a line, which lies in a box, back to where the line enters that box.
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
