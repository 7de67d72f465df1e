//! AVX2 and FMA: 8 numbers in single precision, or 4 in double precision, at a time.
#![allow(unsafe_code, reason = "vector instructions; this kit is used only where the processor has them")]

use std::arch::x86_64::*;

use crate::lanes::{BOXES, Doubles, Kit, Packed, Singles, TRIANGLES, sort_by_insertion};

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
        // SAFETY: the processor has AVX2; the array has twice 8 numbers.
        unsafe {
            let low = _mm256_loadu_si256(numbers.as_ptr().cast());
            let high = _mm256_loadu_si256(numbers.as_ptr().add(8).cast());
            compress16([low, high], mask, to);
        }
    }

    #[inline(always)]
    fn numbers(first: u32, mask: u32, to: &mut [u32; TRIANGLES]) {
        // SAFETY: the processor has AVX2; the array has 8 places.
        unsafe {
            let numbers = _mm256_add_epi32(lanes(), _mm256_set1_epi32(first as i32));
            _mm256_storeu_si256(to.as_mut_ptr().cast(), compress8(numbers, mask & 0xFF));
        }
    }

    #[inline(always)]
    fn sort(
        keys: Float8x2,
        numbers: &[u32; BOXES],
        mask: u32,
        keys_to: &mut [f32; BOXES],
        to: &mut [u32; BOXES],
    ) {
        let count = mask.count_ones();
        if count > 8 {
            let mut all = [0.0; BOXES];
            // SAFETY: the processor has AVX2; the array has twice 8 places.
            unsafe {
                _mm256_storeu_ps(all.as_mut_ptr(), keys.0);
                _mm256_storeu_ps(all.as_mut_ptr().add(8), keys.1);
            }
            return sort_by_insertion(&all, numbers, mask, keys_to, to);
        }
        // SAFETY: the processor has AVX2; the arrays have twice 8 numbers.
        unsafe {
            // As in the kit for AVX-512: the lane replaces the last bits of its key.
            let exact = _mm256_set1_epi32(!(BOXES as i32 - 1));
            let with_lane = |keys: __m256, first: i32| {
                let lanes = _mm256_add_epi32(lanes(), _mm256_set1_epi32(first));
                _mm256_or_si256(_mm256_and_si256(_mm256_castps_si256(keys), exact), lanes)
            };
            let mut front = [0; BOXES];
            compress16([with_lane(keys.0, 0), with_lane(keys.1, 8)], mask, &mut front);
            // Unused places become zero and end up last.
            let used = _mm256_cmpgt_epi32(_mm256_set1_epi32(count as i32), lanes());
            let keys = _mm256_and_si256(_mm256_loadu_si256(front.as_ptr().cast()), used);
            let keys = if count > 4 { sort8(keys) } else { sort4(keys) };
            let half = |start: usize| {
                let half = _mm256_loadu_si256(numbers.as_ptr().add(start).cast());
                _mm256_castsi256_ps(_mm256_permutevar8x32_epi32(half, keys))
            };
            // The fourth bit of the lane tells the half.
            let second = _mm256_castsi256_ps(_mm256_slli_epi32::<28>(keys));
            _mm256_storeu_ps(to.as_mut_ptr().cast(), _mm256_blendv_ps(half(0), half(8), second));
            _mm256_storeu_si256(keys_to.as_mut_ptr().cast(), _mm256_and_si256(keys, exact));
        }
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

/// A step of a sorting network: lanes exchange their numbers with the lanes of the order, and those in the mask keep the
/// smaller one, the others the larger one.
#[inline(always)]
unsafe fn exchange<const SMALLER: i32>(numbers: __m256i, order: [i32; 8]) -> __m256i {
    let [a, b, c, d, e, f, g, h] = order;
    // SAFETY: the caller sees to it that the processor has AVX2.
    unsafe {
        let other = _mm256_permutevar8x32_epi32(numbers, _mm256_setr_epi32(a, b, c, d, e, f, g, h));
        _mm256_blend_epi32::<SMALLER>(_mm256_max_epu32(numbers, other), _mm256_min_epu32(numbers, other))
    }
}

/// Sorts the first four numbers, largest first.
#[inline(always)]
pub(crate) unsafe fn sort4(numbers: __m256i) -> __m256i {
    // SAFETY: the caller sees to it that the processor has AVX2.
    unsafe {
        let numbers = exchange::<0b1100>(numbers, [2, 3, 0, 1, 4, 5, 6, 7]);
        let numbers = exchange::<0b1010>(numbers, [1, 0, 3, 2, 4, 5, 6, 7]);
        exchange::<0b0100>(numbers, [0, 2, 1, 3, 4, 5, 6, 7])
    }
}

/// Sorts eight numbers, largest first (Batcher's odd-even merge sort).
#[inline(always)]
pub(crate) unsafe fn sort8(numbers: __m256i) -> __m256i {
    // SAFETY: the caller sees to it that the processor has AVX2.
    unsafe {
        let numbers = exchange::<0b1010_1010>(numbers, [1, 0, 3, 2, 5, 4, 7, 6]);
        let numbers = exchange::<0b1100_1100>(numbers, [2, 3, 0, 1, 6, 7, 4, 5]);
        let numbers = exchange::<0b0100_0100>(numbers, [0, 2, 1, 3, 4, 6, 5, 7]);
        let numbers = exchange::<0b1111_0000>(numbers, [4, 5, 6, 7, 0, 1, 2, 3]);
        let numbers = exchange::<0b0011_0000>(numbers, [0, 1, 4, 5, 2, 3, 6, 7]);
        exchange::<0b0101_0100>(numbers, [0, 2, 1, 4, 3, 6, 5, 7])
    }
}

/// Numbers of the lanes.
#[inline(always)]
unsafe fn lanes() -> __m256i {
    // SAFETY: the caller sees to it that the processor has AVX2.
    unsafe { _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7) }
}

