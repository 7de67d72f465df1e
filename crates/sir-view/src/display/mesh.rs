//! The display mesh: patches cut so that they share all points, with irradiance at the points.

use std::sync::OnceLock;

use glam::DVec3;
use sir_geom::{Barycentric, Rgb, Scene, Side, TriangleId};
use sir_mesh::{PatchId, PatchMesh, SideId};

use crate::display::levels::Levels;

/// A vertex of a [`DisplayMesh`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DisplayVertex {
    /// Number of its position in [`DisplayMesh::positions`].
    pub position: u32,
    /// Irradiance `E` \[W/m²\] on the surface to which it belongs.
    pub irradiance: [f32; 3],
}

/// The triangles into which one side of one patch was cut.
#[derive(Clone, Copy, Debug)]
pub struct DisplayPiece<'a> {
    /// The triangle of the scene.
    pub triangle: TriangleId,
    /// The side of it.
    pub side: Side,
    /// The side of the patch.
    pub id: SideId,
    /// Numbers of vertices, counterclockwise seen from the side. Empty for a patch smaller than the precision of
    /// the coordinates.
    pub triangles: &'a [[u32; 3]],
}

/// A conforming triangulation of all active sides of the patches of a scene, with irradiance at its vertices.
///
/// Triangles share their vertices wherever their edges touch, whatever the number of parts that the edges are cut
/// in, and whatever T-junctions the file has. So nothing cracks.
///
/// A vertex has the mean irradiance of the patches around it that belong to one smooth surface, which are those
/// that continue each other across an edge with nothing between them, bent by less than 30°. The mean is weighted by the angle at the vertex over
/// the distance to the patch's center. On a regular subdivision it reproduces a linear field. It is the
/// irradiance that is averaged and not the radiosity, so that colors do not run into each other where materials
/// change: `B = M + ρE` is evaluated with the material, and the texture, of each triangle.
#[derive(Clone, Debug)]
pub struct DisplayMesh<'a> {
    pub(crate) scene: &'a Scene,
    pub(crate) mesh: &'a PatchMesh,
    pub(super) irradiance: &'a [Rgb],
    /// Whether what surfaces and the sky emit is shown, too.
    pub(crate) emits: bool,
    pub(super) positions: Vec<DVec3>,
    pub(super) vertices: Vec<DisplayVertex>,
    pub(super) triangles: Vec<[u32; 3]>,
    /// Where the triangles of each piece begin; one more than there are pieces. Pieces are numbered triangle by
    /// triangle, patch by patch, side by side.
    pub(super) piece_starts: Vec<u32>,
    /// Where the pieces of each triangle begin; one more than there are triangles.
    pub(super) first_pieces: Vec<u32>,
    /// Made when a picture first needs them.
    pub(super) levels: OnceLock<Levels>,
}

impl<'a> DisplayMesh<'a> {
    /// The same mesh with the standard error of irradiance \[W/m²\] in its place: radiosity and radiance then are those standard
    /// errors, and what surfaces and the sky emit, which has none, is left out.
    ///
    /// Errors are interpolated as the irradiance is. That of an interpolated value is a little less, as far as the noise of the
    /// patches that it is made of is independent.
    ///
    /// # Panics
    ///
    /// If `errors` has not one value for every side of `mesh`.
    #[must_use]
    pub fn of_errors(scene: &'a Scene, mesh: &'a PatchMesh, errors: &'a [Rgb]) -> Self {
        Self { emits: false, ..Self::new(scene, mesh, errors) }
    }

    /// Positions; vertices with different irradiance may share one.
    #[must_use]
    pub fn positions(&self) -> &[DVec3] {
        &self.positions
    }

    /// The vertices.
    #[must_use]
    pub fn vertices(&self) -> &[DisplayVertex] {
        &self.vertices
    }

