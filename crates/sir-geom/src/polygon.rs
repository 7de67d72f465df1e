//! Triangulation of polygons.
//!
//! Most polygons in files are convex. Those are cut in halves, and the halves again, so that no corner belongs to more
//! triangles than the logarithm of their number. (In a fan from one corner, all triangles overlap there, and trees over
//! them are slow.) Others are triangulated by ear clipping (Meisters 1975), piece by piece if they have many corners:
//! curves that have been rounded are convex only at a distance. All corners remain corners of triangles, also those in
//! the middle of a straight edge: a neighbor may have a corner there, and a crack would open if only one of the two had
//! it.

use glam::{DVec2, DVec3};

/// Maximum number of corners for ear clipping, whose time is quadratic.
const MAX_CORNERS: usize = 4096;

/// Numbers of edges up to which a piece of a polygon is not halved, in the order in which they are tried. Triangles
/// have two edges of the outline.
const PIECES: [usize; 3] = [2, 64, MAX_CORNERS - 1];

/// Maximum number of searches over all remaining corners when none is known to be an ear. Only corners that touch edges
/// make such searches necessary.
const MAX_SEARCHES: usize = 16;

/// A triangle is degenerate if its doubled area is at most this fraction of the square of its longest edge.
pub(crate) const MIN_RELATIVE_AREA: f64 = 1e-12;

/// Triangulation of a polygon.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Cut {
    /// Corner indices of the triangles, two triangles fewer than corners. The triangles are counterclockwise seen from
    /// where the polygon is.
    pub(crate) triangles: Vec<[usize; 3]>,
    /// True if the triangles cover exactly the polygon. Otherwise they are a fan, because the outline crosses itself or
    /// has too many corners.
    pub(crate) is_valid: bool,
}

/// Returns triangles that cover an approximately flat polygon, as indices of its corners, two fewer than corners. Its corners
/// and those of the triangles run counterclockwise seen from the front. Triangles may overlap if the outline crosses itself.
#[must_use]
pub fn triangulate(corners: &[DVec3]) -> Vec<[usize; 3]> {
    cut(corners).triangles
}

/// Triangulates an approximately flat polygon whose outline is counterclockwise seen from its front.
pub(crate) fn cut(corners: &[DVec3]) -> Cut {
    let fan: Vec<_> = (2..corners.len()).map(|i| [0, i - 1, i]).collect();
    let normal = normal(corners);
    if corners.len() <= 3 || !normal.is_finite() {
        return Cut { triangles: fan, is_valid: true };
    }
    if normal == DVec3::ZERO {
        // The outline is a line, or runs as far clockwise as counterclockwise.
        let is_valid =
            fan.iter().all(|t| (corners[t[1]] - corners[0]).cross(corners[t[2]] - corners[0]) == DVec3::ZERO);
        return Cut { triangles: fan, is_valid };
    }
    let flat: Vec<DVec2> = corners.iter().map(|&p| project(p - corners[0], normal)).collect();
    let is_valid = |triangles: &[[usize; 3]]| triangles.iter().all(|&t| turns_left(t.map(|i| flat[i])));
    let is_fan = is_valid(&fan);
    if corners.len() == 4 && is_fan {
        return Cut { triangles: fan, is_valid: true };
    }
    // A quadrilateral has no better triangulation.
    for &edges in PIECES.iter().skip(usize::from(corners.len() == 4)) {
        // Ear clipping of the whole outline also finds triangulations in which some triangles have no area.
        let is_whole = edges >= corners.len() - 1;
        let tiles = |found: &Vec<[usize; 3]>| (is_whole || is_valid(found)) && covers(found, &flat);
        if let Some(triangles) = halves(&flat, edges).filter(tiles) {
            return Cut { triangles, is_valid: true };
        }
        if is_whole {
            break;
        }
    }
    Cut { triangles: fan, is_valid: is_fan }
}

