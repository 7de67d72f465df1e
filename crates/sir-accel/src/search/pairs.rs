//! Pairs of a line and a triangle that are intersected together.

use crate::grid::GridLine;
use crate::simd::backend::{LEAF_WIDTH, SimdBackend};
use crate::triangle::{EdgeTest, GridTriangle};

/// Eight pairs of a line and a triangle, one per lane.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(crate) struct Pairs {
    /// Origin and direction of the line.
    line: [[[f64; LEAF_WIDTH]; 3]; 2],
    corners: [[[i32; LEAF_WIDTH]; 3]; 3],
    certain: [f32; LEAF_WIDTH],
}

impl Pairs {
    pub(crate) const NONE: Self = Self {
        line: [[[0.0; LEAF_WIDTH]; 3]; 2],
        corners: [[[0; LEAF_WIDTH]; 3]; 3],
        certain: [0.0; LEAF_WIDTH],
    };

    #[inline(always)]
    pub(crate) fn set(&mut self, lane: usize, triangle: &GridTriangle, line: &GridLine) {
        let lane = lane % LEAF_WIDTH;
        for axis in 0..3 {
            self.line[0][axis][lane] = line.origin[axis];
            self.line[1][axis][lane] = line.direction[axis];
            for corner in 0..3 {
                self.corners[corner][axis][lane] = triangle.corners[corner][axis];
            }
        }
        self.certain[lane] = triangle.certain;
    }

    /// Computes the edge functions of all pairs.
    #[inline(always)]
    pub(crate) fn test<B: SimdBackend>(&self, backend: B) -> EdgeTest<B::PairF64> {
        let numbers = |v: &[[f64; LEAF_WIDTH]; 3]| {
            [backend.load_f64(&v[0]), backend.load_f64(&v[1]), backend.load_f64(&v[2])]
        };
        let integers = |v: &[[i32; LEAF_WIDTH]; 3]| {
            [backend.i32_to_f64(&v[0]), backend.i32_to_f64(&v[1]), backend.i32_to_f64(&v[2])]
        };
        let [a, b, c] = &self.corners;
        let certain = backend.f32_to_f64(&self.certain);
        let [origin, direction] = &self.line;
        EdgeTest::new([integers(a), integers(b), integers(c)], certain, numbers(origin), numbers(direction))
    }
}
