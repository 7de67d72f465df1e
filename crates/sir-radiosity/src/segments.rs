//! Segments: the pairs of surfaces that see each other along a line.

use sir_accel::LineHits;
use sir_geom::{Side, TriangleId};
use sir_mesh::{PatchMesh, SideId};

/// One end of a segment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// Nothing: the line comes from or goes to the outside of the scene.
    Outside,
    /// The back of a one-sided surface, which absorbs what it receives.
    Inactive,
    /// A reflecting side of a patch of a triangle.
    Side(SideId, TriangleId),
}

/// The part of a line between two neighboring surfaces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Segment {
    /// The end nearer to the origin of the line.
    pub from: End,
    /// The other end.
    pub to: End,
}

/// An end in eight bytes: the number of the side, or a code for the other two ends, and the number of the triangle.
#[derive(Clone, Copy, Debug)]
struct Packed(u32, u32);

impl Packed {
    const OUTSIDE: Self = Self(u32::MAX, 0);
    const INACTIVE: Self = Self(u32::MAX - 1, 0);

    #[inline]
    fn end(self) -> End {
        match self {
            Self(u32::MAX, _) => End::Outside,
            Self(side, _) if side == Self::INACTIVE.0 => End::Inactive,
            Self(side, triangle) => End::Side(SideId(side), TriangleId(triangle)),
        }
    }
}

/// Finds the segments of lines. It holds scratch memory, so it belongs to one thread.
#[derive(Clone, Debug, Default)]
pub struct Segments {
    /// Per hit, the end that faces the origin of the line and the opposite one.
    ends: Vec<[Packed; 2]>,
    /// Per hit, the number of its line if it is the first hit of that line, or `LATER`.
    first_of: Vec<u32>,
    /// The line and the ends of each segment.
    found: Vec<(u32, [Packed; 2])>,
}

/// Prefetch distance in hits.
const PREFETCH_DISTANCE: usize = 24;

/// Mark of a hit that is not the first of its line.
const LATER: u32 = u32::MAX;

impl Segments {
    /// Finds all segments of some lines, line by line and in order along each, including the two outer ones. A line
    /// without hits has none.
    pub fn find(&mut self, mesh: &PatchMesh, hits: &LineHits<'_>) {
        // Loops over all hits without data-dependent branches, so that the processor overlaps the memory accesses of
        // many hits.
        let count = hits.hits().len();
        self.ends.clear();
        let found = hits.hits();
        self.ends.extend(found.iter().enumerate().map(|(i, hit)| {
            let ahead = |distance: usize| found[(i + distance).min(count - 1)].triangle;
            sir_accel::prefetch(mesh.first_entry(ahead(PREFETCH_DISTANCE)));
            sir_accel::prefetch(mesh.second_entry(ahead(PREFETCH_DISTANCE / 2)));
            let (front, back) = mesh.sides_at(hit.triangle, hit.point);
            let front = Packed(front.0, hit.triangle.0);
            let back = Packed(back.map_or(Packed::INACTIVE.0, |back| back.0), hit.triangle.0);
            let from = usize::from(hit.side == Side::Back);
            let around = [front, back, front];
            [around[from], around[from + 1]]
        }));
        self.first_of.clear();
        self.first_of.resize(count + 1, LATER);
        for (line, range) in hits.lines().enumerate() {
            // Of several lines that begin at the same hit, all but the last are empty.
            self.first_of[range.start] = line as u32;
        }
        self.first_of[count] = 0;
        self.found.resize(2 * count, (0, [Packed::OUTSIDE; 2]));
        let (mut next, mut line, mut from) = (0, 0, Packed::OUTSIDE);
        for (&[to, behind], first) in self.ends.iter().zip(self.first_of.windows(2)) {
            line = if first[0] == LATER { line } else { first[0] };
            let last = first[1] != LATER;
            self.found[next] = (line, [from, to]);
            self.found[next + 1] = (line, [behind, Packed::OUTSIDE]);
            next += 1 + usize::from(last);
            from = if last { Packed::OUTSIDE } else { behind };
        }
        self.found.truncate(next);
    }

    /// Returns the number of segments found.
    #[must_use]
    pub fn count(&self) -> usize {
        self.found.len()
    }

    /// Returns a segment with the number of its line among the given lines.
    #[inline]
    #[must_use]
    pub fn get(&self, i: usize) -> Option<(usize, Segment)> {
        let &(line, [from, to]) = self.found.get(i)?;
        Some((line as usize, Segment { from: from.end(), to: to.end() }))
    }

    /// Returns all segments found.
    pub fn iter(&self) -> impl Iterator<Item = (usize, Segment)> {
        (0..self.count()).filter_map(|i| self.get(i))
    }
}
