//! The display mesh: patches triangulated so that they share all points, with irradiance at the points.

use std::sync::OnceLock;

use glam::DVec3;
use sir_geom::{Barycentric, Rgb, Scene, Side, TriangleId};
use sir_mesh::{PatchId, PatchMesh, SideId};

use crate::display::levels::Levels;
use crate::display::polygons::shown_with;

/// A vertex of a [`DisplayMesh`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DisplayVertex {
    /// Index of its position in [`DisplayMesh::positions`].
    pub position: u32,
    /// Irradiance `E` \[W/m²\] of the surface to which it belongs.
    pub irradiance: [f32; 3],
}

/// Triangles of one side of one patch.
#[derive(Clone, Copy, Debug)]
pub struct DisplayPiece<'a> {
    /// Triangle of the scene with which it is shown, in whose plane it lies.
    pub triangle: TriangleId,
    /// Side of the triangle.
    pub side: Side,
    /// Side of the patch.
    pub id: SideId,
    /// Indices of vertices, counterclockwise seen from the side. Empty for a patch smaller than the precision of the
    /// coordinates.
    pub triangles: &'a [[u32; 3]],
}

/// A conforming triangulation of all active sides of the patches of a scene, with irradiance at its vertices.
///
/// Triangles share their vertices wherever their edges touch, regardless of the number of parts that edges are cut into
/// and of T-junctions in the file. There are no cracks.
///
/// A vertex has the mean irradiance of the patches around it that belong to one smooth surface. These are patches that
/// continue each other across an edge with nothing between them, bent by less than 30°. The mean is weighted by the
/// angle at the vertex over the distance to the center of the patch. On a regular subdivision, it reproduces a linear
/// field. Irradiance is averaged, not radiosity, so that colors do not blur where materials change: `B = M + ρE` is
/// evaluated with the material, and the texture, of each triangle.
#[derive(Clone, Debug)]
pub struct DisplayMesh<'a> {
    pub(crate) scene: &'a Scene,
    pub(crate) mesh: &'a PatchMesh,
    pub(super) irradiance: &'a [Rgb],
    /// True if emission of surfaces and the sky is shown, too.
    pub(crate) emits: bool,
    pub(super) positions: Vec<DVec3>,
    pub(super) vertices: Vec<DisplayVertex>,
    pub(super) triangles: Vec<[u32; 3]>,
    /// Offset of the triangles of each piece, and their total number at the end. Pieces are ordered by the triangle with
    /// which they are shown, patch and side.
    pub(super) piece_starts: Vec<u32>,
    /// Offset of the pieces of the surface of each triangle.
    pub(super) first_pieces: Vec<u32>,
    /// Mipmaps, made when first needed.
    pub(super) levels: OnceLock<Levels>,
}

impl<'a> DisplayMesh<'a> {
    /// Creates the mesh with the standard error of the irradiance \[W/m²\] in place of the irradiance.
    ///
    /// Radiosity and radiance are then standard errors too, and emission of surfaces and the sky is left out, because
    /// it has no error. Errors are interpolated like irradiance. The true error of an interpolated value is a little
    /// smaller, as far as the noise of the averaged patches is independent.
    ///
    /// # Panics
    ///
    /// If `errors` does not have one value for every side of `mesh`.
    #[must_use]
    pub fn of_errors(scene: &'a Scene, mesh: &'a PatchMesh, errors: &'a [Rgb]) -> Self {
        Self { emits: false, ..Self::new(scene, mesh, errors) }
    }

    /// Returns the scene.
    #[must_use]
    pub fn scene(&self) -> &'a Scene {
        self.scene
    }

    /// Returns the patches.
    #[must_use]
    pub fn mesh(&self) -> &'a PatchMesh {
        self.mesh
    }

    /// Returns the positions. Vertices with different irradiance may share one.
    #[must_use]
    pub fn positions(&self) -> &[DVec3] {
        &self.positions
    }

    /// Returns the vertices.
    #[must_use]
    pub fn vertices(&self) -> &[DisplayVertex] {
        &self.vertices
    }

    /// Returns all triangles: indices of vertices, counterclockwise seen from the side that they show.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Returns every side of every patch with its triangles. A side of a patch that joins several triangles of the scene
    /// occurs once for each; one that is a cell of a flat surface occurs once.
    pub fn pieces(&self) -> impl Iterator<Item = DisplayPiece<'_>> {
        self.scene.triangle_ids().flat_map(|t| self.pieces_of(t))
    }

    /// Returns the pieces that are shown with one triangle of the scene. All cells of a flat surface are shown with its
    /// first triangle.
    pub fn pieces_of(&self, t: TriangleId) -> impl Iterator<Item = DisplayPiece<'_>> {
        let sides = self.mesh.sides_of(t);
        shown_with(self.mesh, t).map(PatchId).flat_map(move |patch| {
            sides.iter().filter_map(move |&side| {
                let id = self.mesh.side_of(t, patch, side)?;
                Some(DisplayPiece { triangle: t, side, id, triangles: self.triangles_of(t, patch, side) })
            })
        })
    }

    /// Returns the interpolated irradiance \[W/m²\] at a point of a side of a triangle of the scene; `None` if the side
    /// does not reflect.
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
        // Rounding may put the point outside of all triangles; then the one that it is least outside of is used.
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

    /// Returns the exitance `M` \[W/m²\] of a side of a triangle; zero for a mesh of errors.
    #[must_use]
    pub fn emitted(&self, triangle: TriangleId, side: Side) -> Rgb {
        if self.emits { self.scene.exitance(triangle, side) } else { Rgb::ZERO }
    }

    /// Returns the radiosity `B = M + ρE` \[W/m²\] of a side of a patch of a triangle on which `irradiance` falls,
    /// averaged over the patch; for a mesh of errors, `ρE`.
    #[must_use]
    pub fn radiosity(&self, triangle: TriangleId, patch: PatchId, side: Side, irradiance: Rgb) -> Rgb {
        let emitted =
            if self.emits { self.mesh.exitance(self.scene, triangle, patch, side) } else { Rgb::ZERO };
        emitted + self.mesh.reflectance(self.scene, triangle, patch) * irradiance
    }

    /// Returns the radiosity \[W/m²\] around a point of a triangle, likewise, but with textures averaged over `width`
    /// \[m\], or at the point itself if `width` is 0.
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

    /// Returns the radiosity \[W/m²\] of a piece with this irradiance.
    pub(crate) fn radiosity_of(&self, piece: &DisplayPiece<'_>, irradiance: Rgb) -> Rgb {
        let patch = self.mesh.patch_of_side(piece.triangle, piece.id);
        self.radiosity(piece.triangle, patch, piece.side, irradiance)
    }

    /// Returns the radiosity \[W/m²\] of a piece as solved, not interpolated.
    pub(crate) fn own_radiosity(&self, piece: &DisplayPiece<'_>) -> Rgb {
        self.radiosity_of(piece, self.irradiance[piece.id.index()])
    }

    fn triangles_of(&self, triangle: TriangleId, patch: PatchId, side: Side) -> &[[u32; 3]] {
        let sides = self.mesh.sides_of(triangle).len() as u32;
        let patch = self.mesh.number_in_surface(triangle, patch);
        let piece = self.first_pieces[triangle.index()] + patch * sides + u32::from(side == Side::Back);
        let [start, end] = [piece, piece + 1].map(|p| self.piece_starts[p as usize] as usize);
        &self.triangles[start..end]
    }
}

pub(super) fn rgb(irradiance: [f32; 3]) -> Rgb {
    Rgb::from_array(irradiance.map(f64::from))
}
