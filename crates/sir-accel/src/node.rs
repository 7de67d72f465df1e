//! Nodes of the hierarchy: sixteen boxes each.

use crate::line_f32::{Bound, LineF32};
use crate::simd::backend::{F32Lanes, NODE_WIDTH, SimdBackend};

/// Margin by which boxes are enlarged, in radii of the scene: more than the error of the slab test in single precision.
pub(crate) const MARGIN: f32 = 3e-6;

/// Highest bit of a child: set if the child is the number of a leaf, clear if it is the number of a node.
pub(crate) const LEAF: u32 = 1 << 31;

/// Boxes, one per lane, in radii of the scene relative to its center.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(crate) struct Node {
    /// Smallest coordinates per axis, then largest; an unused lane has an empty box.
    pub(crate) bounds: [[f32; NODE_WIDTH]; 6],
    /// Node or leaf in each box, see [`LEAF`].
    pub(crate) children: [u32; NODE_WIDTH],
}

impl Node {
    /// Returns a node without children.
    pub(crate) fn empty() -> Self {
        Self {
            bounds: std::array::from_fn(|i| {
                [if i < 3 { f32::INFINITY } else { f32::NEG_INFINITY }; NODE_WIDTH]
            }),
            children: [0; NODE_WIDTH],
        }
    }

    /// Returns one of the bounds of all boxes.
    #[inline(always)]
    fn bound(&self, bound: Bound) -> &[f32; NODE_WIDTH] {
        // SAFETY: the only constructor of `Bound` makes an index below 6.
        #[allow(unsafe_code, reason = "six bounds checks per node take a tenth of the search time")]
        unsafe {
            self.bounds.get_unchecked(bound.index())
        }
    }

    /// Returns where a line enters and leaves the boxes \[radii\] (slab test, Kay and Kajiya 1986).
    #[inline(always)]
    pub(crate) fn slabs<B: SimdBackend>(&self, backend: B, line: &LineF32) -> [B::NodeF32; 2] {
        let bound = |end: usize, axis: usize| {
            backend
                .load_node(self.bound(line.bounds[end][axis]))
                .mul_add(backend.splat_node(line.inverse[axis]), backend.splat_node(line.offset[axis]))
        };
        let near = bound(0, 0).max(bound(0, 1)).max(bound(0, 2));
        let far = bound(1, 0).min(bound(1, 1)).min(bound(1, 2));
        [near, far]
    }
}
