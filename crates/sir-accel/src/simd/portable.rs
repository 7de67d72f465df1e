//! Arrays, for any processor.

use std::array::from_fn;

use crate::simd::backend::{F32Lanes, F64Lanes, F64Store, Kernel, LEAF_WIDTH, NODE_WIDTH, SimdBackend};
use crate::simd::insertion;

/// Needs no vector instructions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Portable;

impl SimdBackend for Portable {
    type NodeF32 = [f32; NODE_WIDTH];
    type LeafF32 = [f32; LEAF_WIDTH];
    type PairF64 = [f64; LEAF_WIDTH];

    #[inline(always)]
    fn run<K: Kernel>(self, kernel: K) -> K::Output {
        kernel.run(self)
    }

    #[inline(always)]
    fn outline<R, F: FnOnce() -> R>(self, work: F) -> R {
        work()
    }

    #[inline(always)]
    fn load_node(self, numbers: &[f32; NODE_WIDTH]) -> [f32; NODE_WIDTH] {
        *numbers
    }

    #[inline(always)]
    fn splat_node(self, number: f32) -> [f32; NODE_WIDTH] {
        [number; NODE_WIDTH]
    }

    #[inline(always)]
    fn load_leaf(self, numbers: &[f32; LEAF_WIDTH]) -> [f32; LEAF_WIDTH] {
        *numbers
    }

    #[inline(always)]
    fn splat_leaf(self, number: f32) -> [f32; LEAF_WIDTH] {
        [number; LEAF_WIDTH]
    }

    #[inline(always)]
    fn load_f64(self, numbers: &[f64; LEAF_WIDTH]) -> [f64; LEAF_WIDTH] {
        *numbers
    }

    #[inline(always)]
    fn splat_f64(self, number: f64) -> [f64; LEAF_WIDTH] {
        [number; LEAF_WIDTH]
    }

    #[inline(always)]
    fn i32_to_f64(self, numbers: &[i32; LEAF_WIDTH]) -> [f64; LEAF_WIDTH] {
        numbers.map(f64::from)
    }

    #[inline(always)]
    fn f32_to_f64(self, numbers: &[f32; LEAF_WIDTH]) -> [f64; LEAF_WIDTH] {
        numbers.map(f64::from)
    }

    #[inline(always)]
    fn highest_bits(self, numbers: &[u32; NODE_WIDTH]) -> u32 {
        numbers.iter().enumerate().fold(0, |mask, (lane, number)| mask | (number >> 31) << lane)
    }

    #[inline(always)]
    fn compress(self, numbers: &[u32; NODE_WIDTH], mask: u32, to: &mut [u32; NODE_WIDTH]) {
        compress(numbers, mask, to);
    }

    #[inline(always)]
    fn compress_range(self, first: u32, mask: u32, to: &mut [u32; LEAF_WIDTH]) {
        compress(&from_fn(|lane| first + lane as u32), mask, to);
    }

    #[inline(always)]
    fn sort(
        self,
        keys: [f32; NODE_WIDTH],
        numbers: &[u32; NODE_WIDTH],
        mask: u32,
        keys_to: &mut [f32; NODE_WIDTH],
        to: &mut [u32; NODE_WIDTH],
    ) {
        insertion::sort(&keys, numbers, mask, keys_to, to);
    }
}

/// Writes the items in the mask to the front of `to`.
#[inline(always)]
fn compress<T: Copy, const N: usize>(from: &[T; N], mask: u32, to: &mut [T; N]) {
    let (mut mask, mut count) = (mask, 0);
    while mask != 0 && count < N {
        to[count] = from[mask.trailing_zeros() as usize % N];
        mask &= mask - 1;
        count += 1;
    }
}

impl<const N: usize> F32Lanes<N> for [f32; N] {
    #[inline(always)]
    fn compress(self, mask: u32, to: &mut [f32; N]) {
        compress(&self, mask, to);
    }

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        from_fn(|i| self[i] - other[i])
    }

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        from_fn(|i| self[i] * other[i])
    }

    #[inline(always)]
    fn mul_add(self, factor: Self, term: Self) -> Self {
        from_fn(|i| self[i] * factor[i] + term[i])
    }

    #[inline(always)]
    fn mul_sub(self, factor: Self, term: Self) -> Self {
        from_fn(|i| self[i] * factor[i] - term[i])
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        from_fn(|i| if self[i] < other[i] { self[i] } else { other[i] })
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        from_fn(|i| if self[i] > other[i] { self[i] } else { other[i] })
    }

    #[inline(always)]
    fn mask_le(self, other: Self) -> u32 {
        (0..N).fold(0, |mask, i| mask | u32::from(self[i] <= other[i]) << i)
    }
}

impl F64Lanes for [f64; LEAF_WIDTH] {
    #[inline(always)]
    fn splat(self, number: f64) -> Self {
        [number; LEAF_WIDTH]
    }

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        from_fn(|i| self[i] + other[i])
    }

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        from_fn(|i| self[i] - other[i])
    }

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        from_fn(|i| self[i] * other[i])
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        from_fn(|i| if self[i] < other[i] { self[i] } else { other[i] })
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        from_fn(|i| if self[i] > other[i] { self[i] } else { other[i] })
    }

    #[inline(always)]
    fn mask_le(self, other: Self) -> u32 {
        (0..LEAF_WIDTH).fold(0, |mask, i| mask | u32::from(self[i] <= other[i]) << i)
    }

    #[inline(always)]
    fn mask_lt(self, other: Self) -> u32 {
        (0..LEAF_WIDTH).fold(0, |mask, i| mask | u32::from(self[i] < other[i]) << i)
    }
}

impl F64Store for [f64; LEAF_WIDTH] {
    #[inline(always)]
    fn store(self, to: &mut [f64; LEAF_WIDTH]) {
        *to = self;
    }
}
