//! Convex hull of coplanar points.

use glam::DVec3;

use crate::hull::grid::winding;

/// Returns the facets of the hull: the triangles of both sides of a polygon, as indices of points. `base` is a
/// non-degenerate triangle.
pub(super) fn facets(points: &[DVec3], base: [u32; 3]) -> Vec<[u32; 3]> {
    let [a, b, c] = base.map(|i| points[i as usize]);
    let polygon = polygon(points, winding(a, b, c));
    let fan = polygon.windows(2).skip(1).map(|edge| [polygon[0], edge[0], edge[1]]);
    fan.flat_map(|[a, b, c]| [[a, b, c], [c, b, a]]).collect()
}

/// Returns the corners of the hull in order, by the monotone chain algorithm (Andrew 1979): one chain from the first
/// point to the last in the order of coordinates, and one back.
fn polygon(points: &[DVec3], normal: [i128; 3]) -> Vec<u32> {
    // Projected along the axis that is nearest to the normal, distinct points of the plane remain distinct.
    let axis = (0..3).max_by_key(|&k| normal[k].abs()).unwrap_or(2);
    let projected = |i: u32| {
        let p = points[i as usize];
        [p[(axis + 1) % 3], p[(axis + 2) % 3]]
    };
    let left_turn = |a: u32, b: u32, c: u32| {
        winding(points[a as usize], points[b as usize], points[c as usize])[axis] > 0
    };
    let mut order: Vec<u32> = (0..points.len() as u32).collect();
    order.sort_by(|&i, &j| {
        let ([x, y], [u, v]) = (projected(i), projected(j));
        x.total_cmp(&u).then(y.total_cmp(&v))
    });
    let mut polygon: Vec<u32> = Vec::new();
    let back: Vec<u32> = order.iter().rev().copied().collect();
    for chain in [order, back] {
        let start = polygon.len();
        for i in chain {
            while polygon.len() >= start + 2
                && !left_turn(polygon[polygon.len() - 2], polygon[polygon.len() - 1], i)
            {
                polygon.pop();
            }
            polygon.push(i);
        }
        // The last corner is the first one of the next chain.
        polygon.pop();
    }
    polygon
}