    /// All triangles: numbers of vertices, counterclockwise seen from the side that they show.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Every side of every patch with its triangles. With
    /// [`Subdivision::PerFace`](sir_mesh::Subdivision::PerFace) a side comes once for each triangle of its face.
    pub fn pieces(&self) -> impl Iterator<Item = DisplayPiece<'_>> {
        self.scene.triangle_ids().flat_map(|t| self.pieces_of(t))
    }

    /// The pieces of one triangle of the scene.
    pub fn pieces_of(&self, t: TriangleId) -> impl Iterator<Item = DisplayPiece<'_>> {
        let sides = active_sides(self.scene, t);
        self.mesh.patches_of(t).map(PatchId).flat_map(move |patch| {
            sides.iter().filter_map(move |&side| {
                let id = self.mesh.side_of(t, patch, side)?;
                Some(DisplayPiece { triangle: t, side, id, triangles: self.triangles_of(t, patch, side) })
            })
        })
    }

    /// Irradiance \[W/m²\] at a point of a side of a triangle of the scene, interpolated; `None` if the side does
    /// not reflect.
    #[must_use]
    pub fn irradiance_at(&self, triangle: TriangleId, point: Barycentric, side: Side) -> Option<Rgb> {
        let patch = self.mesh.patch_at(triangle, point);
        let id = self.mesh.side_of(triangle, patch, side)?;
        let corners = self.scene.corners(triangle);
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        let position = point.point(corners);
        let weights = |t: &[u32; 3]| {
            let c = t.map(|v| self.positions[self.vertices[v as usize].position as usize] - position);
            let part = |i: usize| c[(i + 1) % 3].cross(c[(i + 2) % 3]).dot(normal);
            let parts = [part(0), part(1), part(2)];
            let sum: f64 = parts.iter().sum();
            parts.map(|p| p / sum)
        };
        // Rounding may put the point outside all of them: it belongs to the one that it is least outside of.
        let inside = |w: &[f64; 3]| w[0].min(w[1]).min(w[2]);
        let found = self
            .triangles_of(triangle, patch, side)
            .iter()
            .map(|t| (t, weights(t)))
            .filter(|(_, w)| w[0].is_finite() && w[1].is_finite() && w[2].is_finite())
            .max_by(|(_, v), (_, w)| inside(v).total_cmp(&inside(w)));
        let Some((t, w)) = found else { return Some(self.irradiance[id.index()]) };
        let w = w.map(|x| x.clamp(0.0, 1.0));
        let weighted = |i: usize| w[i] * rgb(self.vertices[t[i] as usize].irradiance);
        Some((weighted(0) + weighted(1) + weighted(2)) / (w[0] + w[1] + w[2]))
    }

    /// Radiosity `B = M + ρE` \[W/m²\] of a side of a patch of a triangle on which `irradiance` falls, on the mean over the
    /// patch; of a mesh of errors `ρE`.
    #[must_use]
    pub fn radiosity(&self, triangle: TriangleId, patch: PatchId, side: Side, irradiance: Rgb) -> Rgb {
        let emitted =
            if self.emits { self.mesh.exitance(self.scene, triangle, patch, side) } else { Rgb::ZERO };
        emitted + self.mesh.reflectance(self.scene, triangle, patch) * irradiance
    }

    /// The same about a point of a triangle, whose textures are shown as the mean over `width` \[m\]; with 0 as they are at the
    /// point.
    #[must_use]
    pub fn radiosity_at(
        &self,
        triangle: TriangleId,
        point: Barycentric,
        side: Side,
        irradiance: Rgb,
        width: f64,
    ) -> Rgb {
        let Self { scene, mesh, .. } = self;
        if !mesh.is_varied(triangle) {
            return self.radiosity(triangle, mesh.patch_at(triangle, point), side, irradiance);
        }
        let levels = self.levels.get_or_init(|| Levels::of(scene));
        let emitted =
            if self.emits { levels.exitance(scene, triangle, side, point, width) } else { Rgb::ZERO };
        emitted + levels.reflectance(scene, triangle, point, width) * irradiance
    }

    /// Radiosity \[W/m²\] of a piece with this irradiance.
    pub(crate) fn radiosity_of(&self, piece: &DisplayPiece<'_>, irradiance: Rgb) -> Rgb {
        let patch = self.mesh.patch_of_side(piece.triangle, piece.id);
        self.radiosity(piece.triangle, patch, piece.side, irradiance)
    }

    /// Radiosity \[W/m²\] of a piece as it was solved, not interpolated.
    pub(crate) fn own_radiosity(&self, piece: &DisplayPiece<'_>) -> Rgb {
        self.radiosity_of(piece, self.irradiance[piece.id.index()])
    }

    fn triangles_of(&self, triangle: TriangleId, patch: PatchId, side: Side) -> &[[u32; 3]] {
        let sides = active_sides(self.scene, triangle).len() as u32;
        let patch = patch.0 - self.mesh.patches_of(triangle).start;
        let piece = self.first_pieces[triangle.index()] + patch * sides + u32::from(side == Side::Back);
        let [start, end] = [piece, piece + 1].map(|p| self.piece_starts[p as usize] as usize);
        &self.triangles[start..end]
    }
}

/// The sides of a triangle that reflect.
pub(super) fn active_sides(scene: &Scene, triangle: TriangleId) -> &'static [Side] {
    if scene.is_active(triangle, Side::Back) { &[Side::Front, Side::Back] } else { &[Side::Front] }
}
pub(super) fn rgb(irradiance: [f32; 3]) -> Rgb {
    Rgb::from_array(irradiance.map(f64::from))
}
