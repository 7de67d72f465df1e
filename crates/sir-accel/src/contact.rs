//! The order of surfaces in contact.

use glam::DVec3;
use sir_types::{Side, TriangleId};

use crate::error::AccelError;
use crate::grid::GridLine;
use crate::hit::Hit;
use crate::stacks;
use crate::tree::Tree;
use crate::triangle::{Crossing, GridTriangle};

/// Contact distance of a triangle over its largest coordinate: four times the rounding of numbers in single precision,
/// so that corners of two surfaces in one plane may differ by it.
const ROUNDING: f64 = 1.0 / (1u64 << 21) as f64;

/// Largest coordinate that counts, in extents of the triangle. The contact distance of a surface far from the origin of
/// the coordinates stays small compared to the surface.
const MAX_COORDINATE: f64 = 64.0;

/// Part of the contact distance that covers the rounding of corners to the grid \[steps of the grid\].
const STEPS: f64 = 4.0;

/// Largest distance of neighbors in a stack along their normal, in contact distances.
const MAX_GAP: f64 = 4.0;

/// Smallest cosine between a line and a normal with which lengths along the line are computed.
const GRAZING: f64 = 1e-3;

/// Largest squared sine of the angle between surfaces that count as parallel.
const PARALLEL: f64 = 1e-6;

/// The stacks of triangles in contact, in the order of ranks, and where coordinates begin.
#[derive(Clone, Debug)]
pub(crate) struct Stacks {
    /// Number of the stack to which the triangle of each rank belongs.
    pub(crate) of_rank: Vec<u32>,
    /// Origin of the coordinates of the scene \[steps of the grid\].
    pub(crate) origin: DVec3,
}

impl Stacks {
    /// Finds the triangles of a tree that are in contact, and sets their ranks. `origin` is the origin of the coordinates of
    /// the scene \[steps of the grid\], and `priorities` returns the priorities of triangles.
    pub(crate) fn find(
        tree: &mut Tree,
        origin: DVec3,
        priorities: impl FnOnce(&[TriangleId]) -> Result<Vec<u32>, AccelError>,
    ) -> Result<Self, AccelError> {
        let mut stacks = Self { of_rank: Vec::new(), origin };
        let distance = |triangle: &GridTriangle| stacks.distance(triangle);
        let mut found = stacks::find(&tree.triangles, &tree.nodes, &tree.leaf_ranges(), distance);
        let id = |place: u32| tree.triangles[place as usize].id;
        found.sort_unstable_by_key(|&(place, _)| id(place));
        let ids: Vec<TriangleId> = found.iter().map(|&(place, _)| id(place)).collect();
        let priorities = priorities(&ids)?;
        let mut order: Vec<_> = found.iter().zip(priorities).zip(ids).collect();
        order.sort_unstable_by_key(|&((&(_, stack), priority), id)| (stack, priority, id));
        for (&((&(place, stack), _), _), rank) in order.iter().zip(0..) {
            tree.triangles[place as usize].rank = rank;
            stacks.of_rank.push(stack);
        }
        Ok(stacks)
    }

    /// Returns the contact distance of a triangle \[steps of the grid\].
    pub(crate) fn distance(&self, triangle: &GridTriangle) -> f64 {
        let [a, b, c] = triangle.positions();
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        let largest = (low - self.origin).abs().max((high - self.origin).abs()).max_element();
        STEPS + ROUNDING * largest.min(MAX_COORDINATE * (high - low).max_element())
    }

    /// Returns true if two triangles are in one stack.
    fn are_together(&self, a: &GridTriangle, b: &GridTriangle) -> bool {
        let stack = |triangle: &GridTriangle| self.of_rank.get(triangle.rank as usize);
        stack(a).is_some_and(|of_a| stack(b) == Some(of_a))
    }
}

/// Order of surfaces in contact along a line, as [`Hit`] defines it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ContactOrder<'a> {
    pub(crate) tree: &'a Tree,
    pub(crate) stacks: &'a Stacks,
}

