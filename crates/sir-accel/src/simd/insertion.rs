//! Insertion sort, for backends and numbers of keys without a sorting network.

use crate::simd::backend::NODE_WIDTH;

/// Sorts as [`SimdBackend::sort`](crate::simd::backend::SimdBackend::sort) does, one number at a time.
#[inline(always)]
pub(crate) fn sort(
    keys: &[f32; NODE_WIDTH],
    numbers: &[u32; NODE_WIDTH],
    mask: u32,
    keys_to: &mut [f32; NODE_WIDTH],
    to: &mut [u32; NODE_WIDTH],
) {
    let (mut mask, mut count) = (mask, 0);
    while mask != 0 && count < NODE_WIDTH {
        let lane = mask.trailing_zeros() as usize % NODE_WIDTH;
        mask &= mask - 1;
        let key = keys[lane];
        let mut i = count;
        while i > 0 && keys_to[i - 1] < key {
            (keys_to[i], to[i]) = (keys_to[i - 1], to[i - 1]);
            i -= 1;
        }
        (keys_to[i], to[i]) = (key, numbers[lane]);
        count += 1;
    }
}
