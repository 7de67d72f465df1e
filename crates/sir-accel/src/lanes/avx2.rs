//! AVX2 and FMA: 8 numbers in single precision, or 4 in double precision, at a time.
#![allow(unsafe_code, reason = "vector instructions; this kit is used only where the processor has them")]

use std::arch::x86_64::*;

use super::{BOXES, Doubles, Kit, Packed, Singles, TRIANGLES, sort_by_insertion};

#[derive(Clone, Copy, Debug)]
pub(crate) struct Avx2;

impl Kit for Avx2 {
    type Boxes = Float8x2;
    type Triangles = Float8;
    type Crossings = Double4x2;

    #[inline(always)]
    fn highest_bits(numbers: &[u32; BOXES]) -> u32 {
        // SAFETY: the processor has AVX2; the array has twice 8 numbers.
        unsafe {
            let low = _mm256_movemask_ps(_mm256_loadu_ps(numbers.as_ptr().cast())) as u32;
            let high = _mm256_movemask_ps(_mm256_loadu_ps(numbers.as_ptr().add(8).cast())) as u32;
            low | high << 8
        }
    }

    #[inline(always)]
    fn compress(numbers: &[u32; BOXES], mask: u32, to: &mut [u32; BOXES]) {
        super::Portable::compress(numbers, mask, to);
    }

    #[inline(always)]
    fn numbers(first: u32, mask: u32, to: &mut [u32; TRIANGLES]) {
        super::Portable::numbers(first, mask, to);
    }

    #[inline(always)]
    fn sort(
        keys: Float8x2,
        numbers: &[u32; BOXES],
        mask: u32,
        keys_to: &mut [f32; BOXES],
        to: &mut [u32; BOXES],
    ) {
        let mut all = [0.0; BOXES];
        // SAFETY: the processor has AVX2; the array has twice 8 places.
        unsafe {
            _mm256_storeu_ps(all.as_mut_ptr(), keys.0);
            _mm256_storeu_ps(all.as_mut_ptr().add(8), keys.1);
        }
        sort_by_insertion(&all, numbers, mask, keys_to, to);
    }

    #[inline(always)]
    fn apart<R>(work: impl FnOnce() -> R) -> R {
        #[inline(never)]
        #[target_feature(enable = "avx2,fma,bmi1,bmi2,popcnt")]
        fn apart<R>(work: impl FnOnce() -> R) -> R {
            work()
        }
        // SAFETY: the processor has AVX2 and what comes with it.
        unsafe { apart(work) }
    }

    #[inline(always)]
    fn prefetch(start: *const u8, bytes: usize) {
        const LINE: usize = 64;
        for offset in (0..bytes).step_by(LINE) {
            // SAFETY: a hint, that reads nothing.
            unsafe { _mm_prefetch::<_MM_HINT_T0>(start.wrapping_add(offset).cast()) }
        }
    }
}

/// Eight numbers in single precision.
#[derive(Clone, Copy)]
pub(crate) struct Float8(__m256);

impl Singles<TRIANGLES> for Float8 {
    #[inline(always)]
    fn load(numbers: &[f32; TRIANGLES]) -> Self {
        // SAFETY: the processor has AVX2 and FMA, here and below; the array has 8 numbers.
        Self(unsafe { _mm256_loadu_ps(numbers.as_ptr()) })
    }

    #[inline(always)]
    fn splat(number: f32) -> Self {
        // SAFETY: as above.
        Self(unsafe { _mm256_set1_ps(number) })
    }

    #[inline(always)]
    fn compress(self, mask: u32, to: &mut [f32; TRIANGLES]) {
        // SAFETY: as above; the array has 8 places.
        let mut all = [0.0; TRIANGLES];
        unsafe { _mm256_storeu_ps(all.as_mut_ptr(), self.0) }
        all.compress(mask, to);
    }

    #[inline(always)]
    fn minus(self, other: Self) -> Self {
        // SAFETY: as above.
        Self(unsafe { _mm256_sub_ps(self.0, other.0) })
    }

    #[inline(always)]
    fn times(self, other: Self) -> Self {
        // SAFETY: as above.
        Self(unsafe { _mm256_mul_ps(self.0, other.0) })
    }

    #[inline(always)]
    fn times_plus(self, factor: Self, term: Self) -> Self {
        // SAFETY: as above.
        Self(unsafe { _mm256_fmadd_ps(self.0, factor.0, term.0) })
    }

    #[inline(always)]
    fn times_minus(self, factor: Self, term: Self) -> Self {
        // SAFETY: as above.
        Self(unsafe { _mm256_fmsub_ps(self.0, factor.0, term.0) })
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        // SAFETY: as above.
        Self(unsafe { _mm256_min_ps(self.0, other.0) })
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        // SAFETY: as above.
        Self(unsafe { _mm256_max_ps(self.0, other.0) })
    }

    #[inline(always)]
    fn at_most(self, other: Self) -> u32 {
        // SAFETY: as above.
        unsafe { _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(self.0, other.0)) as u32 }
    }
}

/// Twice eight numbers in single precision.
#[derive(Clone, Copy)]
pub(crate) struct Float8x2(__m256, __m256);

impl Singles<BOXES> for Float8x2 {
    #[inline(always)]
    fn load(numbers: &[f32; BOXES]) -> Self {
        // SAFETY: as above; the array has twice 8 numbers.
        unsafe { Self(_mm256_loadu_ps(numbers.as_ptr()), _mm256_loadu_ps(numbers.as_ptr().add(8))) }
    }

    #[inline(always)]
    fn splat(number: f32) -> Self {
        // SAFETY: as above.
        unsafe { Self(_mm256_set1_ps(number), _mm256_set1_ps(number)) }
    }

