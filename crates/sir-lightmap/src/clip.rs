//! Convex polygons in the plane, cut by lines and by the grid of texels.

use glam::DVec2;

/// Convex polygons that are cut again and again, without an allocation for each.
#[derive(Default)]
pub(crate) struct Clipper {
    rest: Vec<DVec2>,
    row: Vec<DVec2>,
    cell: Vec<DVec2>,
    spare: Vec<DVec2>,
}

impl Clipper {
    /// Calls `visit` with the column, the row, the area and the centroid of each part of a convex polygon that lies in one
    /// texel. Texel `(0, 0)` is the square from 0 to 1.
    pub(crate) fn for_each_texel(&mut self, polygon: &[DVec2], mut visit: impl FnMut(i64, i64, f64, DVec2)) {
        let Self { rest, row, cell, spare } = self;
        let (low, high) = extent(polygon);
        if !(low.is_finite() && high.is_finite()) {
            return;
        }
        rest.clear();
        rest.extend_from_slice(polygon);
        let mut y = low.y.floor();
        while y < high.y {
            match y + 1.0 < high.y {
                true => split(rest, DVec2::Y, y + 1.0, row, spare),
                false => std::mem::swap(row, rest),
            }
            let (left, right) = extent(row);
            let mut x = left.x.floor();
            while !row.is_empty() && x < right.x {
                match x + 1.0 < right.x {
                    true => split(row, DVec2::X, x + 1.0, cell, spare),
                    false => std::mem::swap(cell, row),
                }
                let (area, centroid) = area_and_centroid(cell);
                if area > 0.0 {
                    visit(x as i64, y as i64, area, centroid);
                }
                x += 1.0;
            }
            y += 1.0;
        }
    }
}

/// Keeps the part of a polygon beyond a line in `rest`, and moves the part before it to `before`: where the product with
/// `axis` is less than `at`.
fn split(rest: &mut Vec<DVec2>, axis: DVec2, at: f64, before: &mut Vec<DVec2>, spare: &mut Vec<DVec2>) {
    before.clear();
    spare.clear();
    for (i, &p) in rest.iter().enumerate() {
        let next = rest[(i + 1) % rest.len()];
        let (d, e) = (p.dot(axis) - at, next.dot(axis) - at);
        if d <= 0.0 {
            before.push(p);
        }
        if d >= 0.0 {
            spare.push(p);
        }
        if d * e < 0.0 {
            let cut = p.lerp(next, d / (d - e));
            before.push(cut);
            spare.push(cut);
        }
    }
    std::mem::swap(rest, spare);
}

/// Cuts a convex polygon by a triangle of either orientation, and leaves the common part in `polygon`.
pub(crate) fn intersect(polygon: &mut Vec<DVec2>, triangle: [DVec2; 3], spare: &mut Vec<DVec2>) {
    let [a, b, c] = triangle;
    let sign = (b - a).perp_dot(c - a).signum();
    for (from, to) in [(a, b), (b, c), (c, a)] {
        let inside = |p: DVec2| sign * (to - from).perp_dot(p - from);
        spare.clear();
        for (i, &p) in polygon.iter().enumerate() {
            let next = polygon[(i + 1) % polygon.len()];
            let (d, e) = (inside(p), inside(next));
            if d >= 0.0 {
                spare.push(p);
            }
            if d * e < 0.0 {
                spare.push(p.lerp(next, d / (d - e)));
            }
        }
        std::mem::swap(polygon, spare);
    }
}

/// Returns the area of a convex polygon of either orientation, and its centroid.
pub(crate) fn area_and_centroid(polygon: &[DVec2]) -> (f64, DVec2) {
    let Some(&first) = polygon.first() else { return (0.0, DVec2::ZERO) };
    let (mut twice, mut moment) = (0.0, DVec2::ZERO);
    for pair in polygon[1..].windows(2) {
        let (u, v) = (pair[0] - first, pair[1] - first);
        let part = u.perp_dot(v);
        twice += part;
        moment += part * (u + v);
    }
    let centroid = if twice == 0.0 { first } else { first + moment / (3.0 * twice) };
    (0.5 * twice.abs(), centroid)
}

fn extent(polygon: &[DVec2]) -> (DVec2, DVec2) {
    let low = polygon.iter().copied().fold(DVec2::INFINITY, DVec2::min);
    let high = polygon.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
    (low, high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_in_texels_add_up_to_the_polygon() {
        let polygon =
            [DVec2::new(-2.3, 0.4), DVec2::new(3.7, -1.9), DVec2::new(6.2, 4.0), DVec2::new(1.0, 5.25)];
        for turned in [false, true] {
            let mut corners = polygon;
            if turned {
                corners.reverse();
            }
            let (mut sum, mut moment) = (0.0, DVec2::ZERO);
            Clipper::default().for_each_texel(&corners, |x, y, area, at| {
                let low = DVec2::new(x as f64, y as f64);
                assert!(at.cmpge(low - 1e-12).all() && at.cmple(low + 1.0 + 1e-12).all(), "{at} in {low}");
                assert!(area <= 1.0 + 1e-12);
                sum += area;
                moment += area * at;
            });
            let (area, centroid) = area_and_centroid(&corners);
            assert!((sum - area).abs() < 1e-12 && (moment / sum).distance(centroid) < 1e-12);
        }
    }

    #[test]
    fn the_common_part_does_not_depend_on_orientations() {
        let square = vec![DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y];
        let triangle = [DVec2::new(0.5, 0.5), DVec2::new(2.0, 0.5), DVec2::new(0.5, 2.0)];
        for flipped in [false, true] {
            let [a, b, c] = triangle;
            let mut common = square.clone();
            intersect(&mut common, if flipped { [a, c, b] } else { triangle }, &mut Vec::new());
            let (area, centroid) = area_and_centroid(&common);
            assert!((area - 0.25).abs() < 1e-12 && centroid.distance(DVec2::splat(0.75)) < 1e-12);
        }
        let mut apart = square;
        intersect(&mut apart, triangle.map(|p| p + 5.0), &mut Vec::new());
        assert_eq!(area_and_centroid(&apart).0, 0.0);
    }
}
