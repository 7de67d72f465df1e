//! Segments: the pairs of surfaces that see each other along a line.

use sir_accel::Hit;
use sir_geom::TriangleId;
use sir_mesh::{PatchMesh, SideId};

/// What is at one end of a segment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// Nothing: the line comes from, or goes to, the outside of the scene.
    Outside,
    /// The back of a one-sided surface: it absorbs what it gets.
    Inactive,
    /// A side that reflects, of a patch of a triangle.
    Side(SideId, TriangleId),
}

/// A part of a line between two neighbouring surfaces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Segment {
    /// The end nearer to the origin of the line.
    pub from: End,
    /// The other end.
    pub to: End,
}

/// Calls `visit` for every segment of a line with these hits, in order, the two outer ones included. A line without
/// hits has none.
#[inline]
pub fn segments(mesh: &PatchMesh, hits: &[Hit], mut visit: impl FnMut(Segment)) {
    if hits.is_empty() {
        return;
    }
    let mut from = End::Outside;
    for hit in hits {
        let patch = mesh.patch_at(hit.triangle, hit.point);
        let end = |side| match mesh.side_of(hit.triangle, patch, side) {
            Some(id) => End::Side(id, hit.triangle),
            None => End::Inactive,
        };
        visit(Segment { from, to: end(hit.side) });
        from = end(hit.side.flip());
    }
    visit(Segment { from, to: End::Outside });
}
