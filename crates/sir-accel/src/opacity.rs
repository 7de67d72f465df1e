//! Transparent surfaces, which stop only some of the lines.

use std::fmt;
use std::sync::Arc;

use sir_types::{Barycentric, Line, TriangleId};

/// Opacity of surfaces: the probability that they stop a line. Implemented for functions
/// `Fn(TriangleId, Barycentric) -> f64`.
pub trait Opacity: Send + Sync {
    /// Returns the opacity of a triangle at a point, from 0 (open) to 1 (opaque). The same arguments must always give
    /// the same result.
    fn opacity(&self, triangle: TriangleId, point: Barycentric) -> f64;

    /// Returns the memory in use \[bytes\], which [`Accel::bytes`](crate::Accel::bytes) includes.
    fn bytes(&self) -> usize {
        0
    }
}

impl<F: Fn(TriangleId, Barycentric) -> f64 + Send + Sync> Opacity for F {
    fn opacity(&self, triangle: TriangleId, point: Barycentric) -> f64 {
        self(triangle, point)
    }
}

/// Opacity test: decides which crossings stop their lines.
///
/// A crossing stops its line with a probability equal to the opacity there. The decision is a hash of line and
/// triangle, not a random number: a line hits the same surfaces in all searches, traced alone or with others.
#[derive(Clone)]
pub(crate) struct OpacityTest {
    /// True for triangles whose opacity is evaluated; all others are opaque.
    is_transparent: Vec<bool>,
    opacity: Arc<dyn Opacity>,
}

impl OpacityTest {
    pub(crate) fn new(is_transparent: Vec<bool>, opacity: Arc<dyn Opacity>) -> Self {
        Self { is_transparent, opacity }
    }

    /// Returns the number of triangles for which the test was made.
    pub(crate) fn triangles(&self) -> usize {
        self.is_transparent.len()
    }

    /// Returns true if any triangle is transparent.
    pub(crate) fn is_needed(&self) -> bool {
        self.is_transparent.contains(&true)
    }

    /// Returns true if a crossing stops its line.
    #[inline(never)]
    pub(crate) fn stops(&self, line: &Line, triangle: TriangleId, point: Barycentric) -> bool {
        let is_transparent = self.is_transparent.get(triangle.index()).copied().unwrap_or(false);
        !is_transparent || uniform(line, triangle) < self.opacity.opacity(triangle, point)
    }

    /// Returns the memory in use \[bytes\].
    pub(crate) fn bytes(&self) -> usize {
        self.is_transparent.len() + self.opacity.bytes()
    }
}

impl fmt::Debug for OpacityTest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let count = self.is_transparent.iter().filter(|&&is| is).count();
        write!(f, "OpacityTest({count} of {} triangles)", self.is_transparent.len())
    }
}

/// Returns a hash of line and triangle in `[0, 1)` that behaves like a uniform random number.
fn uniform(line: &Line, triangle: TriangleId) -> f64 {
    let numbers = [line.origin, line.direction].map(|v| v.to_array().map(f64::to_bits));
    let hash = |hash, number| mix(hash ^ number);
    let hash = numbers.as_flattened().iter().fold(mix(triangle.0.into()), |h, &number| hash(h, number));
    // The upper 53 bits: the precision of a double.
    (hash >> 11) as f64 / (1u64 << 53) as f64
}

/// Performs a step of SplitMix64 (Steele, Lea and Flood 2014): every bit of the result depends on every bit of the
/// number.
fn mix(number: u64) -> u64 {
    let mut z = number.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ z >> 31
}
