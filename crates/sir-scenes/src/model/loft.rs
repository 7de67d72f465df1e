//! Solids lofted over closed rings of points.

use glam::DVec3;
use sir_geom::MaterialId;

use crate::model::Model;

impl Model {
    /// Adds a solid lofted over rings of points.
    ///
    /// `point(i, j)` is the `j`-th of `columns` points of ring `i`, counterclockwise seen from the last ring. Fans
    /// around the centroids of the first and the last ring close the ends.
    pub(crate) fn loft(
        &mut self,
        rings: usize,
        columns: usize,
        point: impl Fn(usize, usize) -> DVec3,
        material: impl Fn(usize, usize) -> MaterialId,
    ) {
        for i in 0..rings - 1 {
            self.band([i, i + 1], columns, &point, |j| material(i, j));
        }
        for (ring, flip) in [(0, true), (rings - 1, false)] {
            let middle = (0..columns).map(|j| point(ring, j)).sum::<DVec3>() / columns as f64;
            for j in 0..columns {
                let (mut p, mut q) = (point(ring, j), point(ring, (j + 1) % columns));
                if flip {
                    (p, q) = (q, p);
                }
                self.polygon(&[p, q, middle], material(ring.min(rings - 2), j));
            }
        }
    }

    /// Adds a solid lofted over rings of points where the first ring follows the last one: a closed tube.
    pub(crate) fn endless_loft(
        &mut self,
        rings: usize,
        columns: usize,
        point: impl Fn(usize, usize) -> DVec3,
        material: MaterialId,
    ) {
        for i in 0..rings {
            self.band([i, (i + 1) % rings], columns, &point, |_| material);
        }
    }

    /// Adds the triangles between two rings.
    fn band(
        &mut self,
        [low, high]: [usize; 2],
        columns: usize,
        point: &impl Fn(usize, usize) -> DVec3,
        material: impl Fn(usize) -> MaterialId,
    ) {
        for j in 0..columns {
            let k = (j + 1) % columns;
            let [a, b, c, d] = [point(low, j), point(low, k), point(high, k), point(high, j)];
            // The shorter diagonal bends the surface less.
            let halves =
                if a.distance(c) <= b.distance(d) { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] };
            for half in halves {
                self.polygon(&half, material(j));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    /// Returns six times the volume of a model, which must be closed with its fronts outward.
    fn six_volumes(m: &Model) -> f64 {
        m.polygons
            .iter()
            .map(|(p, _)| (2..p.len()).map(|i| p[0].dot(p[i - 1].cross(p[i]))).sum::<f64>())
            .sum()
    }

    #[test]
    fn a_loft_over_squares_is_a_box() {
        let corners = [[1.0, 1.0], [1.0, -1.0], [-1.0, -1.0], [-1.0, 1.0]];
        let mut m = Model::default();
        let point = |i: usize, j: usize| DVec3::new(corners[j][0], 3.0 * i as f64, corners[j][1]);
        m.loft(2, 4, point, |_, _| MaterialId(0));
        assert_eq!(m.polygons.len(), 16);
        assert!((six_volumes(&m) / 6.0 - 12.0).abs() < 1e-12);
    }

    #[test]
    fn an_endless_loft_is_a_torus() {
        let mut m = Model::default();
        let point = |i: usize, j: usize| {
            let ((s, c), (v, u)) = ((TAU * i as f64 / 64.0).sin_cos(), (TAU * j as f64 / 32.0).sin_cos());
            DVec3::new((2.0 + 0.5 * u) * c, 0.5 * v, (2.0 + 0.5 * u) * s)
        };
        m.endless_loft(64, 32, point, MaterialId(0));
        let exact = TAU * 2.0 * (0.25 * 0.5 * TAU);
        assert!((six_volumes(&m) / 6.0 / exact - 1.0).abs() < 0.02);
    }
}
