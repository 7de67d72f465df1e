//! The patches of a scene.

use std::ops::Range;

use glam::DVec3;
use sir_geom::{Barycentric, BoundingBox, Rgb, Scene, Side, TriangleId};

use crate::error::MeshError;
use crate::index::{PatchId, SideId};
use crate::numbering::Numbering;
use crate::piece::Piece;
use crate::properties::Properties;
use crate::subdivision::Subdivision;

/// All patches of a scene.
///
/// A patch belongs to the *surface* of one or more triangles, which have consecutive patches. Functions of a patch also take
/// any triangle of its surface.
#[derive(Clone, Debug)]
pub struct PatchMesh {
    numbering: Numbering,
    properties: Properties,
}

impl PatchMesh {
    /// Divides a scene into patches.
    ///
    /// # Errors
    ///
    /// Returns an error if a limit is not positive, or if there would be more than 2³² − 1 patches or sides.
    pub fn new(scene: &Scene, subdivision: Subdivision) -> Result<Self, MeshError> {
        Self::within(scene, subdivision, None)
    }

    /// Divides a scene into patches, as [`new`](Self::new) does, but if a box is given, cuts only triangles whose
    /// centroid is in it. If others reach into the box, [split the
    /// scene](sir_geom::SceneBuilder::split_at) at the box first.
    ///
    /// # Errors
    ///
    /// Returns the same errors as `new`.
    pub fn within(
        scene: &Scene,
        subdivision: Subdivision,
        bounds: Option<BoundingBox>,
    ) -> Result<Self, MeshError> {
        let numbering = Numbering::new(scene, subdivision, bounds)?;
        let properties = Properties::new(scene, &numbering);
        Ok(Self { numbering, properties })
    }

    /// Returns the number of patches.
    #[must_use]
    pub fn patch_count(&self) -> usize {
        self.numbering.patches as usize
    }

    /// Returns the number of active sides, at most twice the number of patches.
    #[must_use]
    pub fn side_count(&self) -> usize {
        self.numbering.sides as usize
    }

    /// True if some patches are not flat: a line may cross them twice.
    #[must_use]
    pub fn has_bent_patches(&self) -> bool {
        self.numbering.is_bent
    }

    /// Returns the number of parts into which each edge of a triangle is cut; `None` if the triangle is cut into cells.
    #[must_use]
    pub fn divisions(&self, triangle: TriangleId) -> Option<u32> {
        self.numbering.divisions(triangle)
    }

    /// Returns the area of a patch, including its gaps.
    #[inline]
    #[must_use]
    pub fn patch_area(&self, triangle: TriangleId, patch: PatchId) -> f64 {
        self.numbering.area(triangle, patch)
    }

    /// Returns the covered area of a patch: the area that stops light, without gaps. It may be zero.
    #[inline]
    #[must_use]
    pub fn covered_area(&self, triangle: TriangleId, patch: PatchId) -> f64 {
        self.numbering.area(triangle, patch)
            * self.properties.coverage(triangle, self.number_in_surface(triangle, patch))
    }

    /// Returns the first triangle of the surface of a triangle, and the numbers of the patches of the surface.
    #[must_use]
    pub fn surface_of(&self, triangle: TriangleId) -> (TriangleId, Range<u32>) {
        self.numbering.surface_of(triangle)
    }

    /// Returns the number of a patch within its surface.
    #[inline]
    #[must_use]
    pub fn number_in_surface(&self, triangle: TriangleId, patch: PatchId) -> u32 {
        patch.0 - self.numbering.first_patch(triangle)
    }

