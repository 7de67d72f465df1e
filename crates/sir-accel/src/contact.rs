//! The order of surfaces in contact.

use sir_types::{Side, TriangleId};

use crate::grid::{GridLine, RADIUS};
use crate::hit::Hit;
use crate::tree::Tree;
use crate::triangle::{Crossing, GridTriangle};

/// Distance within which parallel surfaces are in contact \[steps of the grid\]: a millionth of the radius of the
/// scene.
pub(crate) const CONTACT: f64 = 1e-6 * RADIUS;

/// Largest squared sine of the angle between surfaces in contact.
const PARALLEL: f64 = 1e-6;

/// Order of surfaces in contact along a line, as [`Hit`] defines it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ContactOrder<'a> {
    pub(crate) tree: &'a Tree,
    /// Rank of each triangle in the order of priorities; `None` if the rank is its number.
    pub(crate) ranks: Option<&'a [u32]>,
}

impl ContactOrder<'_> {
    /// Returns the sort key of hits in contact along a line.
    fn key(&self, triangle: TriangleId, side: Side) -> (Side, u32) {
        let rank = self.ranks.and_then(|ranks| ranks.get(triangle.index())).copied().unwrap_or(triangle.0);
        match side {
            Side::Front => (side, !rank),
            Side::Back => (side, rank),
        }
    }

    /// Returns true if a crossing lies ahead of the surface that a ray leaves.
    #[inline]
    pub(crate) fn is_ahead(&self, leaving: TriangleId, other: &Crossing, line: &GridLine) -> bool {
        if other.t.abs() > CONTACT { other.t > 0.0 } else { self.is_on_top(leaving, other, line) }
    }

    /// Returns true if a crossing close to the surface that a ray leaves lies ahead of it.
    #[cold]
    fn is_on_top(&self, leaving: TriangleId, other: &Crossing, line: &GridLine) -> bool {
        let (Some(left), Some(crossed)) = (self.tree.triangle(leaving), self.tree.triangle(other.id)) else {
            return other.t > 0.0;
        };
        if !are_parallel(left, crossed) {
            return other.t > 0.0;
        }
        // The side opposite to the one that the ray leaves: it faces an origin far behind.
        let along = left.scaled_normal().dot(line.direction) > 0.0;
        let side = if along { Side::Back } else { Side::Front };
        // A line that does not cross the triangle that it leaves starts on its edge, and `other` is the neighbor there.
        left.cross(line).is_some() && self.key(leaving, side) < self.key(other.id, other.side)
    }

    /// Sorts the hits of a line by distance, and those in contact by their key. `contact` is the distance [`CONTACT`]
    /// as a length of the scene.
    #[cold]
    pub(crate) fn sort(&self, hits: &mut [Hit], contact: f64) {
        let key = |hit: &Hit| self.key(hit.triangle, hit.side);
        // Copies of a triangle have hits at the same distance. Sorted by their key, they need no swaps below; otherwise
        // the time would grow with the square of their number.
        hits.sort_unstable_by(|a, b| a.t.total_cmp(&b.t).then(key(a).cmp(&key(b))));
        for i in 1..hits.len() {
            for j in (1..=i).rev() {
                let (first, second) = (hits[j - 1], hits[j]);
                let is_apart = (first.t - second.t).abs() > contact || !self.are_parallel(&first, &second);
                if is_apart || key(&first) < key(&second) {
                    break;
                }
                hits.swap(j - 1, j);
            }
        }
    }

    fn are_parallel(&self, a: &Hit, b: &Hit) -> bool {
        let triangles = (self.tree.triangle(a.triangle), self.tree.triangle(b.triangle));
        matches!(triangles, (Some(a), Some(b)) if are_parallel(a, b))
    }
}

/// Returns true if the squared sine of the angle between two triangles is small.
fn are_parallel(a: &GridTriangle, b: &GridTriangle) -> bool {
    let (a, b) = (a.scaled_normal(), b.scaled_normal());
    a.cross(b).length_squared() <= PARALLEL * a.length_squared() * b.length_squared()
}
