//! AVX-512: 16 numbers in single precision, or 8 in double precision, at a time.
#![allow(unsafe_code, reason = "vector instructions; this kit is used only where the processor has them")]

use std::arch::x86_64::*;

use crate::lanes::avx2::{Float8, sort4, sort8};
use crate::lanes::{BOXES, Doubles, Kit, Packed, Singles, TRIANGLES, sort_by_insertion};

#[derive(Clone, Copy, Debug)]
pub(crate) struct Avx512;

impl Kit for Avx512 {
    type Boxes = Float16;
    type Triangles = Float8;
    type Crossings = Double8;

    #[inline(always)]
    fn highest_bits(numbers: &[u32; BOXES]) -> u32 {
        // SAFETY: the processor has AVX-512; the array has 16 numbers.
        unsafe { u32::from(_mm512_movepi32_mask(_mm512_loadu_si512(numbers.as_ptr().cast()))) }
    }

    #[inline(always)]
    fn compress(numbers: &[u32; BOXES], mask: u32, to: &mut [u32; BOXES]) {
        // To a register and from there to memory: straight to memory is slow on some processors (Zen 4).
        // SAFETY: the processor has AVX-512; the arrays have 16 numbers.
        unsafe {
            let numbers = _mm512_loadu_si512(numbers.as_ptr().cast());
            let front = _mm512_maskz_compress_epi32(mask as __mmask16, numbers);
            _mm512_storeu_si512(to.as_mut_ptr().cast(), front);
        }
    }

    #[inline(always)]
    fn numbers(first: u32, mask: u32, to: &mut [u32; TRIANGLES]) {
        // SAFETY: the processor has AVX-512; the array has 8 places.
        unsafe {
            let lanes = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
            let numbers = _mm256_add_epi32(lanes, _mm256_set1_epi32(first as i32));
            let front = _mm256_maskz_compress_epi32(mask as __mmask8, numbers);
            _mm256_storeu_si256(to.as_mut_ptr().cast(), front);
        }
    }

    #[inline(always)]
    fn sort(
        keys: Float16,
        numbers: &[u32; BOXES],
        mask: u32,
        keys_to: &mut [f32; BOXES],
        to: &mut [u32; BOXES],
    ) {
        if mask.count_ones() > 8 {
            let mut all = [0.0; BOXES];
            // SAFETY: the processor has AVX-512; the array has 16 places.
            unsafe { _mm512_storeu_ps(all.as_mut_ptr(), keys.0) }
            return sort_by_insertion(&all, numbers, mask, keys_to, to);
        }
        // SAFETY: the processor has AVX-512; the arrays have 16 numbers.
        unsafe {
            // The lane replaces the last bits of its key. Keys are not negative, so they are ordered as integers are.
            let lanes = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
            let exact = _mm512_set1_epi32(!(BOXES as i32 - 1));
            let keys = _mm512_ternarylogic_epi32::<0xF8>(lanes, _mm512_castps_si512(keys.0), exact);
            // Unused places are zero and end up last.
            let keys = _mm512_castsi512_si256(_mm512_maskz_compress_epi32(mask as __mmask16, keys));
            let keys = if mask.count_ones() > 4 { sort8(keys) } else { sort4(keys) };
            let numbers = _mm512_loadu_si512(numbers.as_ptr().cast());
            let sorted = _mm512_permutexvar_epi32(_mm512_castsi256_si512(keys), numbers);
            let keys = _mm256_and_si256(keys, _mm512_castsi512_si256(exact));
            _mm256_storeu_si256(keys_to.as_mut_ptr().cast(), keys);
            _mm256_storeu_si256(to.as_mut_ptr().cast(), _mm512_castsi512_si256(sorted));
        }
    }

    #[inline(always)]
    fn apart<R>(work: impl FnOnce() -> R) -> R {
        #[inline(never)]
        #[target_feature(enable = "avx512f,avx512dq,avx512vl,avx2,fma,bmi1,bmi2,popcnt")]
        fn apart<R>(work: impl FnOnce() -> R) -> R {
            work()
        }
        // SAFETY: the processor has AVX-512 and what comes with it.
        unsafe { apart(work) }
    }

    #[inline(always)]
    fn prefetch(start: *const u8, bytes: usize) {
        super::Avx2::prefetch(start, bytes);
    }
}

/// Sixteen numbers in single precision.
#[derive(Clone, Copy)]
pub(crate) struct Float16(__m512);

