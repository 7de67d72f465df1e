//! Prisms: solids with a constant cross-section.

use glam::{DVec2, DVec3};
use sir_geom::MaterialId;

use crate::model::Model;
use crate::model::sheet::lines;

impl Model {
    /// Adds a prism with the given simple, counterclockwise cross-section in the `xy` plane from `z = from` to
    /// `z = to`, in slices of at most `cell` \[m\].
    pub(crate) fn prism(
        &mut self,
        section: &[[f64; 2]],
        [from, to]: [f64; 2],
        cell: f64,
        material: MaterialId,
    ) {
        let z = lines(from, to, cell);
        let at = |[x, y]: [f64; 2], z: f64| DVec3::new(x, y, z);
        for (i, &p) in section.iter().enumerate() {
            let q = section[(i + 1) % section.len()];
            self.sheet([1, z.len() - 1], |i, j| at(if i == 0 { p } else { q }, z[j]), |_, _| material);
        }
        for triangle in cut_ears(section) {
            let [a, b, c] = triangle.map(|i| section[i]);
            self.polygon(&[at(a, to), at(b, to), at(c, to)], material);
            self.polygon(&[at(c, from), at(b, from), at(a, from)], material);
        }
    }
}

/// Triangulates a simple counterclockwise polygon by ear clipping (Meisters 1975, "Polygons have ears").
///
/// Repeatedly cuts off a convex corner whose triangle contains no other corner. Returns the corner indices of the
/// triangles.
fn cut_ears(polygon: &[[f64; 2]]) -> Vec<[usize; 3]> {
    let point = |i: usize| DVec2::from_array(polygon[i]);
    let turns_left = |a: usize, b: usize, c: usize| (point(b) - point(a)).perp_dot(point(c) - point(b));
    let mut left: Vec<usize> = (0..polygon.len()).collect();
    let mut triangles = Vec::new();
    while left.len() >= 3 {
        let n = left.len();
        let ear = (0..n).find(|&i| {
            let [a, b, c] = [left[(i + n - 1) % n], left[i], left[(i + 1) % n]];
            turns_left(a, b, c) > 0.0
                && left.iter().filter(|&&p| p != a && p != b && p != c).all(|&p| {
                    turns_left(a, b, p) < 0.0 || turns_left(b, c, p) < 0.0 || turns_left(c, a, p) < 0.0
                })
        });
        // A simple polygon always has an ear; rounding may hide it where corners are collinear.
        let i = ear.unwrap_or(0);
        triangles.push([left[(i + n - 1) % n], left[i], left[(i + 1) % n]]);
        left.remove(i);
    }
    triangles
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ears_cover_a_hollow_polygon_once() {
        // A trough: a rectangle 4 by 3 with a slot 2 by 2 from above.
        let trough =
            [[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [3.0, 3.0], [3.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]];
        let areas: Vec<f64> = cut_ears(&trough)
            .iter()
            .map(|t| {
                let [a, b, c] = t.map(|i| DVec2::from_array(trough[i]));
                0.5 * (b - a).perp_dot(c - a)
            })
            .collect();
        assert_eq!(areas.len(), 6);
        assert!(areas.iter().all(|a| *a > 0.0), "{areas:?}");
        assert_eq!(areas.iter().sum::<f64>(), 8.0);
    }
}
