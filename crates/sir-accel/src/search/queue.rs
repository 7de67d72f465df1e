//! Work queues of the searches.

use crate::simd::backend::{LEAF_WIDTH, NODE_WIDTH, SimdBackend};

/// Largest number of lines that are searched at the same time; their numbers fit in a byte.
pub(crate) const MAX_LINES: usize = 128;

/// Number of items by which prefetching runs ahead.
const AHEAD: usize = 12;

/// Nodes, leaves or triangles, each with the number of the line that reaches it. The caller keeps the number of items.
#[derive(Clone, Debug, Default)]
pub(crate) struct Queue {
    pub(crate) items: Vec<u32>,
    pub(crate) lines: Vec<u8>,
}

impl Queue {
    /// Adds the items in the mask to a queue with `len` items, and returns the new number of items.
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

    /// Adds `first` plus each lane number in the mask to a queue with `len` items, and returns the new number of items.
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

    /// Makes room for `N` more items of a line, and returns it.
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

    /// Returns the item to prefetch while item `i` is processed.
    #[inline(always)]
    pub(crate) fn ahead(&self, i: usize) -> u32 {
        self.items.get(i + AHEAD).copied().unwrap_or(0)
    }
}
