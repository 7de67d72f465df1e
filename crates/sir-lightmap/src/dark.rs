//! Surfaces without light, such as the outsides of a closed room.
//!
//! A few patches may have no light by chance. So a surface counts as dark only if no light falls on all that is connected
//! with it, and that has several patches. Then the layout does not depend on the noise of a run.

use sir_geom::{Rgb, Side};
use sir_mesh::SideId;

use crate::connected::{Sets, numbers};
use crate::objects::{Objects, Primitive};
use crate::options::LightmapSides;
use crate::solution::Solution;

/// Number of patches from which on a connected surface without light is dark.
const FEWEST_PATCHES: f64 = 4.0;

/// Sides of the triangles of all meshes on which no light falls.
pub(crate) struct Dark {
    /// For each mesh and primitive, the connected surface of each triangle.
    surfaces: Vec<Vec<Vec<u32>>>,
    /// Front and back of each connected surface.
    sides: Vec<[Lit; 2]>,
}

/// Light on one side of a connected surface.
#[derive(Clone, Copy, Default)]
struct Lit {
    patches: f64,
    has_light: bool,
}

impl Dark {
    pub(crate) fn new(objects: &Objects, solution: &Solution<'_>, sides: LightmapSides) -> Self {
        let Solution { scene, mesh, irradiance, direct, .. } = *solution;
        let mut count = 0;
        let surfaces: Vec<Vec<Vec<u32>>> = objects
            .meshes
            .iter()
            .map(|mesh| mesh.primitives.iter().map(|primitive| surfaces(primitive, &mut count)).collect())
            .collect();
        let mut dark = Self { surfaces, sides: vec![[Lit::default(); 2]; count as usize] };
        let has_light = |side: SideId| {
            let has = |values: &[Rgb]| values[side.index()].max_element() > 0.0;
            has(irradiance) || direct.is_some_and(has)
        };
        for t in scene.triangle_ids() {
            let Some((of, primitive, number)) = objects.locate(t) else { continue };
            let surface = dark.surfaces[of][primitive][number] as usize;
            let area = scene.area(t);
            mesh.for_each_piece_of(t, |patch, piece| {
                for &side in mesh.sides_of(t) {
                    let Some(id) = mesh.side_of(t, patch, side) else { continue };
                    // Both sides may have the same texels.
                    let is_front = side == Side::Front || sides == LightmapSides::Mean;
                    let lit = &mut dark.sides[surface][usize::from(!is_front)];
                    lit.patches += area * piece.share() / mesh.patch_area(t, patch);
                    // Lamps are seen from both of their sides, too.
                    lit.has_light |= has_light(id) || scene.exitance(t, side) != Rgb::ZERO;
                }
            });
        }
        dark
    }

    /// Returns true if no light falls on a side of the connected surface of a triangle.
    pub(crate) fn is_dark(&self, mesh: usize, side: Side, primitive: usize, number: usize) -> bool {
        let surface = self.surfaces[mesh][primitive][number] as usize;
        let lit = self.sides[surface][usize::from(side == Side::Back)];
        !lit.has_light && lit.patches >= FEWEST_PATCHES
    }
}

/// Returns the number of the connected surface of each triangle: triangles that share a position. `count` is the number of
/// surfaces so far.
fn surfaces(primitive: &Primitive, count: &mut u32) -> Vec<u32> {
    let (points, all) = numbers(primitive.positions.iter().map(|p| p.map(|x| (x + 0.0).to_bits())));
    let mut sets = Sets::new(all);
    primitive.triangles.iter().for_each(|t| sets.join(t.map(|v| points[v as usize])));
    let (surfaces, found) = numbers(primitive.triangles.iter().map(|t| sets.root(points[t[0] as usize])));
    let first = *count;
    *count += found;
    surfaces.into_iter().map(|surface| first + surface).collect()
}
