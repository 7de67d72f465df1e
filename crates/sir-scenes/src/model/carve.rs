//! Solids extracted from signed distance functions.

use std::{array, collections::BTreeMap};

use glam::{DVec3, IVec3};
use sir_geom::MaterialId;

use crate::model::Model;

impl Model {
    /// Adds the surface of the solid where the signed distance `distance` is negative, in facets of about the size
    /// `cell`. The solid must lie within the box from `min` to `max`.
    ///
    /// The method is dual marching cubes (Nielson 2004, "Dual marching cubes"). Every grid edge that the surface
    /// crosses gets one quadrilateral that joins the four cubes around it. The corners of the quadrilateral are the
    /// means of the crossings on a cube's edges, one mean for each sheet of the surface in the cube. Where the solid
    /// would touch itself in a face of a cube, one grid point is removed from it, so that every edge of the surface
    /// joins two triangles.
    pub(crate) fn carve(
        &mut self,
        [min, max]: [DVec3; 2],
        cell: f64,
        distance: impl Fn(DVec3) -> f64,
        material: impl Fn(DVec3) -> MaterialId,
    ) {
        let size = ((max - min) / cell).ceil().as_ivec3();
        let at = |i: IVec3| min + cell * i.as_dvec3();
        let index = |i: IVec3| ((i.z * (size.y + 1) + i.y) * (size.x + 1) + i.x) as usize;
        let all = |size: IVec3| {
            (0..=size.z).flat_map(move |z| {
                (0..=size.y).flat_map(move |y| (0..=size.x).map(move |x| IVec3::new(x, y, z)))
            })
        };
        let mut field: Vec<f64> = all(size).map(|i| distance(at(i))).collect();
        while let Some(corner) = all(size - 1).find_map(|i| touching_corner(i, |corner| field[index(corner)]))
        {
            field[index(corner)] = 0.01 * cell;
        }
        let value = |i: IVec3| field[index(i)];

        let mut vertices = BTreeMap::new();
        for i in all(size - 1) {
            let inside = |corner: usize| value(i + offset(corner)) < 0.0;
            let sheets = sheets(inside);
            for sheet in 0..12 {
                let (mut sum, mut count) = (DVec3::ZERO, 0);
                for edge in (0..12).filter(|&edge| sheets[edge] == Some(sheet)) {
                    let [from, to] = ends(edge).map(|corner| i + offset(corner));
                    let (a, b) = (value(from), value(to));
                    sum += at(from).lerp(at(to), a / (a - b));
                    count += 1;
                }
                for edge in (0..12).filter(|&edge| sheets[edge] == Some(sheet)) {
                    vertices.insert((index(i), edge), sum / f64::from(count));
                }
            }
        }
        for i in all(size - 1) {
            for axis in 0..3 {
                let (a, b) = (value(i), value(i + AXES[axis]));
                if (a < 0.0) == (b < 0.0) {
                    continue;
                }
                let (u, v) = (AXES[(axis + 1) % 3], AXES[(axis + 2) % 3]);
                // The four cubes around the edge, and the number that the edge has among those of its axis in each.
                let around = [(i - u - v, 3), (i - v, 2), (i, 0), (i - u, 1)]
                    .map(|(cube, place)| vertices.get(&(index(cube), 4 * axis + place)).copied());
                if let [Some(p), Some(q), Some(r), Some(s)] = around {
                    let [q, s] = if a < 0.0 { [q, s] } else { [s, q] };
                    let halves = if p.distance(r) <= q.distance(s) {
                        [[p, q, r], [p, r, s]]
                    } else {
                        [[p, q, s], [q, r, s]]
                    };
                    let middle = 0.25 * (p + q + r + s);
                    for half in halves {
                        self.polygon(&half, material(middle));
                    }
                }
            }
        }
    }
}

const AXES: [IVec3; 3] = [IVec3::X, IVec3::Y, IVec3::Z];

/// Returns the position of a corner of a cube relative to the cube. The corner number has one bit per axis.
fn offset(corner: usize) -> IVec3 {
    let bit = |axis: usize| (corner >> axis & 1) as i32;
    IVec3::new(bit(0), bit(1), bit(2))
}

