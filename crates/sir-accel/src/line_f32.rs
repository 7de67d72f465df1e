//! Lines in single precision, for culling.

use crate::grid::{GridLine, RADIUS};

/// Index of one of the bounds of a node, below 6: smallest coordinates per axis, then largest.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bound(u8);

impl Bound {
    /// Returns the bound that holds the smallest or the largest coordinates of an axis.
    fn new(largest: bool, axis: usize) -> Self {
        Self(3 * u8::from(largest) + (axis % 3) as u8)
    }

    /// Returns the index, below 6.
    #[inline(always)]
    pub(crate) fn index(self) -> usize {
        usize::from(self.0)
    }
}

/// A line in radii of the scene relative to its center.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LineF32 {
    pub(crate) origin: [f32; 3],
    pub(crate) direction: [f32; 3],
    pub(crate) inverse: [f32; 3],
    /// Negative of the product of origin and inverse.
    pub(crate) offset: [f32; 3],
    /// Bounds of a node that the line meets first per axis, and those that it meets last.
    pub(crate) bounds: [[Bound; 3]; 2],
}

impl LineF32 {
    #[inline(always)]
    pub(crate) fn new(line: &GridLine) -> Self {
        let origin = (line.origin * (1.0 / RADIUS)).as_vec3().to_array();
        let direction = line.direction.as_vec3().to_array();
        // A zero component becomes a tiny one, so that the line passes or misses the whole slab.
        let invert = |d: f32| if d == 0.0 { 1e20 } else { 1.0 / d };
        let inverse = [invert(direction[0]), invert(direction[1]), invert(direction[2])];
        let offset = [-origin[0] * inverse[0], -origin[1] * inverse[1], -origin[2] * inverse[2]];
        let bound = |last: bool, axis: usize| Bound::new((direction[axis] < 0.0) != last, axis);
        let bounds = |last: bool| [bound(last, 0), bound(last, 1), bound(last, 2)];
        Self { origin, direction, inverse, offset, bounds: [bounds(false), bounds(true)] }
    }
}

/// Part of a line that is searched, as distances from its origin on the grid \[radii\].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Span {
    pub(crate) from: f32,
    pub(crate) to: f32,
}

/// Length by which a searched part of a line exceeds its range \[steps of the grid\]. It covers the rounding errors of
/// single precision.
pub(crate) const SLACK: f64 = 2e-6 * RADIUS;

/// Upper bound of the distance from the origin of a line on the grid to any point of the scene \[radii\].
const FAR: f64 = 4.0;

impl Span {
    /// Returns the span between two distances \[steps of the grid\], extended by [`SLACK`] on both sides.
    #[inline(always)]
    pub(crate) fn new(from: f64, to: f64) -> Self {
        let radii = |steps: f64| (steps / RADIUS).clamp(-FAR, FAR) as f32;
        Self { from: radii(from - SLACK), to: radii(to + SLACK) }
    }
}