impl Singles<BOXES> for Float16 {
    #[inline(always)]
    fn load(numbers: &[f32; BOXES]) -> Self {
        // SAFETY: the processor has AVX-512, here and below; the array has 16 numbers.
        Self(unsafe { _mm512_loadu_ps(numbers.as_ptr()) })
    }

    #[inline(always)]
    fn splat(number: f32) -> Self {
        // SAFETY: as above.
        Self(unsafe { _mm512_set1_ps(number) })
    }

    #[inline(always)]
    fn compress(self, mask: u32, to: &mut [f32; BOXES]) {
        // SAFETY: as above; the array has 16 places.
        unsafe { _mm512_storeu_ps(to.as_mut_ptr(), _mm512_maskz_compress_ps(mask as __mmask16, self.0)) }
    }

    #[inline(always)]
    fn minus(self, other: Self) -> Self {
        // SAFETY: as above.
        Self(unsafe { _mm512_sub_ps(self.0, other.0) })
    }

    #[inline(always)]
    fn times(self, other: Self) -> Self {
        // SAFETY: as above.
        Self(unsafe { _mm512_mul_ps(self.0, other.0) })
    }

    #[inline(always)]
    fn times_plus(self, factor: Self, term: Self) -> Self {
        // SAFETY: as above.
        Self(unsafe { _mm512_fmadd_ps(self.0, factor.0, term.0) })
    }

    #[inline(always)]
    fn times_minus(self, factor: Self, term: Self) -> Self {
        // SAFETY: as above.
        Self(unsafe { _mm512_fmsub_ps(self.0, factor.0, term.0) })
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        // SAFETY: as above.
        Self(unsafe { _mm512_min_ps(self.0, other.0) })
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        // SAFETY: as above.
        Self(unsafe { _mm512_max_ps(self.0, other.0) })
    }

    #[inline(always)]
    fn at_most(self, other: Self) -> u32 {
        // SAFETY: as above.
        u32::from(unsafe { _mm512_cmp_ps_mask::<_CMP_LE_OQ>(self.0, other.0) })
    }
}

/// Eight numbers in double precision.
#[derive(Clone, Copy)]
pub(crate) struct Double8(__m512d);

impl Doubles for Double8 {
    #[inline(always)]
    fn splat(number: f64) -> Self {
        // SAFETY: as above.
        Self(unsafe { _mm512_set1_pd(number) })
    }

    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        // SAFETY: as above.
        Self(unsafe { _mm512_add_pd(self.0, other.0) })
    }

    #[inline(always)]
    fn minus(self, other: Self) -> Self {
        // SAFETY: as above.
        Self(unsafe { _mm512_sub_pd(self.0, other.0) })
    }

    #[inline(always)]
    fn times(self, other: Self) -> Self {
        // SAFETY: as above.
        Self(unsafe { _mm512_mul_pd(self.0, other.0) })
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        // SAFETY: as above.
        Self(unsafe { _mm512_min_pd(self.0, other.0) })
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        // SAFETY: as above.
        Self(unsafe { _mm512_max_pd(self.0, other.0) })
    }

    #[inline(always)]
    fn at_most(self, other: Self) -> u32 {
        // SAFETY: as above.
        u32::from(unsafe { _mm512_cmp_pd_mask::<_CMP_LE_OQ>(self.0, other.0) })
    }

    #[inline(always)]
    fn below(self, other: Self) -> u32 {
        // SAFETY: as above.
        u32::from(unsafe { _mm512_cmp_pd_mask::<_CMP_LT_OQ>(self.0, other.0) })
    }
}

impl Packed for Double8 {
    #[inline(always)]
    fn load(numbers: &[f64; TRIANGLES]) -> Self {
        // SAFETY: as above; the array has 8 numbers.
        Self(unsafe { _mm512_loadu_pd(numbers.as_ptr()) })
    }

    #[inline(always)]
    fn of_integers(numbers: &[i32; TRIANGLES]) -> Self {
        // SAFETY: as above; the array has 8 numbers.
        Self(unsafe { _mm512_cvtepi32_pd(_mm256_loadu_si256(numbers.as_ptr().cast())) })
    }

    #[inline(always)]
    fn of_singles(numbers: &[f32; TRIANGLES]) -> Self {
        // SAFETY: as above; the array has 8 numbers.
        Self(unsafe { _mm512_cvtps_pd(_mm256_loadu_ps(numbers.as_ptr())) })
    }

    #[inline(always)]
    fn store(self, to: &mut [f64; TRIANGLES]) {
        // SAFETY: as above; the array has 8 places.
        unsafe { _mm512_storeu_pd(to.as_mut_ptr(), self.0) }
    }
}
