//! Stacks: sets of triangles that lie on each other.
//!
//! Two triangles are in contact if they overlap in area and lie in one plane within the smaller of their contact
//! distances. A stack contains all triangles that are connected by contacts. This relation is found once, when the
//! structure is built, so it is the same for all lines.

use std::ops::Range;

use glam::{DVec2, DVec3};
use sir_types::DisjointSets;

use crate::grid::RADIUS;
use crate::node::{LEAF, Node};
use crate::simd::backend::NODE_WIDTH;
use crate::triangle::GridTriangle;

/// Largest width of an overlap that does not count, in contact distances. Neighbors that share an edge up to rounding do
/// not lie on each other.
const MIN_OVERLAP: f64 = 4.0;

/// Largest distance of a corner from the plane of the largest triangle of its stack, in contact distances.
const MAX_HEIGHT: f64 = 16.0;

/// The same in distances from a corner of that triangle, whose plane is uncertain far away.
const MAX_SLOPE: f64 = 1e-3;

/// Number of comparisons of a triangle with others that are not in contact with it, after which it is postponed.
const MAX_TESTS: u64 = 256;

/// Number of such comparisons of all postponed triangles, which takes a second or two. Only around points at which
/// thousands of triangles meet are there more; contacts there may be missed.
const POOL: u64 = 30_000_000;

/// A triangle as it is compared with others \[steps of the grid\].
struct Sheet {
    corners: [DVec3; 3],
    low: DVec3,
    high: DVec3,
    /// Unit normal.
    normal: DVec3,
    /// Contact distance.
    distance: f64,
}

impl Sheet {
    /// Returns `None` if the triangle has no area.
    fn new(triangle: &GridTriangle, distance: f64) -> Option<Self> {
        let corners = triangle.positions();
        let [a, b, c] = corners;
        let normal = triangle.scaled_normal().try_normalize()?;
        Some(Self { corners, low: a.min(b).min(c), high: a.max(b).max(c), normal, distance })
    }

    /// Returns true if two triangles are in contact.
    fn touches(&self, other: &Self) -> bool {
        let distance = self.distance.min(other.distance);
        (self.low - distance).cmple(other.high).all()
            && (other.low - distance).cmple(self.high).all()
            && self.height(other).min(other.height(self)) <= distance
            && self.overlaps(other, MIN_OVERLAP * distance)
    }

    /// Returns the largest distance of a corner of another triangle from the plane of this one.
    fn height(&self, other: &Self) -> f64 {
        let height = |corner: DVec3| (corner - self.corners[0]).dot(self.normal).abs();
        other.corners.map(height).into_iter().fold(0.0, f64::max)
    }

    /// Returns true if two triangles, seen along the axis to which this one is most perpendicular, have an overlap that
    /// is wider than `width`. (An edge of one of them separates them otherwise.)
    fn overlaps(&self, other: &Self, width: f64) -> bool {
        let normal = self.normal.abs();
        let flat = |p: DVec3| {
            if normal.z >= normal.x.max(normal.y) {
                DVec2::new(p.x, p.y)
            } else if normal.x >= normal.y {
                DVec2::new(p.y, p.z)
            } else {
                DVec2::new(p.z, p.x)
            }
        };
        let (mine, its) = (self.corners.map(flat), other.corners.map(flat));
        !is_separated(mine, its, width) && !is_separated(its, mine, width)
    }
}

/// Returns true if a triangle reaches less than `width` beyond one of the edges of another, towards its inside.
fn is_separated([a, b, c]: [DVec2; 3], other: [DVec2; 3], width: f64) -> bool {
    let inside = (b - a).perp_dot(c - a).signum();
    [(a, b), (b, c), (c, a)].into_iter().any(|(from, to)| {
        let edge = to - from;
        let depth = |p: DVec2| inside * edge.perp_dot(p - from);
        other.into_iter().all(|p| depth(p) <= width * edge.length())
    })
}