/// Cuts a polygon in halves until each piece has at most `edges` edges of the outline, and clips the ears of the pieces.
/// Returns `None` if that is impossible.
fn halves(flat: &[DVec2], edges: usize) -> Option<Vec<[usize; 3]>> {
    let mut triangles = Vec::with_capacity(flat.len() - 2);
    // Pieces: the corners from the first to the last one.
    let mut waiting = vec![(0, flat.len() - 1)];
    while let Some((first, last)) = waiting.pop() {
        if last - first == 2 {
            triangles.push([first, first + 1, last]);
        } else if last - first <= edges {
            let ears = Ring::new(&flat[first..=last]).cut()?;
            triangles.extend(ears.iter().map(|t| t.map(|i| first + i)));
        } else {
            let middle = first.midpoint(last);
            let triangle = [first, middle, last];
            if !turns_left(triangle.map(|i| flat[i])) {
                return None;
            }
            triangles.push(triangle);
            waiting.extend([(middle, last), (first, middle)].iter().filter(|(a, b)| b - a > 1));
        }
    }
    Some(triangles)
}

/// Returns a vector in the direction of the normal: the sum of cross products (Newell).
pub(crate) fn normal(corners: &[DVec3]) -> DVec3 {
    let Some(&first) = corners.first() else { return DVec3::ZERO };
    corners.windows(2).map(|edge| (edge[0] - first).cross(edge[1] - first)).sum()
}

/// Projects a point along the axis in which the normal is largest, seen from where the normal points. Dropping a
/// coordinate is exact, and makes no area zero that was not.
fn project(p: DVec3, normal: DVec3) -> DVec2 {
    let n = normal.abs();
    let (q, sign) = if n.x >= n.y && n.x >= n.z {
        (DVec2::new(p.y, p.z), normal.x)
    } else if n.y >= n.z {
        (DVec2::new(p.z, p.x), normal.y)
    } else {
        (DVec2::new(p.x, p.y), normal.z)
    };
    if sign < 0.0 { DVec2::new(q.y, q.x) } else { q }
}

/// Returns twice the area, negative if the corners run clockwise.
fn doubled_area([a, b, c]: [DVec2; 3]) -> f64 {
    (b - a).perp_dot(c - a)
}

fn turns_left(t @ [a, b, c]: [DVec2; 3]) -> bool {
    let longest = a.distance_squared(b).max(b.distance_squared(c)).max(c.distance_squared(a));
    doubled_area(t) > MIN_RELATIVE_AREA * longest
}

/// Returns true if the triangles have the area of the outline, so that none lies outside or overlaps another.
fn covers(triangles: &[[usize; 3]], flat: &[DVec2]) -> bool {
    let fan: f64 = (2..flat.len()).map(|i| doubled_area([flat[0], flat[i - 1], flat[i]])).sum();
    let parts: f64 = triangles.iter().map(|t| doubled_area(t.map(|i| flat[i])).abs()).sum();
    (parts - fan).abs() <= 1e-9 * fan.abs()
}

/// Remaining outline.
struct Ring<'p> {
    points: &'p [DVec2],
    /// Neighbors of each remaining corner.
    previous: Vec<usize>,
    next: Vec<usize>,
    /// True for each corner that is known to be an ear.
    ear: Vec<bool>,
    /// Corners that do not turn left, or did not at first: only these can lie in an ear.
    reflex: Vec<usize>,
    removed: Vec<bool>,
}

impl<'p> Ring<'p> {
    fn new(points: &'p [DVec2]) -> Self {
        let n = points.len();
        let mut ring = Self {
            points,
            previous: (0..n).map(|i| (i + n - 1) % n).collect(),
            next: (0..n).map(|i| (i + 1) % n).collect(),
            ear: vec![false; n],
            reflex: Vec::new(),
            removed: vec![false; n],
        };
        ring.reflex = (0..n).filter(|&i| !turns_left(ring.corner(i))).collect();
        ring
    }