/// Brings the numbers whose bits are set in the mask, below 256, to the front.
#[inline(always)]
unsafe fn compress8(numbers: __m256i, mask: u32) -> __m256i {
    let order = &FRONTS[mask as usize & 0xFF];
    // SAFETY: the caller sees to it that the processor has AVX2; the array has 8 numbers.
    unsafe {
        let order = _mm256_cvtepu8_epi32(_mm_loadl_epi64(order.as_ptr().cast()));
        _mm256_permutevar8x32_epi32(numbers, order)
    }
}

/// Writes the numbers of two halves whose bits are set in the mask to the front.
#[inline(always)]
unsafe fn compress16(halves: [__m256i; 2], mask: u32, to: &mut [u32; BOXES]) {
    let (low, high) = (mask & 0xFF, mask >> 8 & 0xFF);
    // SAFETY: the caller sees to it that the processor has AVX2; the second half begins after 8 places at most.
    unsafe {
        let second = to.as_mut_ptr().add(low.count_ones() as usize);
        _mm256_storeu_si256(to.as_mut_ptr().cast(), compress8(halves[0], low));
        _mm256_storeu_si256(second.cast(), compress8(halves[1], high));
    }
}

/// For each mask of eight lanes: those whose bits are set.
static FRONTS: [[u8; 8]; 256] = {
    let mut fronts = [[0; 8]; 256];
    let mut mask = 0;
    while mask < 256 {
        let (mut lane, mut count) = (0, 0);
        while lane < 8 {
            if mask >> lane & 1 == 1 {
                fronts[mask][count] = lane as u8;
                count += 1;
            }
            lane += 1;
        }
        mask += 1;
    }
    fronts
};

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
        unsafe {
            let front = compress8(_mm256_castps_si256(self.0), mask & 0xFF);
            _mm256_storeu_si256(to.as_mut_ptr().cast(), front);
        }
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
        let mut bits = [0; BOXES];
        // SAFETY: as above.
        unsafe { compress16([_mm256_castps_si256(self.0), _mm256_castps_si256(self.1)], mask, &mut bits) }
        *to = bits.map(f32::from_bits);
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
