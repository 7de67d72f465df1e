//! What is solved: a scene, its patches, and the means to trace lines through it.

use sir_accel::Accel;
use sir_geom::{Rgb, Scene, Side, TriangleId};
use sir_mesh::{MeshError, PatchMesh, Subdivision};

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
    /// If the subdivision is impossible.
    pub fn new(scene: Scene, subdivision: Subdivision) -> Result<Self, MeshError> {
        let mesh = PatchMesh::new(&scene, subdivision)?;
        let accel = Accel::new(&scene);
        Ok(Self { scene, mesh, accel })
    }

    /// The radiosity `B = M + ρ E` \[W/m²\] of a side of a triangle under the irradiance `E` \[W/m²\].
    #[must_use]
    pub fn radiosity(&self, triangle: TriangleId, side: Side, irradiance: Rgb) -> Rgb {
        self.scene.exitance(triangle, side) + self.scene.material(triangle).reflectance * irradiance
    }
}