    fn corner(&self, i: usize) -> [DVec2; 3] {
        [self.previous[i], i, self.next[i]].map(|k| self.points[k])
    }

    /// Returns true if a corner turns left, and no other corner lies in its triangle or on an edge of it.
    fn is_ear(&self, i: usize) -> bool {
        let triangle @ [a, b, c] = self.corner(i);
        let inside = |p: DVec2| {
            [[a, b, p], [b, c, p], [c, a, p]].into_iter().all(|t| doubled_area(t) >= 0.0)
                // Coincident corners do not count: an outline touches itself where a cut leads to a hole.
                && p != a
                && p != c
        };
        let own = [self.previous[i], i, self.next[i]];
        turns_left(triangle)
            && !self.reflex.iter().any(|&k| !self.removed[k] && !own.contains(&k) && inside(self.points[k]))
    }

    /// Removes ear after ear; returns `None` if there is no ear although the outline has an area.
    fn cut(mut self) -> Option<Vec<[usize; 3]>> {
        let n = self.points.len();
        let mut triangles = Vec::with_capacity(n - 2);
        let (mut at, mut rounds) = (0, 0);
        for left in (3..=n).rev() {
            let mut looked = 0;
            while !self.ear[at] {
                at = self.next[at];
                looked += 1;
                if looked == left {
                    rounds += 1;
                    looked = 0;
                    if rounds > MAX_SEARCHES || !self.find_ears(at) {
                        return self.is_line(at).then(|| self.fan(at, triangles));
                    }
                }
            }
            let (previous, next) = (self.previous[at], self.next[at]);
            triangles.push([previous, at, next]);
            self.removed[at] = true;
            (self.next[previous], self.previous[next]) = (next, previous);
            for corner in [previous, next] {
                self.ear[corner] = self.is_ear(corner);
            }
            // Continues at every other corner, so that the triangles do not all share one corner.
            at = self.next[next];
        }
        Some(triangles)
    }

    /// Looks for ears among all remaining corners, and returns true if there are any.
    fn find_ears(&mut self, start: usize) -> bool {
        let mut found = false;
        let mut at = start;
        loop {
            self.ear[at] = self.is_ear(at);
            found |= self.ear[at];
            at = self.next[at];
            if at == start {
                return found;
            }
        }
    }

    /// Returns true if the remaining outline has no area.
    fn is_line(&self, start: usize) -> bool {
        let mut at = start;
        loop {
            let [a, b, c] = self.corner(at);
            let longest = a.distance_squared(b).max(b.distance_squared(c)).max(c.distance_squared(a));
            if doubled_area([a, b, c]).abs() > MIN_RELATIVE_AREA * longest {
                return false;
            }
            at = self.next[at];
            if at == start {
                return true;
            }
        }
    }

