//! Surfaces without light, such as the outsides of a closed room.

use sir_geom::Side;

use crate::objects::Objects;
use crate::options::LightmapSides;
use crate::solution::Solution;

/// Sides of the triangles of all meshes that have light.
pub(crate) struct Dark {
    /// For each mesh and primitive, flags of each triangle: 1 for light on the front, 2 on the back.
    lit: Vec<Vec<Vec<u8>>>,
}

impl Dark {
    pub(crate) fn new(objects: &Objects, solution: &Solution<'_>, sides: LightmapSides) -> Self {
        let Solution { scene, mesh, irradiance, direct, .. } = *solution;
        let mut lit: Vec<Vec<Vec<u8>>> = objects
            .meshes
            .iter()
            .map(|mesh| mesh.primitives.iter().map(|p| vec![0; p.triangles.len()]).collect())
            .collect();
        let is_lit = |side: sir_mesh::SideId| {
            let has = |values: &[sir_geom::Rgb]| values[side.index()].max_element() > 0.0;
            has(irradiance) || direct.is_some_and(has)
        };
        for t in scene.triangle_ids() {
            let Some((of, primitive, number)) = objects.locate(t) else { continue };
            let flags = &mut lit[of][primitive][number];
            mesh.for_each_piece_of(t, |patch, _| {
                for &side in mesh.sides_of(t) {
                    if mesh.side_of(t, patch, side).is_some_and(is_lit) {
                        // Both sides may have the same texels.
                        let is_front = side == Side::Front || sides == LightmapSides::Mean;
                        *flags |= if is_front { 1 } else { 2 };
                    }
                }
            });
        }
        Self { lit }
    }

    /// Returns true if no light falls on a side of a triangle.
    pub(crate) fn is_dark(&self, mesh: usize, side: Side, primitive: usize, number: usize) -> bool {
        self.lit[mesh][primitive][number] & (if side == Side::Front { 1 } else { 2 }) == 0
    }
}
