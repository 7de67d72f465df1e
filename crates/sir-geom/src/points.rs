//! Points in space: their extent, welding of points that are equal up to rounding, and search for points on a segment.

use std::collections::HashMap;

use glam::DVec3;

/// Returns the middle of points, and their typical distance from it: medians, which a few points far away do not change.
/// Both are zero without points.
#[must_use]
pub fn median_extent(points: &[DVec3]) -> (DVec3, f64) {
    if points.is_empty() {
        return (DVec3::ZERO, 0.0);
    }
    let median = |mut numbers: Vec<f64>| {
        let middle = numbers.len() / 2;
        *numbers.select_nth_unstable_by(middle, f64::total_cmp).1
    };
    let along = |axis: usize| median(points.iter().map(|point| point[axis]).collect());
    let middle = DVec3::new(along(0), along(1), along(2));
    (middle, median(points.iter().map(|point| point.distance(middle)).collect()))
}

/// Mark of no point.
const NONE: u32 = u32::MAX;

/// Set of points of which no two are closer than a tolerance.
#[derive(Debug)]
pub struct Weld {
    tolerance: f64,
    origin: DVec3,
    points: Vec<DVec3>,
    /// Last point in each cell.
    cells: HashMap<[i64; 3], u32>,
    /// Point before each one in its cell, or [`NONE`].
    before: Vec<u32>,
}

impl Weld {
    /// Creates an empty set; `origin` is any point near the others.
    #[must_use]
    pub fn new(origin: DVec3, tolerance: f64) -> Self {
        Self { tolerance, origin, points: Vec::new(), cells: HashMap::new(), before: Vec::new() }
    }

    /// Returns the number of the point at this position: one within the tolerance, otherwise a new one.
    pub fn add(&mut self, p: DVec3) -> u32 {
        // Cells are several tolerances wide, so most points require a search of one cell, and none of more than eight.
        let cell =
            |q: DVec3| ((q - self.origin) / (8.0 * self.tolerance)).floor().to_array().map(|x| x as i64);
        let (low, high) = (cell(p - self.tolerance), cell(p + self.tolerance));
        for x in low[0]..=high[0] {
            for y in low[1]..=high[1] {
                for z in low[2]..=high[2] {
                    let mut next = self.cells.get(&[x, y, z]).copied().unwrap_or(NONE);
                    while next != NONE {
                        let distance = self.points[next as usize].distance_squared(p);
                        if distance <= self.tolerance * self.tolerance {
                            return next;
                        }
                        next = self.before[next as usize];
                    }
                }
            }
        }
        let number = self.points.len() as u32;
        let before = self.cells.insert(cell(p), number);
        self.before.push(before.unwrap_or(NONE));
        self.points.push(p);
        number
    }

    /// Returns the points by number.
    #[must_use]
    pub fn into_points(self) -> Vec<DVec3> {
        self.points
    }
}

/// A k-d tree over points, to find those near a segment. A grid would need one cell size for both millimeters and
/// halls.
#[derive(Debug)]
pub struct PointTree<'a> {
    points: &'a [DVec3],
    /// Point numbers. A node is a range of them, and its children are the two halves.
    order: Vec<u32>,
    /// Boxes of the nodes in heap order.
    boxes: Vec<(DVec3, DVec3)>,
}

/// Largest number of points in a leaf.
const LEAF: usize = 8;

impl<'a> PointTree<'a> {
    /// Creates the tree.
    #[must_use]
    pub fn new(points: &'a [DVec3]) -> Self {
        let mut tree = Self { points, order: (0..points.len() as u32).collect(), boxes: Vec::new() };
        let mut order = std::mem::take(&mut tree.order);
        tree.build(&mut order, 0);
        tree.order = order;
        tree
    }

    fn build(&mut self, order: &mut [u32], node: usize) {
        let start = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let (low, high) = order.iter().fold(start, |(low, high), &i| {
            let p = self.points[i as usize];
            (low.min(p), high.max(p))
        });
        if self.boxes.len() <= node {
            self.boxes.resize(node + 1, start);
        }
        self.boxes[node] = (low, high);
        if order.len() > LEAF {
            let size = high - low;
            let axis = (0..3).max_by(|&a, &b| size[a].total_cmp(&size[b])).unwrap_or(0);
            let half = order.len() / 2;
            let points = self.points;
            order.select_nth_unstable_by(half, |&a, &b| {
                points[a as usize][axis].total_cmp(&points[b as usize][axis]).then(a.cmp(&b))
            });
            let (left, right) = order.split_at_mut(half);
            self.build(left, 2 * node + 1);
            self.build(right, 2 * node + 2);
        }
    }

