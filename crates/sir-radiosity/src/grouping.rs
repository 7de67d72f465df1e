//! Groups of surfaces for view factors.

use sir_geom::{Scene, Side, Triangle, TriangleId};
use sir_mesh::PatchMesh;

/// The group of each triangle of a scene. Every group has a triangle, hence an area.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Grouping {
    names: Vec<String>,
    /// The group of each triangle.
    of: Vec<u32>,
}

impl Grouping {
    /// Returns one group for each material that a triangle has, in the order of their numbers. Materials may have equal
    /// names.
    #[must_use]
    pub fn by_material(scene: &Scene) -> Self {
        let names = scene.materials().iter().map(|m| m.name.as_str());
        Self::new(scene, names, |triangle| triangle.material.index())
    }

    /// Returns one group for each named part of the scene, in the order of their first triangles in the file. Triangles
    /// that are in no part form a first group without a name.
    #[must_use]
    pub fn by_part(scene: &Scene) -> Self {
        let names = scene.groups().iter().map(String::as_str);
        Self::new(scene, names, |triangle| triangle.group.index())
    }

    /// Returns those of the groups with these names to which `number` assigns a triangle.
    fn new<'a>(
        scene: &Scene,
        names: impl Iterator<Item = &'a str>,
        number: impl Fn(&Triangle) -> usize,
    ) -> Self {
        let names: Vec<&str> = names.collect();
        let mut used = vec![false; names.len()];
        scene.triangles().iter().for_each(|triangle| used[number(triangle)] = true);
        let mut next = 0;
        let numbers: Vec<u32> = used
            .iter()
            .map(|&used| {
                next += u32::from(used);
                next.saturating_sub(1)
            })
            .collect();
        let kept = names.into_iter().zip(&used).filter(|(_, used)| **used);
        Self {
            names: kept.map(|(name, _)| name.to_owned()).collect(),
            of: scene.triangles().iter().map(|triangle| numbers[number(triangle)]).collect(),
        }
    }

    /// Returns the names of the groups. The name is empty for a group without one.
    #[must_use]
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Returns the number of the group of a triangle.
    #[inline]
    #[must_use]
    pub fn group_of(&self, triangle: TriangleId) -> usize {
        self.of[triangle.index()] as usize
    }

    /// Returns the areas of the groups, in the square of the scene's unit of length. Both sides of a two-sided surface
    /// count, and only the covered area of a surface with gaps.
    #[must_use]
    pub fn areas(&self, scene: &Scene, mesh: &PatchMesh) -> Vec<f64> {
        let mut areas = vec![0.0; self.names.len()];
        for triangle in scene.triangle_ids() {
            areas[self.group_of(triangle)] += active_area(scene, mesh, triangle);
        }
        areas
    }
}

/// Returns the covered area of a triangle, counted for each of its active sides.
pub(crate) fn active_area(scene: &Scene, mesh: &PatchMesh, triangle: TriangleId) -> f64 {
    let sides = [Side::Front, Side::Back].into_iter().filter(|&side| scene.is_active(triangle, side)).count();
    sides as f64 * mesh.covered_area_of(scene, triangle)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use sir_geom::{Material, Rgb, SceneBuilder, Sides};
    use sir_mesh::Subdivision;

    #[test]
    fn groups_have_triangles_and_both_sides_count() {
        let mut b = SceneBuilder::new();
        let [one, _, both] = ["one", "unused", "both"].map(|name| {
            let sides = if name == "both" { Sides::Both } else { Sides::Front };
            b.add_material(Material::diffuse(name, Rgb::ZERO).with_sides(sides))
        });
        for (material, part) in [(both, ""), (one, "part"), (one, "other")] {
            b.begin_group(part);
            let corners = [DVec3::ZERO, DVec3::X, DVec3::Y].map(|p| b.add_vertex(p));
            b.add_polygon(&corners, material);
        }
        let scene = b.build().unwrap().scene;
        let mesh = PatchMesh::new(&scene, Subdivision::PerTriangle).unwrap();
        let materials = Grouping::by_material(&scene);
        assert_eq!(materials.names(), ["one", "both"]);
        assert_eq!(materials.areas(&scene, &mesh), [1.0, 1.0]);
        let parts = Grouping::by_part(&scene);
        assert_eq!(parts.names(), ["", "part", "other"]);
        assert_eq!(parts.areas(&scene, &mesh), [1.0, 0.5, 0.5]);
        assert!(scene.triangle_ids().map(|t| parts.group_of(t)).eq(0..3));
    }
}
