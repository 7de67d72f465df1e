//! The patches of a scene.

use std::collections::HashMap;
use std::ops::Range;

use sir_geom::{Barycentric, BoundingBox, FaceId, Rgb, Scene, Side, Sides, TriangleId, typed_index};
use thiserror::Error;

use crate::barycentric;
use crate::divisions::Subdivision;
use crate::paint::Paint;

typed_index!(
    /// A patch of a [`PatchMesh`].
    PatchId
);
typed_index!(
    /// One active side of a patch: the thing that holds power.
    SideId
);

/// Why patches cannot be made.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum MeshError {
    /// A limit that must be positive is not.
    #[error("the largest {what} of a patch is {value}, but it must be a positive number")]
    NotPositive {
        /// `area` or `edge`.
        what: &'static str,
        /// The limit asked for.
        value: f64,
    },
    /// More patches than 32-bit numbers can count.
    #[error("so fine a subdivision makes more than {} patches or sides", u32::MAX)]
    TooMany,
}

/// What is needed to find a side of a triangle: no more than that, so that it stays in the caches.
#[derive(Clone, Copy, Debug)]
struct Cut {
    first_side: u32,
    /// Parts of an edge, `n`, below 2¹⁶; the triangle has `n²` patches.
    divisions: u16,
    /// Sides per patch, 1 or 2.
    sides: u16,
}

impl Cut {
    fn divisions(self) -> u32 {
        u32::from(self.divisions)
    }

    fn sides(self) -> u32 {
        u32::from(self.sides)
    }
}

/// The patches of one triangle.
#[derive(Clone, Copy, Debug)]
struct Patches {
    first: u32,
    /// Area of each patch.
    area: f64,
}

/// All patches of a scene. Uses 28 bytes per *triangle*, and nothing per patch but where it has a texture.
#[derive(Clone, Debug)]
pub struct PatchMesh {
    cuts: Vec<Cut>,
    patches_of: Vec<Patches>,
    /// One triangle of every patch, in the order of their numbers: of a merged face the first.
    owners: Vec<TriangleId>,
    patches: u32,
    sides: u32,
    paint: Paint,
}

impl PatchMesh {
    /// Makes the patches of a scene.
    ///
    /// # Errors
    ///
    /// If a limit is not positive, or there would be more than 2³² patches.
    pub fn new(scene: &Scene, subdivision: Subdivision) -> Result<Self, MeshError> {
        Self::within(scene, subdivision, None)
    }

    /// As [`new`](Self::new), but of a box, if there is one, only triangles whose middle is in it are cut. Where others reach into it,
    /// [split the scene](sir_geom::SceneBuilder::split_at) at the box first.
    ///
    /// # Errors
    ///
    /// As those of `new`.
    pub fn within(
        scene: &Scene,
        subdivision: Subdivision,
        bounds: Option<BoundingBox>,
    ) -> Result<Self, MeshError> {
        let divisions = subdivision.divisions(scene, bounds)?;
        let mut mesh = Self {
            cuts: Vec::with_capacity(divisions.len()),
            patches_of: Vec::with_capacity(divisions.len()),
            owners: scene.triangle_ids().collect(),
            patches: 0,
            sides: 0,
            paint: Paint::default(),
        };
        for (t, &n) in scene.triangle_ids().zip(&divisions) {
            let per_triangle = n.checked_mul(n).ok_or(MeshError::TooMany)?;
            let divisions = u16::try_from(n).map_err(|_| MeshError::TooMany)?;
            let sides = match scene.material(t).sides {
                Sides::Front => 1,
                Sides::Both => 2,
            };
            mesh.cuts.push(Cut { first_side: mesh.sides, divisions, sides });
            mesh.patches_of
                .push(Patches { first: mesh.patches, area: scene.area(t) / f64::from(per_triangle) });
            let more = |count: u32, by: u32| count.checked_add(by).ok_or(MeshError::TooMany);
            mesh.patches = more(mesh.patches, per_triangle)?;
            mesh.sides =
                more(mesh.sides, per_triangle.checked_mul(u32::from(sides)).ok_or(MeshError::TooMany)?)?;
        }
        if subdivision == Subdivision::PerFace {
            mesh.merge_faces(scene);
        }
        mesh.paint = Paint::new(scene, &mesh);
        Ok(mesh)
    }

