//! Hits and their order along a line.

use sir_geom::{Barycentric, Side, TriangleId};

/// Where a line meets a triangle.
///
/// # Surfaces in contact
///
/// Hits of two parallel triangles within a millionth of the scene's radius are *coincident*, and rounding has no
/// say in their order. Seen along the line, triangles whose front faces the origin come first, those added to the
/// scene later before those added earlier; then the ones whose back faces the origin, earlier before later. In the
/// opposite direction this gives the same hits in reverse. It means: of two sheets back to back, each one shows its
/// front; of a decal on a wall, the later one is on top.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance from the origin of the line.
    pub t: f64,
    /// The triangle that is met.
    pub triangle: TriangleId,
    /// Where on the triangle.
    pub point: Barycentric,
    /// The side that faces the origin of the line.
    pub side: Side,
}

/// Distance in radii of the scene within which parallel surfaces are in contact.
pub(crate) const CONTACT: f64 = 1e-6;

/// Largest squared sine of the angle between surfaces in contact.
pub(crate) const PARALLEL: f64 = 1e-6;

/// The place of a triangle among coincident hits, which are in the order of these along a line.
pub(crate) fn contact_rank(triangle: TriangleId, side: Side) -> (Side, u32) {
    match side {
        Side::Front => (side, !triangle.0),
        Side::Back => (side, triangle.0),
    }
}
