//! The input of all stages: a scene, its patches, and an acceleration structure.

use std::sync::Arc;

use sir_accel::{Accel, AccelError};
use sir_geom::{BoundingBox, Dimming, Rgb, Scene, Side, TriangleId};
use sir_mesh::{MeshError, PatchId, PatchMesh, SideId, Subdivision};
use thiserror::Error;

use crate::build_accel::build_accel;

/// An error that prevents a scene from being prepared.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ModelError {
    /// The triangles cannot be cut into patches.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// The acceleration structure cannot be built.
    #[error(transparent)]
    Accel(#[from] AccelError),
}

/// A scene with its patches and its acceleration structure. Immutable, and shared by all workers. Copies share all but
/// materials, lights and sky.
#[derive(Clone, Debug)]
pub struct Model {
    /// The scene: surfaces, lights and sky.
    pub scene: Scene,
    /// Patches of the surfaces.
    pub mesh: Arc<PatchMesh>,
    /// Acceleration structure over the same triangles.
    pub accel: Arc<Accel>,
}

impl Model {
    /// Cuts a scene into patches and builds its acceleration structure.
    ///
    /// # Errors
    ///
    /// If the subdivision is impossible, or the acceleration structure cannot be built.
    pub fn new(scene: Scene, subdivision: Subdivision) -> Result<Self, ModelError> {
        Self::within(scene, subdivision, None)
    }

    /// Does the same as [`new`](Self::new), but does not cut triangles whose bounding box does not meet `bounds`, if
    /// given.
    ///
    /// # Errors
    ///
    /// If the subdivision is impossible, or the acceleration structure cannot be built.
    pub fn within(
        scene: Scene,
        subdivision: Subdivision,
        bounds: Option<BoundingBox>,
    ) -> Result<Self, ModelError> {
        let mesh = PatchMesh::within(&scene, subdivision, bounds)?.into();
        let accel = build_accel(&scene)?.into();
        Ok(Self { scene, mesh, accel })
    }

    /// Returns a copy with dimmed lights.
    #[must_use]
    pub fn dimmed(&self, dimming: &Dimming) -> Self {
        Self { scene: self.scene.dimmed(dimming), ..self.clone() }
    }

    /// Returns the reflectance of the patch to which a side belongs.
    ///
    /// Here and in the functions below, `id` must be a side of a patch of `triangle`.
    #[inline]
    #[must_use]
    pub fn reflectance(&self, triangle: TriangleId, id: SideId) -> Rgb {
        if self.mesh.is_varied(triangle) {
            self.mesh.reflectance(&self.scene, triangle, self.mesh.patch_of_side(triangle, id))
        } else {
            self.scene.material(triangle).reflectance
        }
    }

    /// Returns the covered area of the patch to which a side belongs, which excludes gaps. Power is divided by it. It
    /// may be zero.
    #[inline]
    #[must_use]
    pub fn area(&self, triangle: TriangleId, id: SideId) -> f64 {
        self.mesh.covered_area(triangle, self.mesh.patch_of_side(triangle, id))
    }

    /// Returns the exitance `M` \[W/m²\] of a side of a patch.
    #[must_use]
    pub fn exitance(&self, triangle: TriangleId, patch: PatchId, side: Side) -> Rgb {
        self.mesh.exitance(&self.scene, triangle, patch, side)
    }

    /// Returns the radiosity `B = M + ρ E` \[W/m²\] for the irradiance `E` \[W/m²\]. `side` must be the side with the
    /// number `id`.
    #[must_use]
    pub fn radiosity(&self, triangle: TriangleId, side: Side, id: SideId, irradiance: Rgb) -> Rgb {
        let patch = self.mesh.patch_of_side(triangle, id);
        self.exitance(triangle, patch, side) + self.reflectance(triangle, id) * irradiance
    }
}