    /// Makes one patch of the (undivided) triangles of each flat polygon.
    fn merge_faces(&mut self, scene: &Scene) {
        let mut faces: HashMap<FaceId, Vec<TriangleId>> = HashMap::new();
        for t in scene.triangle_ids() {
            faces.entry(scene.triangle(t).face).or_default().push(t);
        }
        faces.retain(|_, members| is_flat(scene, members));
        (self.patches, self.sides) = (0, 0);
        self.owners.clear();
        for t in scene.triangle_ids() {
            if let Some(members) = faces.get(&scene.triangle(t).face) {
                if t != members[0] {
                    self.cuts[t.index()] = self.cuts[members[0].index()];
                    self.patches_of[t.index()] = self.patches_of[members[0].index()];
                    continue;
                }
                self.patches_of[t.index()].area = members.iter().map(|&m| scene.area(m)).sum();
            }
            self.owners.push(t);
            self.patches_of[t.index()].first = self.patches;
            self.cuts[t.index()].first_side = self.sides;
            self.patches += 1;
            self.sides += self.cuts[t.index()].sides();
        }
    }

    /// Number of patches.
    #[must_use]
    pub fn patch_count(&self) -> usize {
        self.patches as usize
    }

    /// Number of active sides, at most twice the number of patches.
    #[must_use]
    pub fn side_count(&self) -> usize {
        self.sides as usize
    }

    /// Numbers of the patches of a triangle.
    #[must_use]
    pub fn patches_of(&self, triangle: TriangleId) -> Range<u32> {
        let (first, n) = (self.patches_of[triangle.index()].first, self.divisions(triangle));
        first..first + n * n
    }

    /// Parts into which each edge of a triangle is cut.
    #[must_use]
    pub fn divisions(&self, triangle: TriangleId) -> u32 {
        self.cuts[triangle.index()].divisions()
    }

    /// Area of each patch of a triangle, its gaps included; of a merged face, the area of the whole face.
    #[inline]
    #[must_use]
    pub fn patch_area(&self, triangle: TriangleId) -> f64 {
        self.patches_of[triangle.index()].area
    }

    /// Area of a patch that stops light: that of the patch without its gaps. It may be zero.
    #[inline]
    #[must_use]
    pub fn covered_area(&self, triangle: TriangleId, patch: PatchId) -> f64 {
        let Patches { first, area } = self.patches_of[triangle.index()];
        area * self.paint.coverage(triangle, patch.0 - first)
    }

    /// Area of a triangle that stops light.
    #[must_use]
    pub fn covered_area_of(&self, scene: &Scene, triangle: TriangleId) -> f64 {
        let area = scene.area(triangle);
        if !self.is_varied(triangle) {
            return area;
        }
        let (patches, all) = (self.patches_of(triangle), self.patch_area(triangle));
        // A face that is one patch has several triangles.
        let part = area / (patches.len() as f64 * all);
        patches.map(|patch| part * self.covered_area(triangle, PatchId(patch))).sum()
    }

    /// Diffuse reflectance of a patch per band, in `[0, 1)`: with a texture, the mean over the covered area.
    ///
    /// `scene` must be the one that the patches were made of, here and in the functions below.
    #[inline]
    #[must_use]
    pub fn reflectance(&self, scene: &Scene, triangle: TriangleId, patch: PatchId) -> Rgb {
        let within = patch.0 - self.patches_of[triangle.index()].first;
        let own = self.paint.reflectance(triangle, within);
        own.unwrap_or_else(|| scene.material(triangle).reflectance)
    }

    /// Emitted exitance `M` \[W/m²\] of a side of a patch: with a texture, the mean over the covered area.
    #[inline]
    #[must_use]
    pub fn exitance(&self, scene: &Scene, triangle: TriangleId, patch: PatchId, side: Side) -> Rgb {
        let of_triangle = scene.exitance(triangle, side);
        let within = patch.0 - self.patches_of[triangle.index()].first;
        let own = self.paint.exitance(triangle, within).filter(|_| of_triangle != Rgb::ZERO);
        own.unwrap_or(of_triangle)
    }

    /// The largest reflectance of a patch in any band.
    #[must_use]
    pub fn largest_reflectance(&self, scene: &Scene) -> f64 {
        let plain = scene.materials().iter().map(|m| m.reflectance.max_element());
        plain.fold(self.paint.brightest(), f64::max)
    }

    /// Whether patches of a triangle may differ in reflectance, exitance or covered area.
    #[inline]
    #[must_use]
    pub fn is_varied(&self, triangle: TriangleId) -> bool {
        self.paint.is_painted(triangle)
    }

    /// Memory in use for what differs from patch to patch \[bytes\].
    #[must_use]
    pub fn paint_bytes(&self) -> usize {
        self.paint.bytes()
    }

    /// The patch of a triangle in which a point lies.
    #[inline]
    #[must_use]
    pub fn patch_at(&self, triangle: TriangleId, point: Barycentric) -> PatchId {
        let within = barycentric::locate(self.divisions(triangle), point);
        PatchId(self.patches_of[triangle.index()].first + within)
    }

