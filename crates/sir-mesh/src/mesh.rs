//! The patches of a scene.

use std::ops::Range;

use sir_geom::{Barycentric, BoundingBox, Rgb, Scene, Side, TriangleId};

use crate::barycentric;
use crate::divisions::Subdivision;
use crate::error::MeshError;
use crate::index::{PatchId, SideId};
use crate::numbering::{Numbering, Patches};
use crate::properties::Properties;

/// All patches of a scene. Uses 28 bytes per *triangle*, and nothing per patch except where it has a texture.
#[derive(Clone, Debug)]
pub struct PatchMesh {
    numbering: Numbering,
    properties: Properties,
}

impl PatchMesh {
    /// Divides the triangles of a scene into patches.
    ///
    /// # Errors
    ///
    /// Returns an error if a limit is not positive, or if there would be more than 2³² − 1 patches or sides.
    pub fn new(scene: &Scene, subdivision: Subdivision) -> Result<Self, MeshError> {
        Self::within(scene, subdivision, None)
    }

    /// Divides the triangles of a scene into patches, as [`new`](Self::new) does, but if a box is given, cuts only
    /// triangles whose centroid is in it. If others reach into the box, [split the
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

    /// Returns the numbers of the patches of a triangle.
    #[must_use]
    pub fn patches_of(&self, triangle: TriangleId) -> Range<u32> {
        self.numbering.patches_of(triangle)
    }

    /// Returns the number of parts into which each edge of a triangle is cut.
    #[must_use]
    pub fn divisions(&self, triangle: TriangleId) -> u32 {
        self.numbering.divisions(triangle)
    }

    /// Returns the area of each patch of a triangle, including its gaps; for a merged face, the area of the whole face.
    #[inline]
    #[must_use]
    pub fn patch_area(&self, triangle: TriangleId) -> f64 {
        self.numbering.patches_of[triangle.index()].area
    }

    /// Returns the covered area of a patch: the area that stops light, without gaps. It may be zero.
    #[inline]
    #[must_use]
    pub fn covered_area(&self, triangle: TriangleId, patch: PatchId) -> f64 {
        let Patches { first, area } = self.numbering.patches_of[triangle.index()];
        area * self.properties.coverage(triangle, patch.0 - first)
    }

    /// Returns the covered area of a triangle: the area that stops light.
    #[must_use]
    pub fn covered_area_of(&self, scene: &Scene, triangle: TriangleId) -> f64 {
        let area = scene.area(triangle);
        if !self.is_varied(triangle) {
            return area;
        }
        let (patches, all) = (self.patches_of(triangle), self.patch_area(triangle));
        // A merged face is one patch of several triangles.
        let part = area / (patches.len() as f64 * all);
        patches.map(|patch| part * self.covered_area(triangle, PatchId(patch))).sum()
    }

    /// Returns the diffuse reflectance of a patch per band, in `[0, 1)`; with a texture, the mean over the covered
    /// area.
    ///
    /// `scene` must be the scene that was divided into these patches, here and in the functions below.
    #[inline]
    #[must_use]
    pub fn reflectance(&self, scene: &Scene, triangle: TriangleId, patch: PatchId) -> Rgb {
        let within = patch.0 - self.numbering.patches_of[triangle.index()].first;
        let own = self.properties.reflectance(triangle, within);
        own.unwrap_or_else(|| scene.material(triangle).reflectance)
    }

