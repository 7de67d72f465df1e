//! A side of a patch, from which local lines start.

use glam::DVec3;
use sir_geom::{Side, TriangleId};
use sir_mesh::PatchId;

use crate::emitter::Emitter;
use crate::model::Model;

/// A side of the part of a patch that lies in one of its triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PatchSide {
    /// The triangle.
    pub triangle: TriangleId,
    /// The patch.
    pub patch: PatchId,
    /// The side.
    pub side: Side,
}

impl PatchSide {
    /// Returns the emitter of lines from this side.
    #[inline]
    #[must_use]
    pub fn emitter(self, model: &Model) -> Emitter {
        let Self { triangle, patch, side } = self;
        let corners = model.scene.corners(triangle);
        let corners: [DVec3; 3] = model.mesh.patch_corners(triangle, patch).map(|b| b.point(corners));
        let normal = match side {
            Side::Front => model.scene.normal(triangle),
            Side::Back => -model.scene.normal(triangle),
        };
        Emitter::Surface { triangle, patch: Some(patch), side, corners, normal }
    }
}
