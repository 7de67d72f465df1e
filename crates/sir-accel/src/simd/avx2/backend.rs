//! The AVX2 backend.
#![allow(unsafe_code, reason = "vector instructions; the token proves them")]

use std::arch::x86_64::*;

use crate::simd::avx2::double::F64x8;
use crate::simd::avx2::integer::{compress8, compress16, lane_numbers, sort4, sort8};
use crate::simd::avx2::single::{F32x8, F32x16};
use crate::simd::avx2::token::Avx2;
use crate::simd::backend::{Kernel, LEAF_WIDTH, NODE_WIDTH, SimdBackend};
use crate::simd::insertion;
use crate::simd::x86::compiled_for;

impl SimdBackend for Avx2 {
    type NodeF32 = F32x16;
    type LeafF32 = F32x8;
    type PairF64 = F64x8;

    compiled_for!("avx2,fma,bmi1,bmi2,popcnt");

    #[inline(always)]
    fn load_node(self, numbers: &[f32; NODE_WIDTH]) -> F32x16 {
        F32x16::load(self, numbers)
    }

    #[inline(always)]
    fn splat_node(self, number: f32) -> F32x16 {
        F32x16::splat(self, number)
    }

    #[inline(always)]
    fn load_leaf(self, numbers: &[f32; LEAF_WIDTH]) -> F32x8 {
        F32x8::load(self, numbers)
    }

    #[inline(always)]
    fn splat_leaf(self, number: f32) -> F32x8 {
        F32x8::splat(self, number)
    }

    #[inline(always)]
    fn load_f64(self, numbers: &[f64; LEAF_WIDTH]) -> F64x8 {
        F64x8::load(self, numbers)
    }

    #[inline(always)]
    fn splat_f64(self, number: f64) -> F64x8 {
        F64x8::splat(self, number)
    }

    #[inline(always)]
    fn i32_to_f64(self, numbers: &[i32; LEAF_WIDTH]) -> F64x8 {
        F64x8::from_i32(self, numbers)
    }

    #[inline(always)]
    fn f32_to_f64(self, numbers: &[f32; LEAF_WIDTH]) -> F64x8 {
        F64x8::from_f32(self, numbers)
    }

    #[inline(always)]
    fn highest_bits(self, numbers: &[u32; NODE_WIDTH]) -> u32 {
        // SAFETY: the token proves AVX; the array has twice 8 elements.
        unsafe {
            let low = _mm256_movemask_ps(_mm256_loadu_ps(numbers.as_ptr().cast())) as u32;
            let high = _mm256_movemask_ps(_mm256_loadu_ps(numbers.as_ptr().add(8).cast())) as u32;
            low | high << 8
        }
    }

    #[inline(always)]
    fn compress(self, numbers: &[u32; NODE_WIDTH], mask: u32, to: &mut [u32; NODE_WIDTH]) {
        // SAFETY: the token proves AVX; the array has twice 8 elements.
        let halves = unsafe {
            [_mm256_loadu_si256(numbers.as_ptr().cast()), _mm256_loadu_si256(numbers.as_ptr().add(8).cast())]
        };
        compress16(self, halves, mask, to);
    }

    #[inline(always)]
    fn compress_range(self, first: u32, mask: u32, to: &mut [u32; LEAF_WIDTH]) {
        // SAFETY: the token proves AVX2; the array has 8 elements.
        unsafe {
            let numbers = _mm256_add_epi32(lane_numbers(self), _mm256_set1_epi32(first as i32));
            _mm256_storeu_si256(to.as_mut_ptr().cast(), compress8(self, numbers, mask));
        }
    }

    #[inline(always)]
    fn sort(
        self,
        keys: F32x16,
        numbers: &[u32; NODE_WIDTH],
        mask: u32,
        keys_to: &mut [f32; NODE_WIDTH],
        to: &mut [u32; NODE_WIDTH],
    ) {
        let count = mask.count_ones();
        if count > 8 {
            let mut all = [0.0; NODE_WIDTH];
            keys.store(&mut all);
            return insertion::sort(&all, numbers, mask, keys_to, to);
        }
        // SAFETY: the token proves AVX2; the arrays have 16 elements.
        unsafe {
            // The lane number replaces the last bits of its key. Keys are not negative, so their bits have the order of
            // integers.
            let exact = _mm256_set1_epi32(!(NODE_WIDTH as i32 - 1));
            let with_lane = |keys: __m256i, first: i32| {
                let lanes = _mm256_add_epi32(lane_numbers(self), _mm256_set1_epi32(first));
                _mm256_or_si256(_mm256_and_si256(keys, exact), lanes)
            };
            let mut front = [0; NODE_WIDTH];
            let [low, high] = keys.to_bits();
            compress16(self, [with_lane(low, 0), with_lane(high, 8)], mask, &mut front);
            // Unused lanes become zero and end up last.
            let used = _mm256_cmpgt_epi32(_mm256_set1_epi32(count as i32), lane_numbers(self));
            let keys = _mm256_and_si256(_mm256_loadu_si256(front.as_ptr().cast()), used);
            let keys = if count > 4 { sort8(self, keys) } else { sort4(self, keys) };
            let half = |start: usize| {
                let half = _mm256_loadu_si256(numbers.as_ptr().add(start).cast());
                _mm256_castsi256_ps(_mm256_permutevar8x32_epi32(half, keys))
            };
            // The fourth bit of the lane number selects the half.
            let second = _mm256_castsi256_ps(_mm256_slli_epi32::<28>(keys));
            _mm256_storeu_ps(to.as_mut_ptr().cast(), _mm256_blendv_ps(half(0), half(8), second));
            _mm256_storeu_si256(keys_to.as_mut_ptr().cast(), _mm256_and_si256(keys, exact));
        }
    }
}
