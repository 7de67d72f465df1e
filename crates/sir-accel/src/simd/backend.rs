//! The vector operations that the searches need.

/// Boxes of a node.
pub(crate) const NODE_WIDTH: usize = 16;

/// Triangles of a leaf at most, and pairs of a line and a triangle that are intersected together.
pub(crate) const LEAF_WIDTH: usize = 8;

/// A set of vector instructions. A value of the type is the proof that the processor has them.
///
/// Masks have a bit per lane, the lowest for the first lane.
pub(crate) trait SimdBackend: Copy {
    /// A number in single precision per box of a node.
    type NodeF32: F32Lanes<NODE_WIDTH>;
    /// A number in single precision per triangle of a leaf.
    type LeafF32: F32Lanes<LEAF_WIDTH>;
    /// A number in double precision per pair of a line and a triangle.
    type PairF64: F64Lanes + F64Store;

    /// Runs a kernel, compiled for these instructions.
    fn run<K: Kernel>(self, kernel: K) -> K::Output;

    /// Runs a closure in a function of its own, so that its numbers find room in the registers.
    fn outline<R, F: FnOnce() -> R>(self, work: F) -> R;

    /// Reads a number per lane.
    fn load_node(self, numbers: &[f32; NODE_WIDTH]) -> Self::NodeF32;

    /// The same number in all lanes.
    fn splat_node(self, number: f32) -> Self::NodeF32;

    /// Reads a number per lane.
    fn load_leaf(self, numbers: &[f32; LEAF_WIDTH]) -> Self::LeafF32;

    /// The same number in all lanes.
    fn splat_leaf(self, number: f32) -> Self::LeafF32;

    /// Reads a number per lane.
    fn load_f64(self, numbers: &[f64; LEAF_WIDTH]) -> Self::PairF64;

    /// The same number in all lanes.
    fn splat_f64(self, number: f64) -> Self::PairF64;

    /// Converts a number per lane.
    fn i32_to_f64(self, numbers: &[i32; LEAF_WIDTH]) -> Self::PairF64;

    /// Converts a number per lane.
    fn f32_to_f64(self, numbers: &[f32; LEAF_WIDTH]) -> Self::PairF64;

    /// Returns the mask of the numbers whose highest bit is set.
    fn highest_bits(self, numbers: &[u32; NODE_WIDTH]) -> u32;

    /// Writes the numbers in the mask to the front of `to`, in order, and anything behind them.
    fn compress(self, numbers: &[u32; NODE_WIDTH], mask: u32, to: &mut [u32; NODE_WIDTH]);

    /// Writes the lane numbers in the mask, each plus `first`, to the front of `to`, in order, and anything behind them.
    fn compress_range(self, first: u32, mask: u32, to: &mut [u32; LEAF_WIDTH]);

    /// Writes the numbers in the mask to the front of `to`, by falling keys, and anything behind them. Writes their keys to
    /// `keys_to` alike; they may be made smaller by two millionths. No key may be negative.
    fn sort(
        self,
        keys: Self::NodeF32,
        numbers: &[u32; NODE_WIDTH],
        mask: u32,
        keys_to: &mut [f32; NODE_WIDTH],
        to: &mut [u32; NODE_WIDTH],
    );
}

/// An algorithm that is compiled for each backend. `run` should be `#[inline(always)]`, so that it becomes a part of a
/// function for which the compiler may use the instructions of the backend.
pub(crate) trait Kernel {
    /// The result of the algorithm.
    type Output;

    /// Runs the algorithm.
    fn run<B: SimdBackend>(self, backend: B) -> Self::Output;
}

/// `N` numbers in single precision. Comparisons with NaN are false.
pub(crate) trait F32Lanes<const N: usize>: Copy {
    /// Writes the numbers in the mask to the front of `to`, in order, and anything behind them.
    fn compress(self, mask: u32, to: &mut [f32; N]);
    /// `self − other`.
    fn sub(self, other: Self) -> Self;
    /// `self · other`.
    fn mul(self, other: Self) -> Self;
    /// `self · factor + term`, rounded once or twice.
    fn mul_add(self, factor: Self, term: Self) -> Self;
    /// `self · factor − term`, rounded once or twice.
    fn mul_sub(self, factor: Self, term: Self) -> Self;
    /// The smaller number of each lane; any of the two if one is NaN.
    fn min(self, other: Self) -> Self;
    /// The larger number of each lane; any of the two if one is NaN.
    fn max(self, other: Self) -> Self;
    /// The mask of the lanes where `self ≤ other`.
    fn mask_le(self, other: Self) -> u32;
}

/// One or more numbers in double precision, with the operations that are rounded alike everywhere.
pub(crate) trait F64Lanes: Copy {
    /// The same number in as many lanes as `self` has.
    fn splat(self, number: f64) -> Self;
    /// `self + other`.
    fn add(self, other: Self) -> Self;
    /// `self − other`.
    fn sub(self, other: Self) -> Self;
    /// `self · other`.
    fn mul(self, other: Self) -> Self;
    /// The smaller number of each lane.
    fn min(self, other: Self) -> Self;
    /// The larger number of each lane.
    fn max(self, other: Self) -> Self;
    /// The mask of the lanes where `self ≤ other`.
    fn mask_le(self, other: Self) -> u32;
    /// The mask of the lanes where `self < other`.
    fn mask_lt(self, other: Self) -> u32;
}

/// Eight numbers that can be written to memory.
pub(crate) trait F64Store: Copy {
    /// Writes a number per lane.
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
