//! Triangles left after culling in single precision, and their exact test.

use sir_types::{Barycentric, Side};

use crate::grid::GridLine;
use crate::line_f32::LineF32;
use crate::search::pairs::Pairs;
use crate::search::queue::{MAX_LINES, Queue};
use crate::simd::backend::{F64Store, LEAF_WIDTH, SimdBackend};
use crate::tree::Tree;
use crate::triangle::{Crossing, Factors};

/// Triangles that lines may cross, and the results of their tests.
#[derive(Clone, Debug, Default)]
pub(crate) struct Candidates {
    /// Places of the triangles in the tree. The line is set to [`NO_LINE`] if it does not cross the triangle.
    pub(crate) found: Queue,
    /// True if the front of the triangle faces the origin of the line.
    fronts: Vec<bool>,
    pub(crate) factors: Factors<Vec<f64>>,
    pairs: Vec<Pairs>,
}

/// Line number that stands for no line.
pub(crate) const NO_LINE: u8 = MAX_LINES as u8;

impl Candidates {
    /// Replaces the last three factors by the distance and the barycentric coordinates of each crossing.
    #[inline(always)]
    pub(crate) fn locate(&mut self, len: usize) {
        let [e_ab, e_ca, all, a, ab, ac] = self.factors.each_mut().map(|list| &mut list[..len]);
        for i in 0..len {
            let (t, point) = Crossing::locate([e_ab[i], e_ca[i], all[i], a[i], ab[i], ac[i]]);
            (a[i], ab[i], ac[i]) = (t, point.v, point.w);
        }
    }

    /// Prefetches the triangles.
    #[inline(always)]
    pub(crate) fn prefetch(&self, len: usize, tree: &Tree) {
        self.found.items[..len].iter().for_each(|&place| tree.prefetch_triangle(place));
    }

    /// Returns the distances of the located crossings \[steps of the grid\].
    #[inline(always)]
    pub(crate) fn distances(&self) -> &[f64] {
        &self.factors[3]
    }

    /// Returns a located crossing.
    #[inline(always)]
    pub(crate) fn crossing(&self, i: usize, tree: &Tree) -> Crossing {
        let [.., t, v, w] = &self.factors;
        let side = if self.fronts[i] { Side::Front } else { Side::Back };
        let triangle = &tree.triangles[self.found.items[i] as usize];
        Crossing::new(triangle, t[i], Barycentric { v: v[i], w: w[i] }, side)
    }

    /// Tests pairs of a line and a triangle, eight at a time.
    #[inline(always)]
    pub(crate) fn test<B: SimdBackend>(
        &mut self,
        backend: B,
        len: usize,
        tree: &Tree,
        lines: &[(GridLine, LineF32)],
    ) {
        // Lay out all pairs first, lane by lane: reading a vector right after its lanes were written one by one is
        // slow.
        let blocks = len.div_ceil(LEAF_WIDTH);
        if self.pairs.len() < blocks {
            self.pairs.resize(blocks, Pairs::NONE);
            self.fronts.resize(blocks * LEAF_WIDTH, false);
            self.factors.iter_mut().for_each(|list| list.resize(blocks * LEAF_WIDTH, 0.0));
        }
        let Queue { items, lines: of_lines } = &mut self.found;
        for (block, pairs) in self.pairs[..blocks].iter_mut().enumerate() {
            for lane in 0..LEAF_WIDTH.min(len - block * LEAF_WIDTH) {
                let i = block * LEAF_WIDTH + lane;
                let line = &lines[usize::from(of_lines[i])].0;
                pairs.set(lane, &tree.triangles[items[i] as usize], line);
            }
        }
        for block in 0..blocks {
            let start = block * LEAF_WIDTH;
            let end = len.min(start + LEAF_WIDTH);
            let test = self.pairs[block].test(backend);
            for (factor, list) in test.factors.iter().zip(&mut self.factors) {
                if let Some(to) = list[start..].first_chunk_mut() {
                    factor.store(to);
                }
            }
            let (crossed, front) = (test.back | test.front, test.front);
            if let Some(to) = self.fronts[start..].first_chunk_mut::<LEAF_WIDTH>() {
                *to = std::array::from_fn(|lane| front >> lane & 1 == 1);
            }
            if !crossed & (u32::MAX >> (32 - (end - start))) != 0 {
                for i in start..end {
                    let lane = i - start;
                    if test.doubt >> lane & 1 == 1 {
                        let triangle = &tree.triangles[items[i] as usize];
                        let side = triangle.exact_crossing(&lines[usize::from(of_lines[i])].0);
                        self.fronts[i] = side == Some(Side::Front);
                        of_lines[i] = if side.is_none() { NO_LINE } else { of_lines[i] };
                    } else if crossed >> lane & 1 == 0 {
                        of_lines[i] = NO_LINE;
                    }
                }
            }
        }
    }
}