impl ContactOrder<'_> {
    /// Returns true if two triangles are in one stack.
    pub(crate) fn are_together(&self, a: TriangleId, b: TriangleId) -> bool {
        let triangles = (self.tree.triangle(a), self.tree.triangle(b));
        matches!(triangles, (Some(a), Some(b)) if self.stacks.are_together(a, b))
    }

    /// Returns true if a crossing lies ahead of the surface that a ray leaves.
    #[inline]
    pub(crate) fn is_ahead(&self, leaving: TriangleId, other: &Crossing, line: &GridLine) -> bool {
        if other.t.abs() > other.near() { other.t > 0.0 } else { self.is_on_top(leaving, other, line) }
    }

    /// Returns true if a crossing that may be in contact with the surface that a ray leaves lies ahead of it.
    #[inline(never)]
    fn is_on_top(&self, leaving: TriangleId, other: &Crossing, line: &GridLine) -> bool {
        let (Some(left), Some(crossed)) = (self.tree.triangle(leaving), self.tree.triangle(other.id)) else {
            return other.t > 0.0;
        };
        if self.stacks.are_together(left, crossed) {
            // The side opposite to the one that the ray leaves: it faces an origin far behind.
            let along = left.scaled_normal().dot(line.direction) > 0.0;
            let side = if along { Side::Back } else { Side::Front };
            return key(side, left.rank) < key(other.side, crossed.rank);
        }
        let touches = other.t.abs() <= self.stacks.distance(left).min(self.stacks.distance(crossed))
            && are_parallel(left, crossed);
        // A line that does not cross the triangle that it leaves starts on its edge, and `other` is the neighbor there.
        other.t > 0.0 && !(touches && left.cross(line).is_none())
    }

    /// Returns the distance along a line beyond a crossing within which other triangles of its stack are looked for
    /// \[steps of the grid\]; zero if the triangle is in none.
    #[inline]
    pub(crate) fn reach(&self, crossing: &Crossing, line: &GridLine) -> f64 {
        let triangle = if crossing.is_stacked() { self.tree.triangle(crossing.id) } else { None };
        triangle.map_or(0.0, |triangle| {
            let normal = triangle.scaled_normal();
            let cosine = (normal.dot(line.direction).abs() / normal.length()).max(GRAZING);
            MAX_GAP * self.stacks.distance(triangle) / cosine
        })
    }

    /// Sorts the hits of a line by distance, and those of a stack by their key.
    #[cold]
    pub(crate) fn sort(&self, hits: &mut [Hit]) {
        // At equal distances, the order must be reversed in the opposite direction.
        hits.sort_unstable_by(|a, b| {
            a.t.total_cmp(&b.t).then_with(|| key(a.side, a.triangle.0).cmp(&key(b.side, b.triangle.0)))
        });
        // Hits in stacks: the stack, the place among all hits, and the key.
        let member = |(place, hit): (usize, &Hit)| {
            let triangle = self.tree.triangle(hit.triangle)?;
            let stack = *self.stacks.of_rank.get(triangle.rank as usize)?;
            Some((stack, place, key(hit.side, triangle.rank)))
        };
        let mut stacked: Vec<_> = hits.iter().enumerate().filter_map(member).collect();
        stacked.sort_by_key(|&(stack, ..)| stack);
        for stack in stacked.chunk_by(|a, b| a.0 == b.0) {
            let mut members: Vec<_> = stack.iter().map(|&(_, place, key)| (key, hits[place])).collect();
            members.sort_unstable_by_key(|&(key, _)| key);
            stack.iter().zip(members).for_each(|(&(_, place, _), (_, hit))| hits[place] = hit);
        }
    }
}

/// Returns the sort key of a hit at the same place as others: fronts first, those of high rank before those of low rank,
/// then backs in the opposite order.
pub(crate) fn key(side: Side, rank: u32) -> (Side, u32) {
    match side {
        Side::Front => (side, !rank),
        Side::Back => (side, rank),
    }
}

/// Returns true if the squared sine of the angle between two triangles is small.
fn are_parallel(a: &GridTriangle, b: &GridTriangle) -> bool {
    let (a, b) = (a.scaled_normal(), b.scaled_normal());
    a.cross(b).length_squared() <= PARALLEL * a.length_squared() * b.length_squared()
}
