//! Nodes of polygons.

/// A node of a polygon.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Node {
    pub(super) point: u32,
    /// True for a corner; false if the node only divides an edge.
    pub(super) is_corner: bool,
}
