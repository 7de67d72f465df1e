//! Vectors of integers: sorting networks, and compression of lanes to the front.
#![allow(unsafe_code, reason = "vector instructions; each function takes the token that proves them")]

use std::arch::x86_64::*;

use crate::simd::avx2::token::Avx2;
use crate::simd::backend::NODE_WIDTH;

/// Performs a step of a sorting network: compares each lane with the lane that `order` names for it. Lanes in the mask
/// `SMALLER` keep the smaller number, the others the larger one.
#[inline(always)]
fn exchange<const SMALLER: i32>(_: Avx2, numbers: __m256i, order: [i32; 8]) -> __m256i {
    let [a, b, c, d, e, f, g, h] = order;
    // SAFETY: the token proves AVX2.
    unsafe {
        let other = _mm256_permutevar8x32_epi32(numbers, _mm256_setr_epi32(a, b, c, d, e, f, g, h));
        _mm256_blend_epi32::<SMALLER>(_mm256_max_epu32(numbers, other), _mm256_min_epu32(numbers, other))
    }
}

/// Sorts the first four numbers, largest first.
#[inline(always)]
pub(crate) fn sort4(token: Avx2, numbers: __m256i) -> __m256i {
    let numbers = exchange::<0b1100>(token, numbers, [2, 3, 0, 1, 4, 5, 6, 7]);
    let numbers = exchange::<0b1010>(token, numbers, [1, 0, 3, 2, 4, 5, 6, 7]);
    exchange::<0b0100>(token, numbers, [0, 2, 1, 3, 4, 5, 6, 7])
}

/// Sorts eight numbers, largest first (odd-even merge sort, Batcher 1968).
#[inline(always)]
pub(crate) fn sort8(token: Avx2, numbers: __m256i) -> __m256i {
    let numbers = exchange::<0b1010_1010>(token, numbers, [1, 0, 3, 2, 5, 4, 7, 6]);
    let numbers = exchange::<0b1100_1100>(token, numbers, [2, 3, 0, 1, 6, 7, 4, 5]);
    let numbers = exchange::<0b0100_0100>(token, numbers, [0, 2, 1, 3, 4, 6, 5, 7]);
    let numbers = exchange::<0b1111_0000>(token, numbers, [4, 5, 6, 7, 0, 1, 2, 3]);
    let numbers = exchange::<0b0011_0000>(token, numbers, [0, 1, 4, 5, 2, 3, 6, 7]);
    exchange::<0b0101_0100>(token, numbers, [0, 2, 1, 4, 3, 6, 5, 7])
}

/// Returns the lane numbers.
#[inline(always)]
pub(crate) fn lane_numbers(_: Avx2) -> __m256i {
    // SAFETY: the token proves AVX2.
    unsafe { _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7) }
}

/// Moves the numbers in the mask to the front; only the lowest eight bits of the mask are used.
#[inline(always)]
pub(crate) fn compress8(_: Avx2, numbers: __m256i, mask: u32) -> __m256i {
    let order = &FRONTS[mask as usize & 0xFF];
    // SAFETY: the token proves AVX2; the array has the 8 bytes that are read.
    unsafe {
        let order = _mm256_cvtepu8_epi32(_mm_loadl_epi64(order.as_ptr().cast()));
        _mm256_permutevar8x32_epi32(numbers, order)
    }
}

/// Writes the numbers of two halves that are in the mask to the front of `to`.
#[inline(always)]
pub(crate) fn compress16(token: Avx2, halves: [__m256i; 2], mask: u32, to: &mut [u32; NODE_WIDTH]) {
    let (low, high) = (mask & 0xFF, mask >> 8 & 0xFF);
    // SAFETY: the token proves AVX2; `to` has 16 elements, and the second half begins after at most 8 of them.
    unsafe {
        let second = to.as_mut_ptr().add(low.count_ones() as usize);
        _mm256_storeu_si256(to.as_mut_ptr().cast(), compress8(token, halves[0], low));
        _mm256_storeu_si256(second.cast(), compress8(token, halves[1], high));
    }
}

/// Lanes in each mask of eight lanes.
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