    /// Returns the emitted exitance `M` \[W/m²\] of a side of a patch; with a texture, the mean over the covered area.
    #[inline]
    #[must_use]
    pub fn exitance(&self, scene: &Scene, triangle: TriangleId, patch: PatchId, side: Side) -> Rgb {
        let of_triangle = scene.exitance(triangle, side);
        let within = patch.0 - self.numbering.patches_of[triangle.index()].first;
        let own = self.properties.exitance(triangle, within).filter(|_| of_triangle != Rgb::ZERO);
        own.unwrap_or(of_triangle)
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

    /// Returns the patch of a triangle in which a point lies.
    #[inline]
    #[must_use]
    pub fn patch_at(&self, triangle: TriangleId, point: Barycentric) -> PatchId {
        let within = barycentric::locate(self.divisions(triangle), point);
        PatchId(self.numbering.patches_of[triangle.index()].first + within)
    }

    /// Returns the given side of a patch of a triangle; `None` if that side does not take part in light transport.
    #[inline]
    #[must_use]
    pub fn side_of(&self, triangle: TriangleId, patch: PatchId, side: Side) -> Option<SideId> {
        let cut = self.numbering.cuts[triangle.index()];
        let within = (patch.0 - self.numbering.patches_of[triangle.index()].first) * cut.sides();
        match side {
            Side::Front => Some(SideId(cut.first_side + within)),
            Side::Back if cut.sides == 2 => Some(SideId(cut.first_side + within + 1)),
            Side::Back => None,
        }
    }

    /// Returns the patch of a triangle to which a side belongs.
    #[inline]
    #[must_use]
    pub fn patch_of_side(&self, triangle: TriangleId, side: SideId) -> PatchId {
        let cut = self.numbering.cuts[triangle.index()];
        PatchId(self.numbering.patches_of[triangle.index()].first + (side.0 - cut.first_side) / cut.sides())
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

    /// Returns the entry that [`sides_at`](Self::sides_at) reads for a triangle, so that callers can prefetch it.
    #[inline]
    #[must_use]
    pub fn place_of(&self, triangle: TriangleId) -> &impl Sized {
        &self.numbering.cuts[triangle.index()]
    }

    /// Returns the front and, if it takes part in light transport, the back of the patch in which a point of a triangle
    /// lies.
    #[inline]
    #[must_use]
    pub fn sides_at(&self, triangle: TriangleId, point: Barycentric) -> (SideId, Option<SideId>) {
        let cut = self.numbering.cuts[triangle.index()];
        let front = SideId(cut.first_side + barycentric::locate(cut.divisions(), point) * cut.sides());
        (front, (cut.sides == 2).then_some(SideId(front.0 + 1)))
    }

    /// Returns the corners of a patch as points of its triangle, in the triangle's orientation; for a merged face,
    /// those of the given triangle.
    #[must_use]
    pub fn patch_corners(&self, triangle: TriangleId, patch: PatchId) -> [Barycentric; 3] {
        self.numbering.patch_corners(triangle, patch)
    }

    /// Calls `visit` once for every active side, in the order of [`SideId`], with one triangle of its patch.
    pub fn for_each_side(&self, mut visit: impl FnMut(TriangleId, PatchId, Side, SideId)) {
        for &triangle in &self.numbering.owners {
            for patch in self.patches_of(triangle).map(PatchId) {
                for side in [Side::Front, Side::Back] {
                    if let Some(id) = self.side_of(triangle, patch, side) {
                        visit(triangle, patch, side, id);
                    }
                }
            }
        }
    }

    /// Returns the active sides whose numbers lie in `sides`, in order. Each item is a triangle and the consecutive
    /// numbers of sides of its patches, all of the same material and, including gaps, of the same area.
    pub fn sides_within(&self, sides: Range<u32>) -> impl Iterator<Item = (TriangleId, Range<u32>)> {
        let of = |triangle: TriangleId| {
            let (cut, n) = (self.numbering.cuts[triangle.index()], self.divisions(triangle));
            cut.first_side..cut.first_side + n * n * cut.sides()
        };
        let first = self.numbering.owners.partition_point(|&t| of(t).end <= sides.start);
        self.numbering.owners[first..]
            .iter()
            .map(move |&t| (t, of(t).start.max(sides.start)..of(t).end.min(sides.end)))
            .take_while(|(_, range)| !range.is_empty())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
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
        scene.triangle_ids().map(|t| mesh.patch_area(t) * mesh.patches_of(t).len() as f64).sum()
    }

    #[test]
    fn limits_hold_and_areas_add_up() {
        let scene = room(Sides::Front);
        for subdivision in
            [Subdivision::MaxArea(0.02), Subdivision::MaxEdge(0.3), Subdivision::Patches(20_000)]
        {
            let mesh = PatchMesh::new(&scene, subdivision).unwrap();
            assert!((total_area(&scene, &mesh) / scene.total_area() - 1.0).abs() < 1e-12);
            for t in scene.triangle_ids() {
                let corners = scene.corners(t);
                let c = mesh.patch_corners(t, PatchId(mesh.patches_of(t).start)).map(|b| b.point(corners));
                let area = 0.5 * (c[1] - c[0]).cross(c[2] - c[0]).length();
                assert!((area / mesh.patch_area(t) - 1.0).abs() < 1e-9);
                match subdivision {
                    Subdivision::MaxArea(max) => assert!(area <= max * (1.0 + 1e-9)),
                    Subdivision::MaxEdge(max) => assert!(c[0].distance(c[1]) <= max * (1.0 + 1e-9)),
                    _ => {}
                }
            }
        }
    }

    #[test]
    fn a_target_count_is_met_closely() {
        let scene = room(Sides::Front);
        for target in [332, 1_000, 20_000, 614_778] {
            let mesh = PatchMesh::new(&scene, Subdivision::Patches(target)).unwrap();
            let off = mesh.patch_count() as f64 / target as f64 - 1.0;
            assert!(off.abs() < 1e-3 + 2.0 / target as f64, "{target}: {} patches", mesh.patch_count());
        }
        let mesh = PatchMesh::new(&scene, Subdivision::Patches(5)).unwrap();
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
        for subdivision in
            [Subdivision::MaxArea(0.02), Subdivision::MaxEdge(0.3), Subdivision::Patches(20_000)]
        {
            let all = PatchMesh::new(&scene, subdivision).unwrap();
            let mesh = PatchMesh::within(&scene, subdivision, Some(bounds)).unwrap();
            assert!((total_area(&scene, &mesh) / scene.total_area() - 1.0).abs() < 1e-12);
            let mut area = 0.0;
            for t in scene.triangle_ids() {
                if !scene.corners(t).iter().all(|&corner| bounds.contains(corner)) {
                    assert_eq!(mesh.divisions(t), 1);
                    continue;
                }
                area += scene.area(t);
                match subdivision {
                    Subdivision::Patches(_) => assert!(mesh.divisions(t) > all.divisions(t)),
                    _ => assert_eq!(mesh.divisions(t), all.divisions(t)),
                }
            }
            assert!((area - inside).abs() < 1e-9, "{area} of {inside}");
            if let Subdivision::Patches(target) = subdivision {
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
            assert_eq!(mesh.patches_of(TriangleId(0)), mesh.patches_of(TriangleId(1)));
            assert!((mesh.patch_area(TriangleId(0)) - 21.0).abs() < 1e-12);
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
                PatchMesh::new(&scene, Subdivision::MaxArea(bad)),
                Err(MeshError::NotPositive { .. })
            ));
        }
        for huge in [Subdivision::MaxArea(1e-12), Subdivision::MaxEdge(1e-9), Subdivision::Patches(1 << 40)] {
            assert_eq!(PatchMesh::new(&scene, huge).unwrap_err(), MeshError::TooMany);
        }
    }

    proptest! {
        #[test]
        fn every_side_has_its_own_number(area in 0.01..5.0f64, v in 0.0..1.0f64, w in 0.0..1.0f64) {
            let scene = room(Sides::Both);
            let mesh = PatchMesh::new(&scene, Subdivision::MaxArea(area)).unwrap();
            let mut seen = vec![false; mesh.side_count()];
            mesh.for_each_side(|_, _, _, s| assert!(!std::mem::replace(&mut seen[s.index()], true)));
            prop_assert!(seen.iter().all(|&s| s));
            let (from, to) = ((v * seen.len() as f64) as u32, ((v + w * (1.0 - v)) * seen.len() as f64) as u32);
            let within: Vec<u32> = mesh.sides_within(from..to).flat_map(|(_, sides)| sides).collect();
            prop_assert_eq!(within, (from..to).collect::<Vec<_>>());
            for t in scene.triangle_ids() {
                let point = Barycentric { v, w: w * (1.0 - v) };
                let patch = mesh.patch_at(t, point);
                prop_assert!(mesh.patches_of(t).contains(&patch.0));
                let front = mesh.side_at(t, point, Side::Front).unwrap();
                let back = mesh.side_at(t, point, Side::Back).unwrap();
                prop_assert_eq!(back.0, front.0 + 1);
            }
        }
    }
}
