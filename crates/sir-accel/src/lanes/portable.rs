//! Arrays, for any processor.

use crate::lanes::{BOXES, Doubles, Kit, Packed, Singles, TRIANGLES, sort_by_insertion};

#[derive(Clone, Copy, Debug)]
pub(crate) struct Portable;

impl Kit for Portable {
    type Boxes = [f32; BOXES];
    type Triangles = [f32; TRIANGLES];
    type Crossings = [f64; TRIANGLES];

    #[inline(always)]
    fn highest_bits(numbers: &[u32; BOXES]) -> u32 {
        numbers.iter().enumerate().fold(0, |mask, (lane, number)| mask | (number >> 31) << lane)
    }

    #[inline(always)]
    fn compress(numbers: &[u32; BOXES], mask: u32, to: &mut [u32; BOXES]) {
        compress(numbers, mask, to);
    }

    #[inline(always)]
    fn numbers(first: u32, mask: u32, to: &mut [u32; TRIANGLES]) {
        compress(&std::array::from_fn(|lane| first + lane as u32), mask, to);
    }

    #[inline(always)]
    fn sort(
        keys: [f32; BOXES],
        numbers: &[u32; BOXES],
        mask: u32,
        keys_to: &mut [f32; BOXES],
        to: &mut [u32; BOXES],
    ) {
        sort_by_insertion(&keys, numbers, mask, keys_to, to);
    }

    #[inline(always)]
    fn apart<R>(work: impl FnOnce() -> R) -> R {
        work()
    }

    #[inline(always)]
    fn prefetch(_: *const u8, _: usize) {}
}

/// Writes what has its bit set in the mask to the front of `to`.
#[inline(always)]
fn compress<T: Copy, const N: usize>(from: &[T; N], mask: u32, to: &mut [T; N]) {
    let (mut mask, mut count) = (mask, 0);
    while mask != 0 && count < N {
        to[count] = from[mask.trailing_zeros() as usize % N];
        mask &= mask - 1;
        count += 1;
    }
}

impl<const N: usize> Singles<N> for [f32; N] {
    #[inline(always)]
    fn load(numbers: &[f32; N]) -> Self {
        *numbers
    }

    #[inline(always)]
    fn splat(number: f32) -> Self {
        [number; N]
    }

    #[inline(always)]
    fn compress(self, mask: u32, to: &mut [f32; N]) {
        compress(&self, mask, to);
    }

    #[inline(always)]
    fn minus(self, other: Self) -> Self {
        std::array::from_fn(|i| self[i] - other[i])
    }

    #[inline(always)]
    fn times(self, other: Self) -> Self {
        std::array::from_fn(|i| self[i] * other[i])
    }

    #[inline(always)]
    fn times_plus(self, factor: Self, term: Self) -> Self {
        std::array::from_fn(|i| self[i] * factor[i] + term[i])
    }

    #[inline(always)]
    fn times_minus(self, factor: Self, term: Self) -> Self {
        std::array::from_fn(|i| self[i] * factor[i] - term[i])
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        std::array::from_fn(|i| if self[i] < other[i] { self[i] } else { other[i] })
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        std::array::from_fn(|i| if self[i] > other[i] { self[i] } else { other[i] })
    }

    #[inline(always)]
    fn at_most(self, other: Self) -> u32 {
        (0..N).fold(0, |mask, i| mask | u32::from(self[i] <= other[i]) << i)
    }
}

impl Packed for [f64; TRIANGLES] {
    #[inline(always)]
    fn load(numbers: &[f64; TRIANGLES]) -> Self {
        *numbers
    }

    #[inline(always)]
    fn of_integers(numbers: &[i32; TRIANGLES]) -> Self {
        numbers.map(f64::from)
    }

    #[inline(always)]
    fn of_singles(numbers: &[f32; TRIANGLES]) -> Self {
        numbers.map(f64::from)
    }

    #[inline(always)]
    fn store(self, to: &mut [f64; TRIANGLES]) {
        *to = self;
    }
}

impl Doubles for [f64; TRIANGLES] {
    #[inline(always)]
    fn splat(number: f64) -> Self {
        [number; TRIANGLES]
    }

    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        std::array::from_fn(|i| self[i] + other[i])
    }

    #[inline(always)]
    fn minus(self, other: Self) -> Self {
        std::array::from_fn(|i| self[i] - other[i])
    }

    #[inline(always)]
    fn times(self, other: Self) -> Self {
        std::array::from_fn(|i| self[i] * other[i])
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        std::array::from_fn(|i| if self[i] < other[i] { self[i] } else { other[i] })
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        std::array::from_fn(|i| if self[i] > other[i] { self[i] } else { other[i] })
    }

    #[inline(always)]
    fn at_most(self, other: Self) -> u32 {
        (0..TRIANGLES).fold(0, |mask, i| mask | u32::from(self[i] <= other[i]) << i)
    }

    #[inline(always)]
    fn below(self, other: Self) -> u32 {
        (0..TRIANGLES).fold(0, |mask, i| mask | u32::from(self[i] < other[i]) << i)
    }
}