    /// Adds the remaining outline as a fan of triangles without an area.
    fn fan(&self, start: usize, mut triangles: Vec<[usize; 3]>) -> Vec<[usize; 3]> {
        let mut at = self.next[start];
        while self.next[at] != start {
            triangles.push([start, at, self.next[at]]);
            at = self.next[at];
        }
        triangles
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn at(points: &[[f64; 2]]) -> Vec<DVec3> {
        points.iter().map(|&[x, y]| DVec3::new(x, y, 0.0)).collect()
    }

    /// Returns the number of triangles that contain a point, which is on no edge.
    fn layers(cut: &Cut, corners: &[DVec3], p: DVec2) -> usize {
        let inside = |t: &&[usize; 3]| {
            let [a, b, c] = t.map(|i| corners[i].truncate());
            [[a, b, p], [b, c, p], [c, a, p]].into_iter().all(|t| doubled_area(t) > 0.0)
        };
        cut.triangles.iter().filter(inside).count()
    }

    /// Returns true if a point is inside an outline, by the parity of crossings.
    fn is_inside(corners: &[DVec3], p: DVec2) -> bool {
        let mut inside = false;
        for (i, a) in corners.iter().enumerate() {
            let b = corners[(i + 1) % corners.len()];
            if (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x) {
                inside = !inside;
            }
        }
        inside
    }

    /// Asserts that every point of the plane lies in one triangle if it is inside, and in none if it is not.
    fn assert_tiles(corners: &[DVec3]) {
        let found = cut(corners);
        assert!(found.is_valid && found.triangles.len() == corners.len() - 2, "{found:?}");
        for i in 0..40 {
            for k in 0..40 {
                let p = DVec2::new(f64::from(i) + 0.513, f64::from(k) + 0.491) * 0.1 - 2.0;
                assert_eq!(layers(&found, corners, p), usize::from(is_inside(corners, p)), "{p}");
            }
        }
    }

    /// Returns the corners of a regular polygon, rounded to a multiple of `step`.
    fn circle(corners: u32, step: f64) -> Vec<DVec3> {
        let angle = |i: u32| std::f64::consts::TAU * f64::from(i) / f64::from(corners);
        let round = |x: f64| if step > 0.0 { (x / step).round() * step } else { x };
        (0..corners).map(|i| DVec3::new(round(angle(i).cos()), round(angle(i).sin()), 0.0)).collect()
    }

    #[test]
    fn convex_polygons_are_cut_in_halves() {
        let quad = at(&[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]]);
        assert_eq!(cut(&quad).triangles, [[0, 1, 2], [0, 2, 3]]);
        let pentagon = at(&[[0.0, 0.0], [2.0, 0.0], [2.5, 1.0], [1.0, 2.0], [-0.5, 1.0]]);
        assert_eq!(cut(&pentagon).triangles, [[0, 2, 4], [0, 1, 2], [2, 3, 4]]);
        for corners in [5, 6, 17, 64] {
            assert_tiles(&circle(corners, 0.0));
        }
    }

    /// No corner of a circle belongs to many triangles, also if its coordinates have six digits and it is not convex.
    #[test]
    fn circles_of_many_corners_are_balanced() {
        for (corners, step) in [(720, 0.0), (100_000, 0.0), (5_000, 1e-6), (100_000, 1e-6)] {
            let circle = circle(corners, step);
            let Cut { triangles, is_valid } = cut(&circle);
            assert!(is_valid && triangles.len() == circle.len() - 2, "{corners}, {step}");
            let mut uses = vec![0; circle.len()];
            triangles.as_flattened().iter().for_each(|&i| uses[i] += 1);
            let most = uses.iter().max().copied().unwrap_or(0);
            assert!(most <= if step > 0.0 { 200 } else { 34 }, "{corners}, {step}: {most}");
            let flat: Vec<DVec2> = circle.iter().map(|p| p.truncate()).collect();
            for t in triangles {
                // Rounded corners may be collinear.
                assert!(doubled_area(t.map(|i| flat[i])) > if step > 0.0 { -1e-15 } else { 0.0 }, "{t:?}");
            }
        }
    }

    #[test]
    fn an_l_is_tiled_from_whichever_corner_it_begins() {
        let l = [[0.0, 0.0], [1.5, 0.0], [1.5, 0.5], [0.5, 0.5], [0.5, 1.5], [0.0, 1.5]];
        for first in 0..6 {
            let mut l = l;
            l.rotate_left(first);
            assert_tiles(&at(&l));
        }
    }

    /// A square with a square hole, as written by software without holes: a cut leads there and back.
    #[test]
    fn a_hole_stays_one() {
        let ring = at(&[
            [-1.5, -1.5],
            [1.5, -1.5],
            [1.5, 1.5],
            [-1.5, 1.5],
            [-1.5, -1.5],
            [-0.5, -0.5],
            [-0.5, 0.5],
            [0.5, 0.5],
            [0.5, -0.5],
            [-0.5, -0.5],
        ]);
        assert_tiles(&ring);
    }

