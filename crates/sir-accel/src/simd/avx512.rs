//! AVX-512 backend: 16 numbers in single precision, or 8 in double precision, at a time.
#![allow(unsafe_code, reason = "vector instructions; the token proves them, and vectors hold the token")]

use std::arch::x86_64::*;

use crate::simd::avx2::integer::{lane_numbers, sort4, sort8};
use crate::simd::avx2::single::F32x8;
use crate::simd::avx2::token::Avx2;
use crate::simd::backend::{F32Lanes, F64Lanes, F64Store, Kernel, LEAF_WIDTH, NODE_WIDTH, SimdBackend};
use crate::simd::insertion;
use crate::simd::x86::{compiled_for, lanewise};

/// Token that exists only if the processor has AVX-512 F, DQ and VL, in addition to what [`Avx2`] proves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Avx512(Avx2);

impl Avx512 {
    /// Returns the token if the processor has the instructions.
    pub(crate) fn detect() -> Option<Self> {
        let has_all = is_x86_feature_detected!("avx512f")
            && is_x86_feature_detected!("avx512dq")
            && is_x86_feature_detected!("avx512vl");
        Avx2::detect().filter(|_| has_all).map(Self)
    }
}

impl SimdBackend for Avx512 {
    type NodeF32 = F32x16;
    type LeafF32 = F32x8;
    type PairF64 = F64x8;

    compiled_for!("avx512f,avx512dq,avx512vl,avx2,fma,bmi1,bmi2,popcnt");

    #[inline(always)]
    fn load_node(self, numbers: &[f32; NODE_WIDTH]) -> F32x16 {
        // SAFETY: the token proves AVX-512; the array has 16 elements.
        F32x16(unsafe { _mm512_loadu_ps(numbers.as_ptr()) }, self)
    }

    #[inline(always)]
    fn splat_node(self, number: f32) -> F32x16 {
        // SAFETY: the token proves AVX-512.
        F32x16(unsafe { _mm512_set1_ps(number) }, self)
    }

    #[inline(always)]
    fn load_leaf(self, numbers: &[f32; LEAF_WIDTH]) -> F32x8 {
        F32x8::load(self.0, numbers)
    }

    #[inline(always)]
    fn splat_leaf(self, number: f32) -> F32x8 {
        F32x8::splat(self.0, number)
    }

    #[inline(always)]
    fn load_f64(self, numbers: &[f64; LEAF_WIDTH]) -> F64x8 {
        // SAFETY: the token proves AVX-512; the array has 8 elements.
        F64x8(unsafe { _mm512_loadu_pd(numbers.as_ptr()) }, self)
    }

    #[inline(always)]
    fn splat_f64(self, number: f64) -> F64x8 {
        // SAFETY: the token proves AVX-512.
        F64x8(unsafe { _mm512_set1_pd(number) }, self)
    }

    #[inline(always)]
    fn i32_to_f64(self, numbers: &[i32; LEAF_WIDTH]) -> F64x8 {
        // SAFETY: the token proves AVX-512; the array has 8 elements.
        F64x8(unsafe { _mm512_cvtepi32_pd(_mm256_loadu_si256(numbers.as_ptr().cast())) }, self)
    }

    #[inline(always)]
    fn f32_to_f64(self, numbers: &[f32; LEAF_WIDTH]) -> F64x8 {
        // SAFETY: the token proves AVX-512; the array has 8 elements.
        F64x8(unsafe { _mm512_cvtps_pd(_mm256_loadu_ps(numbers.as_ptr())) }, self)
    }

    #[inline(always)]
    fn highest_bits(self, numbers: &[u32; NODE_WIDTH]) -> u32 {
        // SAFETY: the token proves AVX-512; the array has 16 elements.
        unsafe { u32::from(_mm512_movepi32_mask(_mm512_loadu_si512(numbers.as_ptr().cast()))) }
    }

    #[inline(always)]
    fn compress(self, numbers: &[u32; NODE_WIDTH], mask: u32, to: &mut [u32; NODE_WIDTH]) {
        // Compress to a register and store that: compressing straight to memory is slow on some processors (Zen 4).
        // SAFETY: the token proves AVX-512; the arrays have 16 elements.
        unsafe {
            let numbers = _mm512_loadu_si512(numbers.as_ptr().cast());
            let front = _mm512_maskz_compress_epi32(mask as __mmask16, numbers);
            _mm512_storeu_si512(to.as_mut_ptr().cast(), front);
        }
    }

