//! Portable backend: plain arrays, for any processor.

use std::array::from_fn;

use crate::simd::backend::{F32Lanes, F64Lanes, F64Store, Kernel, LEAF_WIDTH, NODE_WIDTH, SimdBackend};
use crate::simd::insertion;

/// Backend without vector instructions.
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

/// Defines a method that applies a function to the lanes of `self` and of the other arguments.
macro_rules! lanewise {
    ($method:ident, $function:expr $(, $argument:ident)*) => {
        #[inline(always)]
        fn $method(self $(, $argument: Self)*) -> Self {
            let function = $function;
            from_fn(|lane| function(self[lane] $(, $argument[lane])*))
        }
    };
}

/// Defines a method that returns the mask of the lanes for which a comparison holds.
macro_rules! mask {
    ($method:ident, $comparison:tt) => {
        #[inline(always)]
        fn $method(self, other: Self) -> u32 {
            let holds = |lane: usize| self[lane] $comparison other[lane];
            (0..self.len()).fold(0, |mask, lane| mask | u32::from(holds(lane)) << lane)
        }
    };
}

impl<const N: usize> F32Lanes<N> for [f32; N] {
    lanewise!(sub, |a, b| a - b, other);
    lanewise!(mul, |a, b| a * b, other);
    lanewise!(mul_add, |a, b, c| a * b + c, factor, term);
    lanewise!(mul_sub, |a, b, c| a * b - c, factor, term);
    lanewise!(min, |a, b| if a < b { a } else { b }, other);
    lanewise!(max, |a, b| if a > b { a } else { b }, other);
    mask!(mask_le, <=);

    #[inline(always)]
    fn compress(self, mask: u32, to: &mut [f32; N]) {
        compress(&self, mask, to);
    }
}

impl F64Lanes for [f64; LEAF_WIDTH] {
    lanewise!(add, |a, b| a + b, other);
    lanewise!(sub, |a, b| a - b, other);
    lanewise!(mul, |a, b| a * b, other);
    lanewise!(min, |a, b| if a < b { a } else { b }, other);
    lanewise!(max, |a, b| if a > b { a } else { b }, other);
    mask!(mask_le, <=);
    mask!(mask_lt, <);

    #[inline(always)]
    fn splat(self, number: f64) -> Self {
        [number; LEAF_WIDTH]
    }
}

impl F64Store for [f64; LEAF_WIDTH] {
    #[inline(always)]
    fn store(self, to: &mut [f64; LEAF_WIDTH]) {
        *to = self;
    }
}
