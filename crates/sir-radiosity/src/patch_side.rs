//! A side of a patch, from which local lines start.

use glam::DVec3;
use sir_accel::Ray;
use sir_geom::{Barycentric, Line, Side, TriangleId};
use sir_lines::{Numbers, continuous_point_on_triangle, cosine_direction};
use sir_mesh::{PatchId, SideId};

use crate::emitter::MAX_TRIES;
use crate::model::Model;

/// A side of a patch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PatchSide {
    /// A triangle of the surface to which the patch belongs.
    pub triangle: TriangleId,
    /// The patch.
    pub patch: PatchId,
    /// The side.
    pub side: Side,
}

/// A point of a patch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PatchPoint {
    pub(crate) triangle: TriangleId,
    pub(crate) position: DVec3,
    /// Unit normal on the side of the patch.
    pub(crate) normal: DVec3,
}

impl PatchSide {
    /// Returns the place of a side of a patch of the surface of `triangle`.
    pub(crate) fn of(model: &Model, triangle: TriangleId, id: SideId) -> Self {
        let patch = model.mesh.patch_of_side(triangle, id);
        let is_front = model.mesh.side_of(triangle, patch, Side::Front) == Some(id);
        Self { triangle, patch, side: if is_front { Side::Front } else { Side::Back } }
    }

    /// Returns a uniform random point of the covered area of the patch. The first two numbers are the most important ones.
    #[inline]
    pub(crate) fn point(self, model: &Model, numbers: &mut impl Numbers) -> PatchPoint {
        let Model { scene, mesh, .. } = model;
        let draw = |[s, t]: [f64; 2]| {
            let (triangle, part, s) = mesh.random_part(self.triangle, self.patch, s);
            let corners = scene.corners(triangle);
            let position =
                continuous_point_on_triangle([s, t]).point(part.map(|corner| corner.point(corners)));
            (triangle, position)
        };
        let (mut triangle, mut position) = draw(numbers.point());
        for _ in 0..MAX_TRIES {
            if !scene.is_transparent(triangle)
                || numbers.unit()
                    < scene.opacity_at(triangle, Barycentric::of(position, scene.corners(triangle)))
            {
                break;
            }
            (triangle, position) = draw(numbers.point());
        }
        let front = scene.normal(triangle);
        let normal = if self.side == Side::Front { front } else { -front };
        PatchPoint { triangle, position, normal }
    }

    /// Returns the ray that belongs to the numbers of a line, the first four of which are the most important ones.
    #[inline]
    #[must_use]
    pub fn ray(self, model: &Model, numbers: &mut impl Numbers) -> Ray {
        let PatchPoint { triangle, position, normal } = self.point(model, numbers);
        let line = Line { origin: position, direction: cosine_direction(normal, numbers.point()) };
        Ray::leaving(line, triangle)
    }
}
