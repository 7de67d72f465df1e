//! Work that is to be done for many lines.

use crate::simd::backend::{LEAF_WIDTH, NODE_WIDTH, SimdBackend};

/// Largest number of lines that are searched at the same time; their numbers fit a byte.
pub(crate) const MAX_LINES: usize = 128;

/// How many items ahead memory is prefetched.
const AHEAD: usize = 12;

/// Nodes, leaves or triangles, each with the number of the line that reaches it. The number of items is kept by those who add to it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Queue {
    pub(crate) items: Vec<u32>,
    pub(crate) lines: Vec<u8>,
}

impl Queue {
    /// Adds the items in the mask to a queue with `len` of them, and returns how many it has then.
    #[inline(always)]
    pub(crate) fn add<B: SimdBackend>(
        &mut self,
        backend: B,
        len: usize,
        items: &[u32; NODE_WIDTH],
        mask: u32,
        line: u8,
    ) -> usize {
        if let Some(to) = self.room(len, line) {
            backend.compress(items, mask, to);
        }
        len + mask.count_ones() as usize
    }

    /// Adds the numbers from `first` on that are in the mask to a queue with `len` items, and returns how many it has then.
    #[inline(always)]
    pub(crate) fn add_range<B: SimdBackend>(
        &mut self,
        backend: B,
        len: usize,
        first: u32,
        mask: u32,
        line: u8,
    ) -> usize {
        if let Some(to) = self.room::<LEAF_WIDTH>(len, line) {
            backend.compress_range(first, mask, to);
        }
        len + mask.count_ones() as usize
    }

    /// Makes room for `N` more items of a line.
    #[inline(always)]
    fn room<const N: usize>(&mut self, len: usize, line: u8) -> Option<&mut [u32; N]> {
        if self.items.len() < len + N || self.lines.len() < len + N {
            self.grow();
        }
        self.lines[len..len + N].fill(line);
        self.items[len..].first_chunk_mut()
    }

    #[cold]
    #[inline(never)]
    fn grow(&mut self) {
        let len = (2 * self.items.len()).max(16 * MAX_LINES);
        self.items.resize(len, 0);
        self.lines.resize(len, 0);
    }

    /// The item whose memory should be prefetched while the i-th is worked on.
    #[inline(always)]
    pub(crate) fn ahead(&self, i: usize) -> u32 {
        self.items.get(i + AHEAD).copied().unwrap_or(0)
    }
}