    /// The given side of a patch of a triangle; `None` if that side does not take part in light transport.
    #[inline]
    #[must_use]
    pub fn side_of(&self, triangle: TriangleId, patch: PatchId, side: Side) -> Option<SideId> {
        let cut = self.cuts[triangle.index()];
        let within = (patch.0 - self.patches_of[triangle.index()].first) * cut.sides();
        match side {
            Side::Front => Some(SideId(cut.first_side + within)),
            Side::Back if cut.sides == 2 => Some(SideId(cut.first_side + within + 1)),
            Side::Back => None,
        }
    }

    /// The patch of a triangle to which a side belongs.
    #[inline]
    #[must_use]
    pub fn patch_of_side(&self, triangle: TriangleId, side: SideId) -> PatchId {
        let cut = self.cuts[triangle.index()];
        PatchId(self.patches_of[triangle.index()].first + (side.0 - cut.first_side) / cut.sides())
    }

    /// The given side of the patch in which a point of a triangle lies.
    #[inline]
    #[must_use]
    pub fn side_at(&self, triangle: TriangleId, point: Barycentric, side: Side) -> Option<SideId> {
        let (front, back) = self.sides_at(triangle, point);
        match side {
            Side::Front => Some(front),
            Side::Back => back,
        }
    }

    /// Where [`sides_at`](Self::sides_at) looks a triangle up, for those who want to have it in the caches in time.
    #[inline]
    #[must_use]
    pub fn place_of(&self, triangle: TriangleId) -> &impl Sized {
        &self.cuts[triangle.index()]
    }

    /// The front and, if it takes part in light transport, the back of the patch in which a point of a triangle lies.
    #[inline]
    #[must_use]
    pub fn sides_at(&self, triangle: TriangleId, point: Barycentric) -> (SideId, Option<SideId>) {
        let cut = self.cuts[triangle.index()];
        let front = SideId(cut.first_side + barycentric::locate(cut.divisions(), point) * cut.sides());
        (front, (cut.sides == 2).then_some(SideId(front.0 + 1)))
    }

    /// Corners of a patch as points of its triangle, in the triangle's orientation. For a merged face, those
    /// of the given triangle.
    #[must_use]
    pub fn patch_corners(&self, triangle: TriangleId, patch: PatchId) -> [Barycentric; 3] {
        let first = self.patches_of[triangle.index()].first;
        barycentric::corners(self.divisions(triangle), patch.0 - first)
    }

    /// Calls `visit` once for every active side, in the order of [`SideId`], with one triangle of its patch.
    pub fn for_each_side(&self, mut visit: impl FnMut(TriangleId, PatchId, Side, SideId)) {
        for &triangle in &self.owners {
            for patch in self.patches_of(triangle).map(PatchId) {
                for side in [Side::Front, Side::Back] {
                    if let Some(id) = self.side_of(triangle, patch, side) {
                        visit(triangle, patch, side, id);
                    }
                }
            }
        }
    }

    /// The active sides whose numbers lie in `sides`, in order: a triangle and the consecutive numbers of sides of
    /// its patches, all of the same material and, gaps included, of the same area.
    pub fn sides_within(&self, sides: Range<u32>) -> impl Iterator<Item = (TriangleId, Range<u32>)> {
        let of = |triangle: TriangleId| {
            let (cut, n) = (self.cuts[triangle.index()], self.divisions(triangle));
            cut.first_side..cut.first_side + n * n * cut.sides()
        };
        let first = self.owners.partition_point(|&t| of(t).end <= sides.start);
        self.owners[first..]
            .iter()
            .map(move |&t| (t, of(t).start.max(sides.start)..of(t).end.min(sides.end)))
            .take_while(|(_, range)| !range.is_empty())
    }
}

/// Whether triangles lie in one plane and face the same way, but for what rounding of their corners does.
fn is_flat(scene: &Scene, triangles: &[TriangleId]) -> bool {
    let normal = scene.normal(triangles[0]);
    let [origin, ..] = scene.corners(triangles[0]);
    let corners = || triangles.iter().flat_map(|&t| scene.corners(t));
    let size = corners().map(|c| c.distance(origin)).fold(0.0, f64::max);
    triangles.iter().all(|&t| scene.normal(t).dot(normal) > 0.0)
        && corners().all(|c| (c - origin).dot(normal).abs() <= 1e-6 * size)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use proptest::prelude::*;
    use sir_geom::shapes::{self, Facing};
    use sir_geom::{Material, Rgb, SceneBuilder};

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
