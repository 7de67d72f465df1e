//! What is solved: a scene, its patches, and the means to trace lines through it.

use sir_accel::{Accel, AccelError};
use sir_geom::{BoundingBox, Rgb, Scene, Side, TriangleId};
use sir_mesh::{MeshError, PatchId, PatchMesh, SideId, Subdivision};
use thiserror::Error;

use crate::build_accel::build_accel;

/// The reason why a scene cannot be prepared.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ModelError {
    /// The triangles cannot be cut into patches.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// The triangles cannot be arranged for tracing.
    #[error(transparent)]
    Accel(#[from] AccelError),
}

/// A scene, cut into patches and ready for lines. Immutable, and shared by all who trace.
#[derive(Clone, Debug)]
pub struct Model {
    /// The surfaces.
    pub scene: Scene,
    /// Their patches.
    pub mesh: PatchMesh,
    /// The same triangles, arranged for tracing.
    pub accel: Accel,
}

impl Model {
    /// Cuts a scene into patches and prepares it for tracing.
    ///
    /// # Errors
    ///
    /// If the subdivision is impossible, or the triangles cannot be arranged for tracing.
    pub fn new(scene: Scene, subdivision: Subdivision) -> Result<Self, ModelError> {
        Self::within(scene, subdivision, None)
    }

    /// As [`new`](Self::new), but triangles whose box does not meet this one, if there is one, are not cut.
    ///
    /// # Errors
    ///
    /// If the subdivision is impossible, or the triangles cannot be arranged for tracing.
    pub fn within(
        scene: Scene,
        subdivision: Subdivision,
        bounds: Option<BoundingBox>,
    ) -> Result<Self, ModelError> {
        let mesh = PatchMesh::within(&scene, subdivision, bounds)?;
        let accel = build_accel(&scene)?;
        Ok(Self { scene, mesh, accel })
    }

    /// Reflectance of the patch to which a side belongs; `id` must be a side of a patch of `triangle`, here and in the functions below.
    #[inline]
    #[must_use]
    pub fn reflectance(&self, triangle: TriangleId, id: SideId) -> Rgb {
        if self.mesh.is_varied(triangle) {
            self.mesh.reflectance(&self.scene, triangle, self.mesh.patch_of_side(triangle, id))
        } else {
            self.scene.material(triangle).reflectance
        }
    }

    /// Area of the patch to which a side belongs, without its gaps: what power is divided by. It may be zero.
    #[inline]
    #[must_use]
    pub fn area(&self, triangle: TriangleId, id: SideId) -> f64 {
        if self.mesh.is_varied(triangle) {
            self.mesh.covered_area(triangle, self.mesh.patch_of_side(triangle, id))
        } else {
            self.mesh.patch_area(triangle)
        }
    }

    /// The exitance `M` \[W/m²\] of a side of a patch.
    #[must_use]
    pub fn exitance(&self, triangle: TriangleId, patch: PatchId, side: Side) -> Rgb {
        self.mesh.exitance(&self.scene, triangle, patch, side)
    }

    /// The radiosity `B = M + ρ E` \[W/m²\] under the irradiance `E` \[W/m²\]; `side` must be the one with the number `id`.
    #[must_use]
    pub fn radiosity(&self, triangle: TriangleId, side: Side, id: SideId, irradiance: Rgb) -> Rgb {
        let patch = self.mesh.patch_of_side(triangle, id);
        self.exitance(triangle, patch, side) + self.reflectance(triangle, id) * irradiance
    }
}