    #[inline(always)]
    fn compress_range(self, first: u32, mask: u32, to: &mut [u32; LEAF_WIDTH]) {
        // SAFETY: the token proves AVX-512; the array has 8 elements.
        unsafe {
            let numbers = _mm256_add_epi32(lane_numbers(self.0), _mm256_set1_epi32(first as i32));
            let front = _mm256_maskz_compress_epi32(mask as __mmask8, numbers);
            _mm256_storeu_si256(to.as_mut_ptr().cast(), front);
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
            // SAFETY: the token proves AVX-512; the array has 16 elements.
            unsafe { _mm512_storeu_ps(all.as_mut_ptr(), keys.0) }
            return insertion::sort(&all, numbers, mask, keys_to, to);
        }
        // SAFETY: the token proves AVX-512; the arrays have 16 elements.
        unsafe {
            // The lane number replaces the last bits of its key. Keys are not negative, so their bits have the order of
            // integers.
            let lanes = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
            let exact = _mm512_set1_epi32(!(NODE_WIDTH as i32 - 1));
            let keys = _mm512_ternarylogic_epi32::<0xF8>(lanes, _mm512_castps_si512(keys.0), exact);
            // Unused lanes are zero and end up last.
            let keys = _mm512_castsi512_si256(_mm512_maskz_compress_epi32(mask as __mmask16, keys));
            let keys = if count > 4 { sort8(self.0, keys) } else { sort4(self.0, keys) };
            let numbers = _mm512_loadu_si512(numbers.as_ptr().cast());
            let sorted = _mm512_permutexvar_epi32(_mm512_castsi256_si512(keys), numbers);
            let keys = _mm256_and_si256(keys, _mm512_castsi512_si256(exact));
            _mm256_storeu_si256(keys_to.as_mut_ptr().cast(), keys);
            _mm256_storeu_si256(to.as_mut_ptr().cast(), _mm512_castsi512_si256(sorted));
        }
    }
}

/// Sixteen numbers in single precision. The value holds the token that proves AVX-512.
#[derive(Clone, Copy)]
pub(crate) struct F32x16(__m512, Avx512);

/// Eight numbers in double precision. The value holds the token that proves AVX-512.
#[derive(Clone, Copy)]
pub(crate) struct F64x8(__m512d, Avx512);

impl F32Lanes<NODE_WIDTH> for F32x16 {
    lanewise!(sub, _mm512_sub_ps, other);
    lanewise!(mul, _mm512_mul_ps, other);
    lanewise!(mul_add, _mm512_fmadd_ps, factor, term);
    lanewise!(mul_sub, _mm512_fmsub_ps, factor, term);
    lanewise!(min, _mm512_min_ps, other);
    lanewise!(max, _mm512_max_ps, other);

    #[inline(always)]
    fn compress(self, mask: u32, to: &mut [f32; NODE_WIDTH]) {
        // SAFETY: the value holds the token; the array has 16 elements.
        unsafe { _mm512_storeu_ps(to.as_mut_ptr(), _mm512_maskz_compress_ps(mask as __mmask16, self.0)) }
    }

    #[inline(always)]
    fn mask_le(self, other: Self) -> u32 {
        // SAFETY: the value holds the token.
        u32::from(unsafe { _mm512_cmp_ps_mask::<_CMP_LE_OQ>(self.0, other.0) })
    }
}

impl F64Lanes for F64x8 {
    lanewise!(add, _mm512_add_pd, other);
    lanewise!(sub, _mm512_sub_pd, other);
    lanewise!(mul, _mm512_mul_pd, other);
    lanewise!(min, _mm512_min_pd, other);
    lanewise!(max, _mm512_max_pd, other);

    #[inline(always)]
    fn splat(self, number: f64) -> Self {
        // SAFETY: the value holds the token.
        Self(unsafe { _mm512_set1_pd(number) }, self.1)
    }

    #[inline(always)]
    fn mask_le(self, other: Self) -> u32 {
        // SAFETY: the value holds the token.
        u32::from(unsafe { _mm512_cmp_pd_mask::<_CMP_LE_OQ>(self.0, other.0) })
    }

    #[inline(always)]
    fn mask_lt(self, other: Self) -> u32 {
        // SAFETY: the value holds the token.
        u32::from(unsafe { _mm512_cmp_pd_mask::<_CMP_LT_OQ>(self.0, other.0) })
    }
}

impl F64Store for F64x8 {
    #[inline(always)]
    fn store(self, to: &mut [f64; LEAF_WIDTH]) {
        // SAFETY: the value holds the token; the array has 8 elements.
        unsafe { _mm512_storeu_pd(to.as_mut_ptr(), self.0) }
    }
}
