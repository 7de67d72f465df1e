//! Sums over the sides of patches: those of each triangle, face, material or group.

use std::collections::BTreeMap;

use glam::DVec3;
use sir_geom::{Scene, Side, TriangleId};

use crate::index::SideId;
use crate::mesh::PatchMesh;

/// The parts of a scene over which the light of patches is summed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Per {
    /// Each side of each triangle.
    Triangle,
    /// Each side of each face.
    Face,
    /// Each material: all sides that it has.
    Material,
    /// Each group: all sides of its triangles.
    Group,
}

/// A part of a scene: the triangles of one sum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Part {
    /// First triangle.
    pub triangle: TriangleId,
    /// Area of its sides that reflect or emit \[m²\], including gaps.
    pub area: f64,
    /// Center of area \[m\].
    pub center: DVec3,
    /// Sum of the normals of its sides times their areas \[m²\].
    pub normal: DVec3,
}

/// The parts of a scene, and the shares of the sides of patches that lie in them.
#[derive(Clone, Debug, PartialEq)]
pub struct SideSums {
    per: Per,
    parts: Vec<Part>,
    /// Where the entries of each side begin, and their number.
    first: Vec<u32>,
    /// Part, and share of the patch.
    entries: Vec<(u32, f32)>,
}

impl SideSums {
    /// Memory per part of a side of a patch in a triangle \[bytes\], while the sums are created.
    pub const BYTES_PER_PIECE: usize = size_of::<(SideId, u32, f32)>() + size_of::<(u32, f32)>();

    /// Returns the parts of a scene, in the order of the triangles, faces, materials or groups; fronts before backs.
    ///
    /// `scene` must be the scene that was divided into these patches.
    #[must_use]
    pub fn new(scene: &Scene, mesh: &PatchMesh, per: Per) -> Self {
        let key = |t: TriangleId, side: Side| {
            let (triangle, is_back) = (scene.triangle(t), side == Side::Back);
            match per {
                Per::Triangle => (t.0, is_back),
                Per::Face => (triangle.face.0, is_back),
                Per::Material => (triangle.material.0, false),
                Per::Group => (triangle.group.0, false),
            }
        };
        let mut numbers = BTreeMap::new();
        for t in scene.triangle_ids() {
            for &side in mesh.sides_of(t) {
                let part = Part { triangle: t, area: 0.0, center: DVec3::ZERO, normal: DVec3::ZERO };
                let (_, part) = numbers.entry(key(t, side)).or_insert((0, part));
                let (area, normal) = (scene.area(t), scene.normal(t) * scene.area(t));
                let [a, b, c] = scene.corners(t);
                part.area += area;
                part.center += area * ((a + b + c) / 3.0);
                part.normal += if side == Side::Front { normal } else { -normal };
            }
        }
        for (number, (index, part)) in numbers.values_mut().enumerate() {
            *index = number as u32;
            part.center /= part.area;
        }
        let mut pieces = Vec::new();
        for t in scene.triangle_ids() {
            for &side in mesh.sides_of(t) {
                let (number, area) = (numbers[&key(t, side)].0, scene.area(t));
                mesh.for_each_piece_of(t, |patch, piece| {
                    if let Some(id) = mesh.side_of(t, patch, side) {
                        let share = area * piece.share() / mesh.patch_area(t, patch);
                        pieces.push((id, number, share as f32));
                    }
                });
            }
        }
        pieces.sort_by_key(|&(side, number, _)| (side, number));
        let (mut first, mut entries) = (vec![0; mesh.side_count() + 1], Vec::<(u32, f32)>::new());
        let mut last = None;
        for (side, number, share) in pieces {
            match entries.last_mut() {
                Some(entry) if last == Some((side, number)) => entry.1 += share,
                _ => entries.push((number, share)),
            }
            last = Some((side, number));
            first[side.index() + 1] = entries.len() as u32;
        }
        Self { per, parts: numbers.into_values().map(|(_, part)| part).collect(), first, entries }
    }