    #[test]
    fn a_comb_and_a_spiral_are_tiled() {
        let mut comb = vec![[1.9, -1.0], [1.9, -0.9]];
        for i in (0..19).rev() {
            let x = -1.9 + 0.2 * f64::from(i);
            comb.extend([[x + 0.15, -0.9], [x + 0.1, 1.0], [x, -0.9]]);
        }
        comb.push([-1.95, -1.0]);
        assert_tiles(&at(&comb));
        let turn = |i: i32, r: f64| {
            let (angle, r) = (0.3 * f64::from(i), r + 0.02 * f64::from(i));
            [r * angle.cos(), r * angle.sin()]
        };
        let spiral: Vec<_> =
            (0..70).map(|i| turn(i, 0.3)).chain((0..70).rev().map(|i| turn(i, 0.2))).collect();
        assert_tiles(&at(&spiral));
    }

    #[test]
    fn corners_of_straight_edges_are_kept() {
        let wall = at(&[[0.0, 0.0], [0.5, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
        assert_tiles(&wall);
        for triangle in cut(&wall).triangles {
            assert!(turns_left(triangle.map(|i| wall[i].truncate())), "{triangle:?}");
        }
    }

    #[test]
    fn fronts_stay_fronts_in_any_plane() {
        let l = [[0.0, 0.0], [0.5, 0.5], [0.5, 1.5], [0.0, 1.5], [-1.5, -0.2]];
        for normal in [DVec3::X, DVec3::Y, DVec3::Z, DVec3::new(1.0, -2.0, 0.5), DVec3::new(-3.0, 1.0, 1.0)] {
            for normal in [normal, -normal] {
                let n = normal.normalize();
                let (a, b) = n.any_orthonormal_pair();
                let corners: Vec<DVec3> = l.iter().map(|[x, y]| 9.0 * n + *x * a + *y * b).collect();
                let found = cut(&corners);
                assert!(found.is_valid);
                for t in found.triangles {
                    let [p, q, r] = t.map(|i| corners[i]);
                    assert!((q - p).cross(r - p).dot(n) > 0.0, "{normal}");
                }
            }
        }
    }

    #[test]
    fn outlines_that_cross_themselves_are_fans_and_said_to_be_wrong() {
        let bow = at(&[[0.0, 0.0], [1.0, 0.1], [1.0, 0.0], [0.0, 1.0]]);
        assert_eq!(cut(&bow), Cut { triangles: vec![[0, 1, 2], [0, 2, 3]], is_valid: false });
    }

    #[test]
    fn what_has_no_area_or_no_numbers_does_no_harm() {
        for points in [vec![[0.0, 0.0]; 5], vec![[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [0.5, 0.0]]] {
            assert_eq!(cut(&at(&points)).triangles.len(), points.len() - 2);
        }
        assert_eq!(cut(&at(&[[0.0, 0.0], [f64::NAN, 0.0], [1.0, 1.0], [0.0, 1.0]])).triangles.len(), 2);
        assert_eq!(cut(&[]).triangles, [[0; 3]; 0]);
    }

    proptest! {
        /// Stars around a point are simple, and most are not convex.
        #[test]
        fn stars_are_tiled(radii in prop::collection::vec(0.2..1.9f64, 3..60)) {
            let n = radii.len() as f64;
            let points: Vec<_> = radii.iter().zip(0..).map(|(r, i)| {
                let angle = std::f64::consts::TAU * f64::from(i) / n;
                [r * angle.cos(), r * angle.sin()]
            }).collect();
            assert_tiles(&at(&points));
        }

        /// For any outline, the number of triangles is right, and their indices are corners.
        #[test]
        fn any_outline_ends(points in prop::collection::vec([0..5i32, 0..5i32], 0..60)) {
            let points: Vec<[f64; 2]> = points.iter().map(|p| p.map(f64::from)).collect();
            let found = cut(&at(&points));
            prop_assert_eq!(found.triangles.len(), points.len().saturating_sub(2));
            prop_assert!(found.triangles.as_flattened().iter().all(|&i| i < points.len()));
        }
    }
}
