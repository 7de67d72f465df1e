//! Pieces: the parts of patches in triangles.

use sir_geom::{Barycentric, TriangleId};

/// Largest number of corners of a piece: a triangle, cut by the four sides of a cell.
const MAX_CORNERS: usize = 7;

/// The part of a patch in one triangle: a convex polygon. The pieces of a patch cover it without overlapping.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piece {
    /// The triangle.
    pub triangle: TriangleId,
    corners: [Barycentric; MAX_CORNERS],
    count: u8,
}

impl Piece {
    /// Returns the piece that is a whole triangle.
    pub(crate) fn whole(triangle: TriangleId) -> Self {
        let corner = |v, w| Barycentric { v, w };
        Self::new(triangle, &[corner(0.0, 0.0), corner(1.0, 0.0), corner(0.0, 1.0)])
    }

    /// Returns the piece with these corners, at least three and at most seven.
    pub(crate) fn new(triangle: TriangleId, corners: &[Barycentric]) -> Self {
        let mut all = [Barycentric { v: 0.0, w: 0.0 }; MAX_CORNERS];
        all[..corners.len()].copy_from_slice(corners);
        Self { triangle, corners: all, count: corners.len() as u8 }
    }

    /// Returns the corners as points of the triangle, in the triangle's orientation.
    #[inline]
    #[must_use]
    pub fn corners(&self) -> &[Barycentric] {
        &self.corners[..usize::from(self.count)]
    }

    /// Returns the piece as triangles: a fan around its first corner.
    pub fn triangles(&self) -> impl Iterator<Item = [Barycentric; 3]> + '_ {
        let corners = self.corners();
        corners[1..].windows(2).map(|next| [corners[0], next[0], next[1]])
    }

    /// Returns the share of the area of the triangle that the piece covers.
    #[must_use]
    pub fn share(&self) -> f64 {
        self.triangles().map(share).sum()
    }

    /// Returns the triangle of the fan in which a random point lies, for a uniform number in `[0, 1)`, and the remainder of
    /// the number, which is uniform, too.
    pub(crate) fn random_triangle(&self, random: f64) -> ([Barycentric; 3], f64) {
        let corners = self.corners();
        if let [a, b, c] = *corners {
            return ([a, b, c], random);
        }
        let at = random * self.share();
        let (mut chosen, mut rest, mut start) = ([corners[0], corners[1], corners[2]], 0.0, 0.0);
        for triangle in self.triangles() {
            let area = share(triangle);
            if area > 0.0 {
                (chosen, rest) = (triangle, (at - start) / area);
                if at < start + area {
                    break;
                }
            }
            start += area;
        }
        (chosen, below_one(rest))
    }
}

/// Returns a number that is in `[0, 1)` up to rounding, without the rounding.
pub(crate) fn below_one(number: f64) -> f64 {
    number.clamp(0.0, 1.0 - 0.5 * f64::EPSILON)
}

/// Returns the share of the area of a triangle that lies between three of its points.
fn share([a, b, c]: [Barycentric; 3]) -> f64 {
    (b.v - a.v) * (c.w - a.w) - (b.w - a.w) * (c.v - a.v)
}
