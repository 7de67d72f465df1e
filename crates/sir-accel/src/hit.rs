//! Hits along lines.

use std::ops::Range;

use sir_types::{Barycentric, Side, TriangleId};

/// A point where a line hits a triangle.
///
/// # Surfaces in contact
///
/// Two triangles are *in contact* if they overlap in area, and the corners of one of them are within the
/// [contact distance](crate::Accel::contact_distance) of the plane of the other; so are triangles that others in contact
/// with them connect. Rounding does not decide the order of their hits. Seen along the line, triangles whose front faces
/// the origin come first, those of high priority before those of low priority. Then come triangles whose back faces the
/// origin, low priority before high priority. The opposite direction gives the same hits in reverse. As a result, two
/// sheets back to back each show their front, and of a decal and its wall, the one with the higher priority is on top.
/// Without [priorities](crate::Options::contact_priorities), a triangle has a higher priority than those before it in
/// the list.
///
/// The contact distance of a triangle is its largest coordinate times 2⁻²¹, the rounding error of four numbers in single
/// precision, and four steps of the grid. Coordinates count up to 64 times the extent of the triangle. Other triangles do
/// not change it, except for the size of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance from the origin of the line, negative behind it.
    pub t: f64,
    /// Number of the triangle in the list from which the structure was built.
    pub triangle: TriangleId,
    /// Point on the triangle.
    pub point: Barycentric,
    /// Side that faces the origin of the line. For hits behind the origin, the side that faces an origin far before
    /// them.
    pub side: Side,
}

/// All hits of some consecutive lines.
#[derive(Clone, Copy, Debug)]
pub struct LineHits<'a> {
    starts: &'a [u32],
    hits: &'a [Hit],
}

impl<'a> LineHits<'a> {
    /// Takes the hits line by line; those of line `i` are `hits[starts[i]..starts[i + 1]]`.
    pub(crate) fn new(starts: &'a [u32], hits: &'a [Hit]) -> Self {
        Self { starts, hits }
    }

    /// Returns the hits of all lines, line by line, in order along each.
    #[must_use]
    pub fn hits(&self) -> &'a [Hit] {
        self.hits
    }

    /// Returns the range of [`hits`](Self::hits) that belongs to each line.
    pub fn lines(&self) -> impl ExactSizeIterator<Item = Range<usize>> + use<'a> {
        self.starts.windows(2).map(|ends| ends[0] as usize..ends[1] as usize)
    }
}
