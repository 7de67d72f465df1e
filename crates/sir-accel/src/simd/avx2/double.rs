//! Vectors of numbers in double precision.
#![allow(unsafe_code, reason = "vector instructions; values exist only where the token proves them")]

use std::arch::x86_64::*;

use crate::simd::avx2::token::Avx2;
use crate::simd::backend::{F64Lanes, F64Store, LEAF_WIDTH};
use crate::simd::x86::halves;

/// Eight numbers in two halves. The value holds the token that proves AVX2.
#[derive(Clone, Copy)]
pub(crate) struct F64x8(__m256d, __m256d, Avx2);

impl F64x8 {
    /// Loads one number per lane.
    #[inline(always)]
    pub(crate) fn load(token: Avx2, numbers: &[f64; LEAF_WIDTH]) -> Self {
        // SAFETY: the token proves AVX; the array has twice 4 elements.
        unsafe { Self(_mm256_loadu_pd(numbers.as_ptr()), _mm256_loadu_pd(numbers.as_ptr().add(4)), token) }
    }

    /// Returns a vector with the same number in all lanes.
    #[inline(always)]
    pub(crate) fn splat(token: Avx2, number: f64) -> Self {
        // SAFETY: the token proves AVX.
        let all = unsafe { _mm256_set1_pd(number) };
        Self(all, all, token)
    }

    /// Converts one number per lane.
    #[inline(always)]
    pub(crate) fn from_i32(token: Avx2, numbers: &[i32; LEAF_WIDTH]) -> Self {
        // SAFETY: the token proves AVX; the array has twice 4 elements.
        unsafe {
            let low = _mm_loadu_si128(numbers.as_ptr().cast());
            let high = _mm_loadu_si128(numbers.as_ptr().add(4).cast());
            Self(_mm256_cvtepi32_pd(low), _mm256_cvtepi32_pd(high), token)
        }
    }

    /// Converts one number per lane.
    #[inline(always)]
    pub(crate) fn from_f32(token: Avx2, numbers: &[f32; LEAF_WIDTH]) -> Self {
        // SAFETY: the token proves AVX; the array has twice 4 elements.
        unsafe {
            let (low, high) = (_mm_loadu_ps(numbers.as_ptr()), _mm_loadu_ps(numbers.as_ptr().add(4)));
            Self(_mm256_cvtps_pd(low), _mm256_cvtps_pd(high), token)
        }
    }
}

/// Defines a method that returns the mask of the lanes for which a comparison holds.
macro_rules! mask {
    ($method:ident, $comparison:ident) => {
        #[inline(always)]
        fn $method(self, other: Self) -> u32 {
            // SAFETY: the value holds the token.
            unsafe {
                let low = _mm256_movemask_pd(_mm256_cmp_pd::<$comparison>(self.0, other.0)) as u32;
                let high = _mm256_movemask_pd(_mm256_cmp_pd::<$comparison>(self.1, other.1)) as u32;
                low | high << 4
            }
        }
    };
}

impl F64Lanes for F64x8 {
    halves!(add, _mm256_add_pd, other);
    halves!(sub, _mm256_sub_pd, other);
    halves!(mul, _mm256_mul_pd, other);
    halves!(min, _mm256_min_pd, other);
    halves!(max, _mm256_max_pd, other);
    mask!(mask_le, _CMP_LE_OQ);
    mask!(mask_lt, _CMP_LT_OQ);

    #[inline(always)]
    fn splat(self, number: f64) -> Self {
        Self::splat(self.2, number)
    }
}

impl F64Store for F64x8 {
    #[inline(always)]
    fn store(self, to: &mut [f64; LEAF_WIDTH]) {
        // SAFETY: the value holds the token; the array has twice 4 elements.
        unsafe {
            _mm256_storeu_pd(to.as_mut_ptr(), self.0);
            _mm256_storeu_pd(to.as_mut_ptr().add(4), self.1);
        }
    }
}