/// Returns the stacks of triangles, which are given in the order of the leaves: for each triangle in a stack, its place
/// and the first place of the stack. `leaves` are the places of the triangles of each leaf, and `distance` returns the contact distance of a
/// triangle \[steps of the grid\].
pub(crate) fn find(
    triangles: &[GridTriangle],
    nodes: &[Node],
    leaves: &[Range<u32>],
    distance: impl Fn(&GridTriangle) -> f64,
) -> Vec<(u32, u32)> {
    let count = triangles.len() as u32;
    let mut sets = DisjointSets::new(count);
    let is_copy = merge_copies(triangles, &mut sets);
    let sheet = |place: u32| {
        let triangle = &triangles[place as usize];
        if is_copy[place as usize] { None } else { Sheet::new(triangle, distance(triangle)) }
    };
    // Triangles that fit with few of those near them, such as those around a point, come last, as long as it takes.
    let (mut last, mut left) = (Vec::new(), POOL);
    let mut waiting = Vec::new();
    let mut compare = |place: u32, tests: &mut u64, sets: &mut DisjointSets| {
        let Some(one) = sheet(place) else { return };
        let radii = |p: DVec3| (p / RADIUS).as_vec3().to_array();
        let (low, high) = (radii(one.low - one.distance), radii(one.high + one.distance));
        waiting.clear();
        waiting.push(0);
        while let Some(child) = waiting.pop() {
            if child & LEAF == 0 {
                let node = &nodes[child as usize];
                let meets = |lane: usize| {
                    let above = |axis: usize| node.bounds[axis][lane] <= high[axis];
                    let below = |axis: usize| low[axis] <= node.bounds[3 + axis][lane];
                    above(0) & above(1) & above(2) & below(0) & below(1) & below(2)
                };
                waiting.extend((0..NODE_WIDTH).filter(|&lane| meets(lane)).map(|lane| node.children[lane]));
                continue;
            }
            let Range { start, end } = leaves[(child & !LEAF) as usize];
            for other in start.max(place + 1)..end {
                if sets.first(place) != sets.first(other)
                    && let Some(two) = sheet(other)
                {
                    if one.touches(&two) {
                        sets.merge(place, other);
                    } else if let Some(fewer) = tests.checked_sub(1) {
                        *tests = fewer;
                    } else {
                        return;
                    }
                }
            }
        }
    };
    for place in 0..count {
        let mut tests = MAX_TESTS;
        compare(place, &mut tests, &mut sets);
        if tests == 0 {
            last.push(place);
        }
    }
    last.into_iter().for_each(|place| compare(place, &mut left, &mut sets));
    let firsts: Vec<u32> = (0..count).map(|place| sets.first(place)).collect();
    let mut sizes = vec![0u32; triangles.len()];
    firsts.iter().for_each(|&first| sizes[first as usize] += 1);
    let mut found: Vec<_> = (0..count).zip(firsts).filter(|&(_, first)| sizes[first as usize] > 1).collect();
    found.sort_unstable_by_key(|&(place, first)| (first, place));
    let is_flat = |stack: &&[(u32, u32)]| {
        is_flat(stack.iter().map(|&(place, _)| &triangles[place as usize]), &distance)
    };
    found.chunk_by(|a, b| a.1 == b.1).filter(is_flat).flatten().copied().collect()
}

/// Returns true if triangles lie in one plane. Double shells of thousands of facets do not: each facet may be in contact
/// with the next one of the other shell, all around, but a line crosses them in several places.
fn is_flat<'t>(
    stack: impl Iterator<Item = &'t GridTriangle> + Clone,
    distance: impl Fn(&GridTriangle) -> f64,
) -> bool {
    let sheets = stack.filter_map(|triangle| Sheet::new(triangle, distance(triangle)));
    let size = |sheet: &Sheet| (sheet.high - sheet.low).length_squared();
    let Some(base) = sheets.clone().max_by(|a, b| size(a).total_cmp(&size(b))) else { return true };
    sheets.into_iter().all(|sheet| {
        let slack = MAX_HEIGHT * sheet.distance.max(base.distance);
        let is_near = |corner: DVec3| {
            let from_base = corner - base.corners[0];
            from_base.dot(base.normal).abs() <= slack + MAX_SLOPE * from_base.length()
        };
        sheet.corners.into_iter().all(is_near)
    })
}

/// Merges triangles that have the same corners, and returns true for all but one of each set. Without this, many copies
/// in one place would take the square of their number of comparisons.
fn merge_copies(triangles: &[GridTriangle], sets: &mut DisjointSets) -> Vec<bool> {
    let corners = |place: u32| {
        let mut corners = triangles[place as usize].corners;
        corners.sort_unstable();
        corners
    };
    // Triangles with equal corners have equal hashes; the reverse is checked.
    let hash = |place: u32| {
        let mix = |hash: u64, x: &i32| {
            (hash ^ u64::from(*x as u32)).wrapping_mul(0x9E37_79B9_7F4A_7C15).rotate_left(29)
        };
        corners(place).as_flattened().iter().fold(0, mix)
    };
    let mut order: Vec<(u64, u32)> = (0..triangles.len() as u32).map(|place| (hash(place), place)).collect();
    order.sort_unstable();
    let mut is_copy = vec![false; triangles.len()];
    for pair in order.windows(2) {
        let [(hash, first), (its_hash, second)] = [pair[0], pair[1]];
        if hash == its_hash && corners(first) == corners(second) {
            // Triangles without area are never hit.
            if triangles[first as usize].scaled_normal() != DVec3::ZERO {
                sets.merge(first, second);
            }
            is_copy[second as usize] = true;
        }
    }
    is_copy
}
