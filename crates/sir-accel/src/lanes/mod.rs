//! Numbers worked on several at a time.
//!
//! The searches of this crate are written once, for any [`Kit`]; the compiler makes a copy of them for each. All kits lead to
//! the same hits, bit for bit: boxes, in single precision, are only sorted out, with a margin for rounding; and triangles
//! are crossed with the basic operations of double precision, which are rounded alike everywhere.

#[cfg(target_arch = "x86_64")]
pub(crate) mod avx2;
#[cfg(target_arch = "x86_64")]
pub(crate) mod avx512;
pub(crate) mod portable;

#[cfg(target_arch = "x86_64")]
pub(crate) use avx2::Avx2;

/// Boxes of a node.
pub(crate) const BOXES: usize = 16;

/// Triangles of a leaf at most.
pub(crate) const TRIANGLES: usize = 8;

/// What a processor can do.
pub(crate) trait Kit: Copy {
    /// One number per box of a node.
    type Boxes: Singles<BOXES>;
    /// One number per triangle of a leaf.
    type Triangles: Singles<TRIANGLES>;
    /// One number per crossing.
    type Crossings: Doubles + Packed;

    /// Which numbers have their highest bit set, as a mask.
    fn highest_bits(numbers: &[u32; BOXES]) -> u32;

    /// Writes the numbers whose bits are set in the mask to the front of `to`, in order, and anything behind them.
    fn compress(numbers: &[u32; BOXES], mask: u32, to: &mut [u32; BOXES]);

    /// Writes the numbers of the bits that are set in the mask, each plus `first`, to the front of `to`, in order, and anything
    /// behind them.
    fn numbers(first: u32, mask: u32, to: &mut [u32; TRIANGLES]);

    /// Writes the numbers whose bits are set in the mask to the front of `to`, by falling keys, and anything behind them;
    /// and their keys alike, which may be made smaller by two millionths. No key may be negative.
    fn sort(
        keys: Self::Boxes,
        numbers: &[u32; BOXES],
        mask: u32,
        keys_to: &mut [f32; BOXES],
        to: &mut [u32; BOXES],
    );

    /// Does some work in a function of its own, so that its numbers find room in the registers.
    fn apart<R>(work: impl FnOnce() -> R) -> R;

    /// Begins to bring memory to the caches: a hint, that is harmless wherever it points.
    fn prefetch(start: *const u8, bytes: usize);
}

/// `N` numbers in single precision. Comparisons with what is not a number are false.
pub(crate) trait Singles<const N: usize>: Copy {
    /// Reads one number per lane.
    fn load(numbers: &[f32; N]) -> Self;
    /// The same number in all lanes.
    fn splat(number: f32) -> Self;
    /// Writes the numbers whose bits are set in the mask to the front of `to`, in order, and anything behind them.
    fn compress(self, mask: u32, to: &mut [f32; N]);
    /// `self − other`.
    fn minus(self, other: Self) -> Self;
    /// `self · other`.
    fn times(self, other: Self) -> Self;
    /// `self · factor + term`, rounded once or twice.
    fn times_plus(self, factor: Self, term: Self) -> Self;
    /// `self · factor − term`, rounded once or twice.
    fn times_minus(self, factor: Self, term: Self) -> Self;
    /// The smaller number of each lane; any of them if they are not ordered.
    fn min(self, other: Self) -> Self;
    /// The larger number of each lane; any of them if they are not ordered.
    fn max(self, other: Self) -> Self;
    /// Lanes where `self ≤ other`, as a mask.
    fn at_most(self, other: Self) -> u32;
}

/// One or more numbers in double precision, with the operations that are rounded alike everywhere.
pub(crate) trait Doubles: Copy {
    /// The same number in all lanes.
    fn splat(number: f64) -> Self;
    /// `self + other`.
    fn plus(self, other: Self) -> Self;
    /// `self − other`.
    fn minus(self, other: Self) -> Self;
    /// `self · other`.
    fn times(self, other: Self) -> Self;
    /// The smaller number of each lane.
    fn min(self, other: Self) -> Self;
    /// The larger number of each lane.
    fn max(self, other: Self) -> Self;
    /// Lanes where `self ≤ other`, as a mask.
    fn at_most(self, other: Self) -> u32;
    /// Lanes where `self < other`, as a mask.
    fn below(self, other: Self) -> u32;
}

/// Eight numbers.
pub(crate) trait Packed: Copy {
    /// Reads one number per lane.
    fn load(numbers: &[f64; TRIANGLES]) -> Self;
    /// Converts one number per lane.
    fn of_integers(numbers: &[i32; TRIANGLES]) -> Self;
    /// Converts one number per lane.
    fn of_singles(numbers: &[f32; TRIANGLES]) -> Self;
    /// Writes one number per lane.
    fn store(self, to: &mut [f64; TRIANGLES]);
}

impl Doubles for f64 {
    #[inline(always)]
    fn splat(number: f64) -> Self {
        number
    }

    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        self + other
    }

    #[inline(always)]
    fn minus(self, other: Self) -> Self {
        self - other
    }

    #[inline(always)]
    fn times(self, other: Self) -> Self {
        self * other
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        if self < other { self } else { other }
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        if self > other { self } else { other }
    }

    #[inline(always)]
    fn at_most(self, other: Self) -> u32 {
        u32::from(self <= other)
    }

    #[inline(always)]
    fn below(self, other: Self) -> u32 {
        u32::from(self < other)
    }
}

/// Begins to bring memory to the caches.
#[inline(always)]
pub(crate) fn prefetch(start: *const u8, bytes: usize) {
    // All 64-bit processors of this family have the instruction.
    #[cfg(target_arch = "x86_64")]
    Avx2::prefetch(start, bytes);
    #[cfg(not(target_arch = "x86_64"))]
    Portable::prefetch(start, bytes);
}

/// Sorts as [`Kit::sort`] does, number by number.
#[inline(always)]
fn sort_by_insertion(
    keys: &[f32; BOXES],
    numbers: &[u32; BOXES],
    mask: u32,
    keys_to: &mut [f32; BOXES],
    to: &mut [u32; BOXES],
) {
    let (mut mask, mut count) = (mask, 0);
    while mask != 0 && count < BOXES {
        let lane = mask.trailing_zeros() as usize % BOXES;
        mask &= mask - 1;
        let key = keys[lane];
        let mut i = count;
        while i > 0 && keys_to[i - 1] < key {
            (keys_to[i], to[i]) = (keys_to[i - 1], to[i - 1]);
            i -= 1;
        }
        (keys_to[i], to[i]) = (key, numbers[lane]);
        count += 1;
    }
}