/// Returns the two corners at the ends of an edge.
///
/// Four edges run along each axis. Their numbers have one bit for each of the next two axes.
fn ends(edge: usize) -> [usize; 2] {
    let (axis, u, v) = (edge / 4, edge & 1, edge >> 1 & 1);
    let low = u << ((axis + 1) % 3) | v << ((axis + 2) % 3);
    [low, low | 1 << axis]
}

/// Returns a corner in which the solid touches itself at a face of the cube `i`.
///
/// This is the case if two opposite corners of a face are inside and the other two outside. The result is the inside
/// corner that is closer to the surface.
fn touching_corner(i: IVec3, value: impl Fn(IVec3) -> f64) -> Option<IVec3> {
    (0..3).find_map(|axis| {
        let (u, v) = (AXES[(axis + 1) % 3], AXES[(axis + 2) % 3]);
        let face = [i, i + u, i + u + v, i + v];
        let [a, b, c, d] = face.map(|corner| value(corner) < 0.0);
        let inside = match (a && c && !b && !d, b && d && !a && !c) {
            (true, _) => [face[0], face[2]],
            (_, true) => [face[1], face[3]],
            _ => return None,
        };
        inside.into_iter().max_by(|p, q| value(*p).total_cmp(&value(*q)))
    })
}

/// Returns the sheet of the surface to which the crossing on each edge of a cube belongs; `None` for edges that are not
/// crossed.
fn sheets(inside: impl Fn(usize) -> bool) -> [Option<usize>; 12] {
    let mut sheet: [Option<usize>; 12] = array::from_fn(|edge| {
        let [a, b] = ends(edge);
        (inside(a) != inside(b)).then_some(edge)
    });
    let mut join = |a: usize, b: usize| {
        if let (Some(to), from @ Some(_)) = (sheet[a], sheet[b]) {
            sheet.iter_mut().filter(|s| **s == from).for_each(|s| *s = Some(to));
        }
    };
    for axis in 0..3 {
        for side in 0..2 {
            let crossed: Vec<usize> = (0..12)
                .filter(|&edge| {
                    let [a, b] = ends(edge);
                    a >> axis & 1 == side && b >> axis & 1 == side && inside(a) != inside(b)
                })
                .collect();
            if let [a, b] = crossed[..] {
                join(a, b);
            }
        }
    }
    sheet
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_carved_ball_encloses_the_volume_of_a_ball() {
        let mut m = Model::default();
        let bounds = [DVec3::splat(-1.13), DVec3::splat(1.13)];
        m.carve(bounds, 0.05, |p| p.length() - 1.0, |_| MaterialId(0));
        let six: f64 = m.polygons.iter().map(|(p, _)| p[0].dot(p[1].cross(p[2]))).sum();
        // The mean of points on a sphere lies inside it: cells of a tenth of the radius lose 1 % of the volume, and
        // cells half as large lose a quarter of that.
        let exact = 4.0 / 3.0 * std::f64::consts::PI;
        assert!((0.995..1.0).contains(&(six / 6.0 / exact)), "{}", six / 6.0);
    }

    #[test]
    fn bodies_that_nearly_touch_still_have_two_triangles_at_every_edge() {
        for step in 0..12 {
            let apart = DVec3::new(0.5, 0.45, 0.4) * (1.0 + 0.02 * f64::from(step));
            let balls = |p: DVec3| (p - apart).length().min((p + apart).length()) - 0.8;
            let mut m = Model::default();
            m.carve([DVec3::splat(-1.61), DVec3::splat(1.63)], 0.12, balls, |_| MaterialId(0));
            let mut edges: BTreeMap<[[u64; 3]; 2], i32> = BTreeMap::new();
            for (p, _) in &m.polygons {
                let p: Vec<_> = p.iter().map(|p| p.to_array().map(f64::to_bits)).collect();
                for i in 0..3 {
                    *edges.entry([p[i], p[(i + 1) % 3]]).or_default() += 1;
                }
            }
            for (&[a, b], &count) in &edges {
                assert_eq!((count, edges.get(&[b, a])), (1, Some(&1)), "step {step}");
            }
        }
    }
}
