//! The vector operations that the searches need.

/// Number of boxes of a node.
pub(crate) const NODE_WIDTH: usize = 16;

/// Largest number of triangles of a leaf, and number of pairs of a line and a triangle that are intersected together.
pub(crate) const LEAF_WIDTH: usize = 8;

/// SIMD backend: a set of vector instructions. A value of the type proves that the processor has them.
///
/// Masks have one bit per lane, the lowest for the first lane.
pub(crate) trait SimdBackend: Copy {
    /// One number in single precision per box of a node.
    type NodeF32: F32Lanes<NODE_WIDTH>;
    /// One number in single precision per triangle of a leaf.
    type LeafF32: F32Lanes<LEAF_WIDTH>;
    /// One number in double precision per pair of a line and a triangle.
    type PairF64: F64Lanes + F64Store;

    /// Runs a kernel, compiled for these instructions.
    fn run<K: Kernel>(self, kernel: K) -> K::Output;

    /// Runs a closure in a function of its own, so that its values fit in the registers.
    fn outline<R, F: FnOnce() -> R>(self, work: F) -> R;

    /// Loads one number per lane.
    fn load_node(self, numbers: &[f32; NODE_WIDTH]) -> Self::NodeF32;

    /// Returns a vector with the same number in all lanes.
    fn splat_node(self, number: f32) -> Self::NodeF32;

    /// Loads one number per lane.
    fn load_leaf(self, numbers: &[f32; LEAF_WIDTH]) -> Self::LeafF32;

    /// Returns a vector with the same number in all lanes.
    fn splat_leaf(self, number: f32) -> Self::LeafF32;

    /// Loads one number per lane.
    fn load_f64(self, numbers: &[f64; LEAF_WIDTH]) -> Self::PairF64;

    /// Returns a vector with the same number in all lanes.
    fn splat_f64(self, number: f64) -> Self::PairF64;

    /// Converts one number per lane.
    fn i32_to_f64(self, numbers: &[i32; LEAF_WIDTH]) -> Self::PairF64;

    /// Converts one number per lane.
    fn f32_to_f64(self, numbers: &[f32; LEAF_WIDTH]) -> Self::PairF64;

    /// Returns the mask of the numbers whose highest bit is set.
    fn highest_bits(self, numbers: &[u32; NODE_WIDTH]) -> u32;

    /// Writes the numbers in the mask to the front of `to`, in order. The rest of `to` is unspecified.
    fn compress(self, numbers: &[u32; NODE_WIDTH], mask: u32, to: &mut [u32; NODE_WIDTH]);

    /// Writes the lane numbers in the mask, each plus `first`, to the front of `to`, in order. The rest of `to` is
    /// unspecified.
    fn compress_range(self, first: u32, mask: u32, to: &mut [u32; LEAF_WIDTH]);

    /// Writes the numbers in the mask to the front of `to`, in order of descending keys, and their keys to the front of
    /// `keys_to`. The rest of both is unspecified. The keys written may be smaller by two millionths. No key may be
    /// negative.
    fn sort(
        self,
        keys: Self::NodeF32,
        numbers: &[u32; NODE_WIDTH],
        mask: u32,
        keys_to: &mut [f32; NODE_WIDTH],
        to: &mut [u32; NODE_WIDTH],
    );
}

/// An algorithm that is compiled for each backend. `run` should be `#[inline(always)]`, so that it becomes part of a
/// function that is compiled with the instructions of the backend.
pub(crate) trait Kernel {
    /// Result of the algorithm.
    type Output;

    /// Runs the algorithm.
    fn run<B: SimdBackend>(self, backend: B) -> Self::Output;
}

/// `N` numbers in single precision. Comparisons with NaN are false.
pub(crate) trait F32Lanes<const N: usize>: Copy {
    /// Writes the numbers in the mask to the front of `to`, in order. The rest of `to` is unspecified.
    fn compress(self, mask: u32, to: &mut [f32; N]);
    /// Returns `self − other`.
    fn sub(self, other: Self) -> Self;
    /// Returns `self · other`.
    fn mul(self, other: Self) -> Self;
    /// Returns `self · factor + term`, rounded once or twice.
    fn mul_add(self, factor: Self, term: Self) -> Self;
    /// Returns `self · factor − term`, rounded once or twice.
    fn mul_sub(self, factor: Self, term: Self) -> Self;
    /// Returns the smaller number of each lane; either one if one is NaN.
    fn min(self, other: Self) -> Self;
    /// Returns the larger number of each lane; either one if one is NaN.
    fn max(self, other: Self) -> Self;
    /// Returns the mask of the lanes where `self ≤ other`.
    fn mask_le(self, other: Self) -> u32;
}

/// One or more numbers in double precision, with the operations that all backends round identically.
pub(crate) trait F64Lanes: Copy {
    /// Returns a vector of as many lanes as `self`, all with the same number.
    fn splat(self, number: f64) -> Self;
    /// Returns `self + other`.
    fn add(self, other: Self) -> Self;
    /// Returns `self − other`.
    fn sub(self, other: Self) -> Self;
    /// Returns `self · other`.
    fn mul(self, other: Self) -> Self;
    /// Returns the smaller number of each lane.
    fn min(self, other: Self) -> Self;
    /// Returns the larger number of each lane.
    fn max(self, other: Self) -> Self;
    /// Returns the mask of the lanes where `self ≤ other`.
    fn mask_le(self, other: Self) -> u32;
    /// Returns the mask of the lanes where `self < other`.
    fn mask_lt(self, other: Self) -> u32;
}

/// Eight numbers that can be stored in memory.
pub(crate) trait F64Store: Copy {
    /// Stores one number per lane.
    fn store(self, to: &mut [f64; LEAF_WIDTH]);
}

impl F64Lanes for f64 {
    #[inline(always)]
    fn splat(self, number: f64) -> Self {
        number
    }

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self + other
    }

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self - other
    }

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
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
    fn mask_le(self, other: Self) -> u32 {
        u32::from(self <= other)
    }

    #[inline(always)]
    fn mask_lt(self, other: Self) -> u32 {
        u32::from(self < other)
    }
}
