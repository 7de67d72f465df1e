//! Prisms with rounded ends.

use glam::{DVec2, DVec3};
use sir_geom::MaterialId;

use crate::model::Model;
use crate::model::sheet::lines;

/// Rounding of a pillow's ends, and its division along its length.
#[derive(Clone, Copy)]
pub(crate) struct Ends {
    /// Radius at the ends \[m\].
    pub(crate) radius: f64,
    /// Number of segments per quarter circle: 1 is a chamfer, and 0 (with radius 0) leaves the ends flat.
    pub(crate) pieces: usize,
    /// Maximum length of a cell between the ends \[m\].
    pub(crate) cell: f64,
    /// Distance from the corners of the section at which these are cut off \[m\]; 0 keeps them.
    pub(crate) cut: f64,
}

impl Model {
    /// Adds a solid with the given counterclockwise cross-section in the `xy` plane from `z = from` to `z = to`. Toward
    /// both ends, the section shrinks along quarter circles.
    ///
    /// The section has an even number of points. Strips between opposite points (the first and the last, the second and
    /// the second to last, and so on) close the ends. The section may be concave as long as these pairs face each
    /// other. `material` receives the index of the point at which an edge of the section begins, or `None` for the
    /// ends. A cut corner belongs to the edge after it.
    pub(crate) fn pillow(
        &mut self,
        section: &[[f64; 2]],
        [from, to]: [f64; 2],
        ends: Ends,
        material: impl Fn(Option<usize>) -> MaterialId,
    ) {
        let Ends { radius, pieces, cell, cut } = ends;
        let arc: Vec<[f64; 2]> = (0..pieces)
            .map(|i| {
                let (sin, cos) = (0.5 * std::f64::consts::PI * i as f64 / pieces as f64).sin_cos();
                [radius * (1.0 - cos.min(1.0)), radius * (1.0 - sin)]
            })
            .collect();
        // Position of each ring along z, and the distance by which its section shrinks.
        let mut rings: Vec<[f64; 2]> = arc.iter().map(|[along, inward]| [from + along, *inward]).collect();
        rings.extend(lines(from + radius, to - radius, cell).iter().map(|&z| [z, 0.0]));
        rings.extend(arc.iter().rev().map(|[along, inward]| [to - along, *inward]));
        let rings: Vec<Vec<DVec3>> = rings
            .iter()
            .map(|&[z, inward]| {
                // Shrinking comes first: later, it would reverse the short edges of cut corners.
                let mut ring = shrunk(section, inward);
                if cut > 0.0 {
                    ring = cut_corners(&ring, cut);
                }
                ring.iter().map(|p| p.extend(z)).collect()
            })
            .collect();
        let (n, per_edge) = (rings[0].len(), rings[0].len() / section.len());
        for k in 0..n {
            let at = |i: usize, j: usize| rings[j][(k + i) % n];
            self.sheet([1, rings.len() - 1], at, |_, _| material(Some(k / per_edge)));
        }
        for k in 0..n / 2 - 1 {
            let strip = [k, k + 1, n - 2 - k, n - 1 - k];
            self.polygon(&strip.map(|i| rings[rings.len() - 1][i]), material(None));
            let mirrored = [strip[3], strip[2], strip[1], strip[0]];
            self.polygon(&mirrored.map(|i| rings[0][i]), material(None));
        }
    }
}

/// Returns a counterclockwise polygon with all edges moved inward by a distance.
fn shrunk(polygon: &[[f64; 2]], distance: f64) -> Vec<DVec2> {
    let n = polygon.len();
    let point = |i: usize| DVec2::from_array(polygon[i % n]);
    let outward = |i: usize| -(point(i + 1) - point(i)).perp().normalize_or_zero();
    (0..n)
        .map(|i| {
            let (before, after) = (outward(i + n - 1), outward(i));
            point(i) - distance / (1.0 + before.dot(after)) * (before + after)
        })
        .collect()
}

/// Returns a polygon with each corner cut off at a distance of at most `cut` from it; it has twice as many points.
fn cut_corners(polygon: &[DVec2], cut: f64) -> Vec<DVec2> {
    let n = polygon.len();
    let from_corner = |i: usize, toward: usize| {
        let edge = polygon[toward % n] - polygon[i];
        polygon[i] + (cut / edge.length()).min(0.25) * edge
    };
    (0..n).flat_map(|i| [from_corner(i, i + n - 1), from_corner(i, i + 1)]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: [[f64; 2]; 4] = [[0.0, 0.0], [4.0, 0.0], [4.0, 2.0], [0.0, 2.0]];

    #[test]
    fn a_shrunk_rectangle_has_its_edges_moved() {
        let corners = [[0.5, 0.5], [3.5, 0.5], [3.5, 1.5], [0.5, 1.5]];
        assert_eq!(shrunk(&SQUARE, 0.5), corners.map(DVec2::from_array));
    }

    #[test]
    fn cut_corners_lie_on_both_sides_of_each_corner() {
        let cut = cut_corners(&SQUARE.map(DVec2::from_array), 0.75);
        let first = [[0.0, 0.5], [0.75, 0.0], [3.25, 0.0], [4.0, 0.5]];
        assert_eq!(&cut[..4], first.map(DVec2::from_array));
        assert_eq!(cut.len(), 8);
    }

    #[test]
    fn a_chamfered_block_has_the_volume_of_a_block_less_its_chamfers() {
        let mut m = Model::default();
        m.pillow(&SQUARE, [0.0, 3.0], Ends { radius: 0.5, pieces: 1, cell: 9.0, cut: 0.0 }, |_| {
            MaterialId(0)
        });
        let mut volume = 0.0;
        for (corners, _) in &m.polygons {
            for i in 2..corners.len() {
                volume += corners[0].dot(corners[i - 1].cross(corners[i])) / 6.0;
            }
        }
        // The middle, and two frusta. h / 3 (A + B + √(AB)) does not hold for rectangles that are not similar; the
        // prismoidal formula does.
        let frustum = 0.5 / 6.0 * (8.0 + 3.0 + 4.0 * 3.5 * 1.5);
        assert!((volume - (8.0 * 2.0 + 2.0 * frustum)).abs() < 1e-12, "{volume}");
    }
}
