//! Vectors of numbers in single precision.
#![allow(unsafe_code, reason = "vector instructions; values exist only where the token proves them")]

use std::arch::x86_64::*;

use crate::simd::avx2::integer::{compress8, compress16};
use crate::simd::avx2::token::Avx2;
use crate::simd::backend::{F32Lanes, LEAF_WIDTH, NODE_WIDTH};
use crate::simd::x86::{halves, lanewise};

/// Eight numbers. The value holds the token that proves AVX2 and FMA.
#[derive(Clone, Copy)]
pub(crate) struct F32x8(__m256, Avx2);

impl F32x8 {
    /// Loads one number per lane.
    #[inline(always)]
    pub(crate) fn load(token: Avx2, numbers: &[f32; LEAF_WIDTH]) -> Self {
        // SAFETY: the token proves AVX; the array has 8 elements.
        Self(unsafe { _mm256_loadu_ps(numbers.as_ptr()) }, token)
    }

    /// Returns a vector with the same number in all lanes.
    #[inline(always)]
    pub(crate) fn splat(token: Avx2, number: f32) -> Self {
        // SAFETY: the token proves AVX.
        Self(unsafe { _mm256_set1_ps(number) }, token)
    }
}

/// Sixteen numbers in two halves. The value holds the token that proves AVX2 and FMA.
#[derive(Clone, Copy)]
pub(crate) struct F32x16(__m256, __m256, Avx2);

impl F32x16 {
    /// Loads one number per lane.
    #[inline(always)]
    pub(crate) fn load(token: Avx2, numbers: &[f32; NODE_WIDTH]) -> Self {
        // SAFETY: the token proves AVX; the array has twice 8 elements.
        unsafe { Self(_mm256_loadu_ps(numbers.as_ptr()), _mm256_loadu_ps(numbers.as_ptr().add(8)), token) }
    }

    /// Returns a vector with the same number in all lanes.
    #[inline(always)]
    pub(crate) fn splat(token: Avx2, number: f32) -> Self {
        // SAFETY: the token proves AVX.
        let all = unsafe { _mm256_set1_ps(number) };
        Self(all, all, token)
    }

    /// Stores one number per lane.
    #[inline(always)]
    pub(crate) fn store(self, to: &mut [f32; NODE_WIDTH]) {
        // SAFETY: the value holds the token; the array has twice 8 elements.
        unsafe {
            _mm256_storeu_ps(to.as_mut_ptr(), self.0);
            _mm256_storeu_ps(to.as_mut_ptr().add(8), self.1);
        }
    }

    /// Returns the bits of the two halves.
    #[inline(always)]
    pub(crate) fn to_bits(self) -> [__m256i; 2] {
        // SAFETY: the value holds the token.
        unsafe { [_mm256_castps_si256(self.0), _mm256_castps_si256(self.1)] }
    }
}

/// Returns the mask of the lanes where `a ≤ b`.
#[inline(always)]
fn mask_le(_: Avx2, a: __m256, b: __m256) -> u32 {
    // SAFETY: the token proves AVX.
    unsafe { _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(a, b)) as u32 }
}

impl F32Lanes<LEAF_WIDTH> for F32x8 {
    lanewise!(sub, _mm256_sub_ps, other);
    lanewise!(mul, _mm256_mul_ps, other);
    lanewise!(mul_add, _mm256_fmadd_ps, factor, term);
    lanewise!(mul_sub, _mm256_fmsub_ps, factor, term);
    lanewise!(min, _mm256_min_ps, other);
    lanewise!(max, _mm256_max_ps, other);

    #[inline(always)]
    fn compress(self, mask: u32, to: &mut [f32; LEAF_WIDTH]) {
        // SAFETY: the value holds the token; the array has 8 elements.
        unsafe {
            let front = compress8(self.1, _mm256_castps_si256(self.0), mask);
            _mm256_storeu_si256(to.as_mut_ptr().cast(), front);
        }
    }

    #[inline(always)]
    fn mask_le(self, other: Self) -> u32 {
        mask_le(self.1, self.0, other.0)
    }
}

impl F32Lanes<NODE_WIDTH> for F32x16 {
    halves!(sub, _mm256_sub_ps, other);
    halves!(mul, _mm256_mul_ps, other);
    halves!(mul_add, _mm256_fmadd_ps, factor, term);
    halves!(mul_sub, _mm256_fmsub_ps, factor, term);
    halves!(min, _mm256_min_ps, other);
    halves!(max, _mm256_max_ps, other);

    #[inline(always)]
    fn compress(self, mask: u32, to: &mut [f32; NODE_WIDTH]) {
        let mut bits = [0; NODE_WIDTH];
        compress16(self.2, self.to_bits(), mask, &mut bits);
        *to = bits.map(f32::from_bits);
    }

    #[inline(always)]
    fn mask_le(self, other: Self) -> u32 {
        mask_le(self.2, self.0, other.0) | mask_le(self.2, self.1, other.1) << 8
    }
}