    /// Returns what the parts are.
    #[must_use]
    pub fn per(&self) -> Per {
        self.per
    }

    /// Returns the parts.
    #[must_use]
    pub fn parts(&self) -> &[Part] {
        &self.parts
    }

    /// Returns the parts in which the patch of a side lies, as indices of [`parts`](Self::parts), each with the share of the
    /// patch's area.
    #[inline]
    pub fn shares(&self, side: SideId) -> impl Iterator<Item = (usize, f64)> + '_ {
        let range = self.first[side.index()] as usize..self.first[side.index() + 1] as usize;
        self.entries[range].iter().map(|&(part, share)| (part as usize, f64::from(share)))
    }
}

#[cfg(test)]
mod tests {
    use sir_geom::shapes::{Facing, cuboid};
    use sir_geom::{Material, Rgb, SceneBuilder, Sides};

    use super::*;
    use crate::subdivision::{PatchSize, Subdivision};

    /// A box of two materials, and a two-sided sheet in a group of its own.
    fn scene() -> Scene {
        let mut builder = SceneBuilder::new();
        let [gray, white] =
            ["gray", "white"].map(|name| builder.add_material(Material::diffuse(name, Rgb::splat(0.5))));
        let sheet = builder.add_material(Material::diffuse("sheet", Rgb::splat(0.5)).with_sides(Sides::Both));
        cuboid(
            &mut builder,
            DVec3::ZERO,
            DVec3::ONE,
            [gray, gray, white, white, white, gray],
            Facing::Inward,
        );
        builder.begin_group("sheet");
        let corners = [[0.2, 0.5, 0.2], [0.8, 0.5, 0.2], [0.8, 0.5, 0.7], [0.2, 0.5, 0.7]];
        let corners = corners.map(|corner| builder.add_vertex(DVec3::from_array(corner)));
        builder.add_polygon(&corners, sheet);
        builder.build().unwrap().scene
    }

    #[test]
    fn parts_are_covered_by_the_shares_of_patches() {
        let scene = scene();
        for subdivision in [
            Subdivision::PerFace,
            Subdivision::Triangles(PatchSize::MaxArea(0.02)),
            Subdivision::Surfaces(PatchSize::MaxArea(0.02)),
        ] {
            let mesh = PatchMesh::new(&scene, subdivision).unwrap();
            for (per, count) in [(Per::Triangle, 16), (Per::Face, 8), (Per::Material, 3), (Per::Group, 2)] {
                let sums = SideSums::new(&scene, &mesh, per);
                assert_eq!(sums.parts().len(), count);
                let mut areas = vec![0.0; count];
                mesh.for_each_side(|t, patch, _, side| {
                    let shares: f64 = sums.shares(side).map(|(_, share)| share).sum();
                    assert!((shares - 1.0).abs() < 1e-6, "{shares}");
                    sums.shares(side)
                        .for_each(|(part, share)| areas[part] += share * mesh.patch_area(t, patch));
                });
                for (part, area) in sums.parts().iter().zip(areas) {
                    assert!((part.area - area).abs() < 1e-6 * area, "{per:?}: {} {area}", part.area);
                }
            }
        }
    }

    #[test]
    fn parts_have_centers_and_normals() {
        let scene = scene();
        let mesh = PatchMesh::new(&scene, Subdivision::Surfaces(PatchSize::Count(200))).unwrap();
        let faces = SideSums::new(&scene, &mesh, Per::Face);
        let [front, back] = [6, 7].map(|i| faces.parts()[i]);
        assert!(front.center.distance(DVec3::new(0.5, 0.5, 0.45)) < 1e-12 && front.center == back.center);
        assert!((front.normal.length() - 0.3).abs() < 1e-12 && front.normal == -back.normal);
        let groups = SideSums::new(&scene, &mesh, Per::Group);
        assert_eq!(groups.parts()[1].triangle.0, 12);
        assert!((groups.parts()[1].area - 0.6).abs() < 1e-12, "both sides");
    }
}