    #[inline(always)]
    fn compress(self, mask: u32, to: &mut [f32; BOXES]) {
        // SAFETY: as above; the array has twice 8 places.
        let mut all = [0.0; BOXES];
        unsafe {
            _mm256_storeu_ps(all.as_mut_ptr(), self.0);
            _mm256_storeu_ps(all.as_mut_ptr().add(8), self.1);
        }
        all.compress(mask, to);
    }

    #[inline(always)]
    fn minus(self, other: Self) -> Self {
        // SAFETY: as above.
        unsafe { Self(_mm256_sub_ps(self.0, other.0), _mm256_sub_ps(self.1, other.1)) }
    }

    #[inline(always)]
    fn times(self, other: Self) -> Self {
        // SAFETY: as above.
        unsafe { Self(_mm256_mul_ps(self.0, other.0), _mm256_mul_ps(self.1, other.1)) }
    }

    #[inline(always)]
    fn times_plus(self, factor: Self, term: Self) -> Self {
        // SAFETY: as above.
        unsafe { Self(_mm256_fmadd_ps(self.0, factor.0, term.0), _mm256_fmadd_ps(self.1, factor.1, term.1)) }
    }

    #[inline(always)]
    fn times_minus(self, factor: Self, term: Self) -> Self {
        // SAFETY: as above.
        unsafe { Self(_mm256_fmsub_ps(self.0, factor.0, term.0), _mm256_fmsub_ps(self.1, factor.1, term.1)) }
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        // SAFETY: as above.
        unsafe { Self(_mm256_min_ps(self.0, other.0), _mm256_min_ps(self.1, other.1)) }
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        // SAFETY: as above.
        unsafe { Self(_mm256_max_ps(self.0, other.0), _mm256_max_ps(self.1, other.1)) }
    }

    #[inline(always)]
    fn at_most(self, other: Self) -> u32 {
        // SAFETY: as above.
        unsafe {
            let low = _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(self.0, other.0)) as u32;
            let high = _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(self.1, other.1)) as u32;
            low | high << 8
        }
    }
}

/// Twice four numbers in double precision.
#[derive(Clone, Copy)]
pub(crate) struct Double4x2(__m256d, __m256d);

impl Doubles for Double4x2 {
    #[inline(always)]
    fn splat(number: f64) -> Self {
        // SAFETY: as above.
        unsafe { Self(_mm256_set1_pd(number), _mm256_set1_pd(number)) }
    }

    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        // SAFETY: as above.
        unsafe { Self(_mm256_add_pd(self.0, other.0), _mm256_add_pd(self.1, other.1)) }
    }

    #[inline(always)]
    fn minus(self, other: Self) -> Self {
        // SAFETY: as above.
        unsafe { Self(_mm256_sub_pd(self.0, other.0), _mm256_sub_pd(self.1, other.1)) }
    }

    #[inline(always)]
    fn times(self, other: Self) -> Self {
        // SAFETY: as above.
        unsafe { Self(_mm256_mul_pd(self.0, other.0), _mm256_mul_pd(self.1, other.1)) }
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        // SAFETY: as above.
        unsafe { Self(_mm256_min_pd(self.0, other.0), _mm256_min_pd(self.1, other.1)) }
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        // SAFETY: as above.
        unsafe { Self(_mm256_max_pd(self.0, other.0), _mm256_max_pd(self.1, other.1)) }
    }

    #[inline(always)]
    fn at_most(self, other: Self) -> u32 {
        // SAFETY: as above.
        unsafe {
            let low = _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_LE_OQ>(self.0, other.0)) as u32;
            let high = _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_LE_OQ>(self.1, other.1)) as u32;
            low | high << 4
        }
    }

    #[inline(always)]
    fn below(self, other: Self) -> u32 {
        // SAFETY: as above.
        unsafe {
            let low = _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_LT_OQ>(self.0, other.0)) as u32;
            let high = _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_LT_OQ>(self.1, other.1)) as u32;
            low | high << 4
        }
    }
}

impl Packed for Double4x2 {
    #[inline(always)]
    fn load(numbers: &[f64; TRIANGLES]) -> Self {
        // SAFETY: as above; the array has twice 4 numbers.
        unsafe { Self(_mm256_loadu_pd(numbers.as_ptr()), _mm256_loadu_pd(numbers.as_ptr().add(4))) }
    }

    #[inline(always)]
    fn of_integers(numbers: &[i32; TRIANGLES]) -> Self {
        // SAFETY: as above; the array has twice 4 numbers.
        unsafe {
            let low = _mm_loadu_si128(numbers.as_ptr().cast());
            let high = _mm_loadu_si128(numbers.as_ptr().add(4).cast());
            Self(_mm256_cvtepi32_pd(low), _mm256_cvtepi32_pd(high))
        }
    }

    #[inline(always)]
    fn of_singles(numbers: &[f32; TRIANGLES]) -> Self {
        // SAFETY: as above; the array has twice 4 numbers.
        unsafe {
            let (low, high) = (_mm_loadu_ps(numbers.as_ptr()), _mm_loadu_ps(numbers.as_ptr().add(4)));
            Self(_mm256_cvtps_pd(low), _mm256_cvtps_pd(high))
        }
    }

    #[inline(always)]
    fn store(self, to: &mut [f64; TRIANGLES]) {
        // SAFETY: as above; the array has twice 4 places.
        unsafe {
            _mm256_storeu_pd(to.as_mut_ptr(), self.0);
            _mm256_storeu_pd(to.as_mut_ptr().add(4), self.1);
        }
    }
}