    /// Returns the pieces of a patch.
    pub fn pieces(&self, triangle: TriangleId, patch: PatchId) -> impl Iterator<Item = Piece> + use<'_> {
        self.numbering.pieces(triangle, patch)
    }

    /// Returns the corners of all pieces of a patch in space.
    ///
    /// `scene` must be the scene that was divided into these patches.
    #[must_use]
    pub fn corners(&self, scene: &Scene, triangle: TriangleId, patch: PatchId) -> Vec<DVec3> {
        let mut all = Vec::new();
        for piece in self.pieces(triangle, patch) {
            let corners = scene.corners(piece.triangle);
            all.extend(piece.corners().iter().map(|point| point.point(corners)));
        }
        all
    }

    /// Calls `visit` with all pieces of a triangle, and the patch of each.
    pub fn for_each_piece_of(&self, triangle: TriangleId, visit: impl FnMut(PatchId, Piece)) {
        self.numbering.for_each_piece_of(triangle, visit);
    }

    /// Returns the center of a patch, and the sum of the normals of its pieces times twice their areas.
    ///
    /// `scene` must be the scene that was divided into these patches.
    #[must_use]
    pub fn center_and_normal(&self, scene: &Scene, triangle: TriangleId, patch: PatchId) -> (DVec3, DVec3) {
        let (mut moment, mut weight, mut normal) = (DVec3::ZERO, 0.0, DVec3::ZERO);
        for piece in self.pieces(triangle, patch) {
            let corners = scene.corners(piece.triangle);
            for part in piece.triangles() {
                let [a, b, c] = part.map(|point| point.point(corners));
                let twice = (b - a).cross(c - a);
                moment += twice.length() * ((a + b + c) / 3.0);
                weight += twice.length();
                normal += twice;
            }
        }
        (moment / weight, normal)
    }

    /// Returns the center of a patch.
    ///
    /// `scene` must be the scene that was divided into these patches.
    #[must_use]
    pub fn center(&self, scene: &Scene, triangle: TriangleId, patch: PatchId) -> DVec3 {
        self.center_and_normal(scene, triangle, patch).0
    }

    /// Returns the corners of a patch that is one triangle: cut from one into congruent triangles, or not cut. `None` for
    /// others.
    #[must_use]
    pub fn single_triangle(&self, triangle: TriangleId, patch: PatchId) -> Option<[Barycentric; 3]> {
        self.numbering.single_triangle(triangle, patch)
    }

    /// Returns a triangle, and a part of it, in which a random point of a patch lies, for a uniform number in `[0, 1)`, and
    /// the remainder of the number, which is uniform in `[0, 1)`, too.
    #[inline]
    #[must_use]
    pub fn random_part(
        &self,
        triangle: TriangleId,
        patch: PatchId,
        random: f64,
    ) -> (TriangleId, [Barycentric; 3], f64) {
        self.numbering.random_part(triangle, patch, random)
    }

    /// Returns the covered area of a triangle: the area that stops light.
    #[must_use]
    pub fn covered_area_of(&self, scene: &Scene, triangle: TriangleId) -> f64 {
        let area = scene.area(triangle);
        if !self.is_varied(triangle) {
            return area;
        }
        let mut covered = 0.0;
        self.for_each_piece_of(triangle, |patch, piece| {
            covered +=
                piece.share() * self.properties.coverage(triangle, self.number_in_surface(triangle, patch));
        });
        area * covered
    }

    /// Returns the diffuse reflectance of a patch per band, in `[0, 1)`; with a texture, the mean over the covered
    /// area.
    ///
    /// `scene` must be the scene that was divided into these patches, or a dimmed copy of it, here and in the functions
    /// below.
    #[inline]
    #[must_use]
    pub fn reflectance(&self, scene: &Scene, triangle: TriangleId, patch: PatchId) -> Rgb {
        let own = self.properties.reflectance(triangle, self.number_in_surface(triangle, patch));
        own.unwrap_or_else(|| scene.material(triangle).reflectance)
    }

    /// Returns the emitted exitance `M` \[W/m²\] of a side of a patch; with a texture, the mean over the covered area.
    #[inline]
    #[must_use]
    pub fn exitance(&self, scene: &Scene, triangle: TriangleId, patch: PatchId, side: Side) -> Rgb {
        let of_triangle = scene.exitance(triangle, side);
        let own = self
            .properties
            .exitance(triangle, self.number_in_surface(triangle, patch))
            .filter(|_| of_triangle != Rgb::ZERO);
        // The patches were made before the scene was dimmed.
        own.map_or(of_triangle, |own| own * scene.dimming(triangle))
    }

    /// Returns the largest reflectance of a patch in any band.
    #[must_use]
    pub fn largest_reflectance(&self, scene: &Scene) -> f64 {
        let plain = scene.materials().iter().map(|m| m.reflectance.max_element());
        plain.fold(self.properties.max_reflectance(), f64::max)
    }

    /// Returns true if patches of a triangle may differ in reflectance, exitance or covered area.
    #[inline]
    #[must_use]
    pub fn is_varied(&self, triangle: TriangleId) -> bool {
        self.properties.is_varied(triangle)
    }

    /// Returns the memory in use for properties that differ from patch to patch \[bytes\].
    #[must_use]
    pub fn paint_bytes(&self) -> usize {
        self.properties.bytes()
    }

    /// Returns the memory in use for the numbers, areas and pieces of patches \[bytes\].
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.numbering.bytes()
    }

    /// Returns the patch of a triangle in which a point lies.
    #[inline]
    #[must_use]
    pub fn patch_at(&self, triangle: TriangleId, point: Barycentric) -> PatchId {
        PatchId(self.numbering.first_patch(triangle) + self.numbering.locate(triangle, point).0)
    }

    /// Returns the sides of a triangle that take part in light transport.
    #[must_use]
    pub fn sides_of(&self, triangle: TriangleId) -> &'static [Side] {
        match self.numbering.cut(triangle).sides() {
            2 => &[Side::Front, Side::Back],
            _ => &[Side::Front],
        }
    }

    /// Returns the given side of a patch; `None` if that side does not take part in light transport.
    #[inline]
    #[must_use]
    pub fn side_of(&self, triangle: TriangleId, patch: PatchId, side: Side) -> Option<SideId> {
        let sides = self.numbering.cut(triangle).sides();
        let front = self.numbering.first_side(triangle) + self.number_in_surface(triangle, patch) * sides;
        match side {
            Side::Front => Some(SideId(front)),
            Side::Back => (sides == 2).then_some(SideId(front + 1)),
        }
    }

    /// Returns the patch to which a side belongs.
    #[inline]
    #[must_use]
    pub fn patch_of_side(&self, triangle: TriangleId, side: SideId) -> PatchId {
        let within = (side.0 - self.numbering.first_side(triangle)) / self.numbering.cut(triangle).sides();
        PatchId(self.numbering.first_patch(triangle) + within)
    }

    /// Returns the given side of the patch in which a point of a triangle lies.
    #[inline]
    #[must_use]
    pub fn side_at(&self, triangle: TriangleId, point: Barycentric, side: Side) -> Option<SideId> {
        let (front, back) = self.sides_at(triangle, point);
        match side {
            Side::Front => Some(front),
            Side::Back => back,
        }
    }

    /// Returns the entry that [`sides_at`](Self::sides_at) reads first for a triangle, so that callers can prefetch it.
    #[inline]
    #[must_use]
    pub fn first_entry(&self, triangle: TriangleId) -> &impl Sized {
        self.numbering.cut(triangle)
    }

    /// Returns the entry that [`sides_at`](Self::sides_at) reads after the first, so that callers can prefetch it.
    #[inline]
    #[must_use]
    pub fn second_entry(&self, triangle: TriangleId) -> &impl Sized {
        self.numbering.place(*self.numbering.cut(triangle))
    }

    /// Returns the front and, if it takes part in light transport, the back of the patch in which a point of a triangle
    /// lies.
    #[inline]
    #[must_use]
    pub fn sides_at(&self, triangle: TriangleId, point: Barycentric) -> (SideId, Option<SideId>) {
        let (within, first) = self.numbering.locate(triangle, point);
        let sides = self.numbering.cut(triangle).sides();
        let front = SideId(first + within * sides);
        (front, (sides == 2).then_some(SideId(front.0 + 1)))
    }

    /// Calls `visit` once for every active side, in the order of [`SideId`], with one triangle of its surface.
    pub fn for_each_side(&self, mut visit: impl FnMut(TriangleId, PatchId, Side, SideId)) {
        for &(triangle, count) in &self.numbering.surfaces {
            let first = self.numbering.first_patch(triangle);
            for patch in (first..first + count).map(PatchId) {
                for side in [Side::Front, Side::Back] {
                    if let Some(id) = self.side_of(triangle, patch, side) {
                        visit(triangle, patch, side, id);
                    }
                }
            }
        }
    }

    /// Returns the active sides whose numbers lie in `sides`, in order. Each item is a triangle and consecutive numbers of
    /// sides of patches of its surface, all of the same material.
    pub fn sides_within(&self, sides: Range<u32>) -> impl Iterator<Item = (TriangleId, Range<u32>)> {
        let of = |&(triangle, count): &(TriangleId, u32)| {
            let first = self.numbering.first_side(triangle);
            first..first + count * self.numbering.cut(triangle).sides()
        };
        let first = self.numbering.surfaces.partition_point(|surface| of(surface).end <= sides.start);
        self.numbering.surfaces[first..]
            .iter()
            .map(move |surface| {
                (surface.0, of(surface).start.max(sides.start)..of(surface).end.min(sides.end))
            })
            .take_while(|(_, range)| !range.is_empty())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::subdivision::PatchSize;
    use proptest::prelude::*;
    use sir_geom::shapes::{self, Facing};
    use sir_geom::{Material, Rgb, SceneBuilder, Sides};

    fn room(sides: Sides) -> Scene {
        let mut b = SceneBuilder::new();
        let m = b.add_material(Material::diffuse("m", Rgb::splat(0.5)).with_sides(sides));
        shapes::cuboid(&mut b, DVec3::ZERO, DVec3::new(10.0, 7.0, 3.0), [m; 6], Facing::Inward);
        shapes::sphere(&mut b, DVec3::new(5.0, 3.0, 1.5), 1.0, 2, Facing::Outward, |_| m);
        b.build().unwrap().scene
    }

    fn total_area(scene: &Scene, mesh: &PatchMesh) -> f64 {
        let mut total = 0.0;
        for t in scene.triangle_ids() {
            mesh.for_each_piece_of(t, |_, piece| total += scene.area(t) * piece.share());
        }
        total
    }

    #[test]
    fn limits_hold_and_areas_add_up() {
        let scene = room(Sides::Front);
        for subdivision in [
            Subdivision::Triangles(PatchSize::MaxArea(0.02)),
            Subdivision::Triangles(PatchSize::MaxEdge(0.3)),
            Subdivision::Triangles(PatchSize::Count(20_000)),
        ] {
            let mesh = PatchMesh::new(&scene, subdivision).unwrap();
            assert!((total_area(&scene, &mesh) / scene.total_area() - 1.0).abs() < 1e-12);
            for t in scene.triangle_ids() {
                let corners = scene.corners(t);
                let patch = mesh.patch_at(t, Barycentric { v: 0.0, w: 0.0 });
                let c = mesh.single_triangle(t, patch).unwrap().map(|b| b.point(corners));
                let area = 0.5 * (c[1] - c[0]).cross(c[2] - c[0]).length();
                assert!((area / mesh.patch_area(t, patch) - 1.0).abs() < 1e-9);
                match subdivision {
                    Subdivision::Triangles(PatchSize::MaxArea(max)) => assert!(area <= max * (1.0 + 1e-9)),
                    Subdivision::Triangles(PatchSize::MaxEdge(max)) => {
                        assert!(c[0].distance(c[1]) <= max * (1.0 + 1e-9))
                    }
                    _ => {}
                }
            }
        }
    }

    #[test]
    fn a_target_count_is_met_closely() {
        let scene = room(Sides::Front);
        for target in [332, 1_000, 20_000, 614_778] {
            let mesh = PatchMesh::new(&scene, Subdivision::Triangles(PatchSize::Count(target))).unwrap();
            let off = mesh.patch_count() as f64 / target as f64 - 1.0;
            assert!(off.abs() < 1e-3 + 2.0 / target as f64, "{target}: {} patches", mesh.patch_count());
        }
        let mesh = PatchMesh::new(&scene, Subdivision::Triangles(PatchSize::Count(5))).unwrap();
        assert_eq!(mesh.patch_count(), scene.triangles().len());
    }

    #[test]
    fn only_what_is_in_a_box_is_cut() {
        let mut b = SceneBuilder::new();
        let m = b.add_material(Material::diffuse("m", Rgb::splat(0.5)));
        shapes::cuboid(&mut b, DVec3::ZERO, DVec3::new(10.0, 7.0, 3.0), [m; 6], Facing::Inward);
        let bounds = BoundingBox { min: DVec3::splat(-1e-6), max: DVec3::new(2.0, 3.0, 4.0) };
        b.split_at(&bounds);
        let scene = b.build().unwrap().scene;
        let inside = 2.0 * (2.0 * 3.0) + 3.0 * 3.0 + 2.0 * 3.0;
        for subdivision in [
            Subdivision::Triangles(PatchSize::MaxArea(0.02)),
            Subdivision::Triangles(PatchSize::MaxEdge(0.3)),
            Subdivision::Triangles(PatchSize::Count(20_000)),
        ] {
            let all = PatchMesh::new(&scene, subdivision).unwrap();
            let mesh = PatchMesh::within(&scene, subdivision, Some(bounds)).unwrap();
            assert!((total_area(&scene, &mesh) / scene.total_area() - 1.0).abs() < 1e-12);
            let mut area = 0.0;
            for t in scene.triangle_ids() {
                if !scene.corners(t).iter().all(|&corner| bounds.contains(corner)) {
                    assert_eq!(mesh.divisions(t), Some(1));
                    continue;
                }
                area += scene.area(t);
                match subdivision {
                    Subdivision::Triangles(PatchSize::Count(_)) => {
                        assert!(mesh.divisions(t) > all.divisions(t))
                    }
                    _ => assert_eq!(mesh.divisions(t), all.divisions(t)),
                }
            }
            assert!((area - inside).abs() < 1e-9, "{area} of {inside}");
            if let Subdivision::Triangles(PatchSize::Count(target)) = subdivision {
                let missing = target as usize - mesh.patch_count();
                assert!(missing < 100, "{missing} fewer than asked for");
            }
        }
    }

    #[test]
    fn one_patch_per_face_shares_numbers_between_triangles() {
        for (sides, per_patch) in [(Sides::Front, 1), (Sides::Both, 2)] {
            let scene = room(sides);
            let mesh = PatchMesh::new(&scene, Subdivision::PerFace).unwrap();
            assert_eq!(mesh.patch_count(), 6 + 320);
            assert_eq!(mesh.side_count(), per_patch * mesh.patch_count());
            let middle = Barycentric { v: 0.3, w: 0.3 };
            assert_eq!(mesh.patch_at(TriangleId(0), middle), mesh.patch_at(TriangleId(1), middle));
            assert!((mesh.patch_area(TriangleId(0), PatchId(0)) - 21.0).abs() < 1e-12);
            let mut visited = Vec::new();
            mesh.for_each_side(|_, _, _, side| visited.push(side.index()));
            assert_eq!(visited, (0..mesh.side_count()).collect::<Vec<_>>());
            let owners: Vec<_> = mesh.sides_within(0..mesh.side_count() as u32).map(|(t, _)| t.0).collect();
            assert_eq!(owners[..7], [0, 2, 4, 6, 8, 10, 12], "six faces of two triangles, then single ones");
        }
    }

    #[test]
    fn absurd_limits_are_refused() {
        let scene = room(Sides::Front);
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(matches!(
                PatchMesh::new(&scene, Subdivision::Triangles(PatchSize::MaxArea(bad))),
                Err(MeshError::NotPositive { .. })
            ));
        }
        for huge in [
            Subdivision::Triangles(PatchSize::MaxArea(1e-12)),
            Subdivision::Triangles(PatchSize::MaxEdge(1e-9)),
            Subdivision::Triangles(PatchSize::Count(1 << 40)),
        ] {
            assert_eq!(PatchMesh::new(&scene, huge).unwrap_err(), MeshError::TooMany);
        }
    }

    proptest! {
        #[test]
        fn every_side_has_its_own_number(area in 0.01..5.0f64, v in 0.0..1.0f64, w in 0.0..1.0f64) {
            let scene = room(Sides::Both);
            let mesh = PatchMesh::new(&scene, Subdivision::Triangles(PatchSize::MaxArea(area))).unwrap();
            let mut seen = vec![false; mesh.side_count()];
            mesh.for_each_side(|_, _, _, s| assert!(!std::mem::replace(&mut seen[s.index()], true)));
            prop_assert!(seen.iter().all(|&s| s));
            let (from, to) = ((v * seen.len() as f64) as u32, ((v + w * (1.0 - v)) * seen.len() as f64) as u32);
            let within: Vec<u32> = mesh.sides_within(from..to).flat_map(|(_, sides)| sides).collect();
            prop_assert_eq!(within, (from..to).collect::<Vec<_>>());
            for t in scene.triangle_ids() {
                let point = Barycentric { v, w: w * (1.0 - v) };
                let patch = mesh.patch_at(t, point);
                prop_assert!(mesh.single_triangle(t, patch).is_some());
                let front = mesh.side_at(t, point, Side::Front).unwrap();
                let back = mesh.side_at(t, point, Side::Back).unwrap();
                prop_assert_eq!(back.0, front.0 + 1);
            }
        }
    }
}
