//! Vertical walls and their arched recesses.

use std::f64::consts::PI;

use glam::DVec3;
use sir_geom::MaterialId;

use crate::model::Model;
use crate::model::sheet::lines;

/// Vertical wall seen from inside the room.
///
/// Its coordinates are `u` from its left end, `v` above the floor and `w` behind its surface, in meters.
#[derive(Clone, Copy)]
pub(crate) struct Wall {
    /// Left end of the wall, on the floor.
    pub(crate) left: DVec3,
    /// Unit vector to the right.
    pub(crate) right: DVec3,
}

impl Wall {
    /// Returns the point at (`u`, `v`, `w`) in world space.
    pub(crate) fn at(self, u: f64, v: f64, w: f64) -> DVec3 {
        self.left + u * self.right + v * DVec3::Y - w * self.right.cross(DVec3::Y)
    }

    /// Returns the points of the upper half circle about (`u`, `v`, `w`), counterclockwise from its right end.
    pub(crate) fn arc(self, [u, v, w]: [f64; 3], radius: f64, segments: usize) -> Vec<DVec3> {
        (0..=segments)
            .map(|i| {
                let (sin, cos) = (PI * i as f64 / segments as f64).sin_cos();
                self.at(u + radius * cos, v + radius * sin, w)
            })
            .collect()
    }
}

/// Returns the radii and numbers of segments of half circles from the given one down to the center, at most one cell
/// apart.
pub(crate) fn half_rings(radius: f64, segments: usize, cell: f64) -> Vec<(f64, usize)> {
    lines(radius, 0.0, -cell)
        .iter()
        .map(|&r| (r, ((segments as f64 * r / radius).round() as usize).max(1)))
        .collect()
}

impl Model {
    /// Adds the sides of a recess. `edge` is its closed outline, counterclockwise seen from the room, and `inward` is
    /// the vector from the outline to its bottom.
    pub(crate) fn recess(&mut self, edge: &[DVec3], inward: DVec3, material: MaterialId) {
        self.sheet([edge.len() - 1, 2], |i, j| edge[i] + 0.5 * j as f64 * inward, |_, _| material);
    }

    /// Adds the area between concentric half circles. A circle of radius zero is the center itself.
    pub(crate) fn half_disc(
        &mut self,
        wall: Wall,
        center: [f64; 3],
        rings: &[(f64, usize)],
        material: MaterialId,
    ) {
        for pair in rings.windows(2) {
            let [outer, inner] = [pair[0], pair[1]].map(|(r, segments)| wall.arc(center, r, segments));
            self.stitch(&outer, &inner, material);
        }
    }
}