    /// Appends to `found` the points whose distance to the segment `ab` is at most `tolerance`, with their parameter
    /// along it: 0 at `a`, 1 at `b`, none beyond.
    pub fn near_segment(&self, a: DVec3, b: DVec3, tolerance: f64, found: &mut Vec<(f64, u32)>) {
        self.visit(0, 0..self.order.len(), &Segment { a, along: b - a, tolerance }, found);
    }

    /// Replaces `found` by the points between the ends of the segment `ab` whose distance to it is at most `tolerance`,
    /// from `a` to `b`, with their parameter along it, which is neither 0 nor 1.
    pub fn between(&self, a: DVec3, b: DVec3, tolerance: f64, found: &mut Vec<(f64, u32)>) {
        found.clear();
        self.near_segment(a, b, tolerance, found);
        found.retain(|&(t, _)| 0.0 < t && t < 1.0);
        found.sort_unstable_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
    }

    fn visit(
        &self,
        node: usize,
        range: std::ops::Range<usize>,
        segment: &Segment,
        found: &mut Vec<(f64, u32)>,
    ) {
        if !segment.may_touch(self.boxes[node]) {
            return;
        }
        if range.len() > LEAF {
            let half = range.start + range.len() / 2;
            self.visit(2 * node + 1, range.start..half, segment, found);
            self.visit(2 * node + 2, half..range.end, segment, found);
            return;
        }
        for &i in &self.order[range] {
            let to = self.points[i as usize] - segment.a;
            let t = to.dot(segment.along) / segment.along.length_squared();
            let off = to - t * segment.along;
            if (0.0..=1.0).contains(&t) && off.length_squared() <= segment.tolerance * segment.tolerance {
                found.push((t, i));
            }
        }
    }
}

struct Segment {
    a: DVec3,
    along: DVec3,
    tolerance: f64,
}

impl Segment {
    /// Returns true if the segment may meet a box that is widened by the tolerance.
    fn may_touch(&self, (low, high): (DVec3, DVec3)) -> bool {
        let (mut enter, mut leave) = (0.0f64, 1.0f64);
        for axis in 0..3 {
            let from = low[axis] - self.tolerance - self.a[axis];
            let to = high[axis] + self.tolerance - self.a[axis];
            let along = self.along[axis];
            if along == 0.0 {
                if from > 0.0 || to < 0.0 {
                    return false;
                }
            } else {
                let (s, t) = (from / along, to / along);
                enter = enter.max(s.min(t));
                leave = leave.min(s.max(t));
            }
        }
        enter <= leave
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn points_within_the_tolerance_are_one_across_cells() {
        let mut weld = Weld::new(DVec3::ZERO, 1e-6);
        for i in 0..1000 {
            let p = DVec3::new(1e-6 * 8.0 * f64::from(i), 0.0, 0.0);
            let number = weld.add(p);
            assert_eq!(weld.add(p - DVec3::splat(5e-7)), number);
            assert_eq!(weld.add(p + DVec3::splat(5e-7)), number);
        }
        assert_eq!(weld.into_points().len(), 1000);
    }

    proptest! {
        #[test]
        fn the_tree_finds_what_a_look_at_all_points_finds(
            coordinates in prop::collection::vec(0u8..6, 3..300),
            ends in prop::array::uniform6(0u8..6),
        ) {
            // Integer coordinates, so that many points lie exactly on the segment.
            let at = |c: &[u8]| DVec3::new(f64::from(c[0]), f64::from(c[1]), f64::from(c[2]));
            let points: Vec<DVec3> = coordinates.chunks_exact(3).map(at).collect();
            let (a, b) = (at(&ends[..3]), at(&ends[3..]));
            prop_assume!(a != b);
            let mut found = Vec::new();
            PointTree::new(&points).near_segment(a, b, 1e-9, &mut found);
            let mut found: Vec<u32> = found.iter().map(|f| f.1).collect();
            found.sort_unstable();
            let on = |p: DVec3| p.distance(a) + p.distance(b) <= a.distance(b) + 1e-9;
            let expected: Vec<u32> = (0..points.len() as u32).filter(|&i| on(points[i as usize])).collect();
            prop_assert_eq!(found, expected);
        }
    }
}
