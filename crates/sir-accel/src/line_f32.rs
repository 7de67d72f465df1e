//! Lines in single precision, for culling.

use crate::grid::{GridLine, RADIUS};

/// One of the bounds of a node: smallest coordinates per axis, then largest. The number inside is below 6.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bound(u8);

impl Bound {
    /// The smallest or the largest coordinates of an axis.
    fn new(largest: bool, axis: usize) -> Self {
        Self(3 * u8::from(largest) + (axis % 3) as u8)
    }

    /// The number of the bound, below 6.
    #[inline(always)]
    pub(crate) fn index(self) -> usize {
        usize::from(self.0)
    }
}

/// A line in radii of the scene about its center.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LineF32 {
    pub(crate) origin: [f32; 3],
    pub(crate) direction: [f32; 3],
    pub(crate) inverse: [f32; 3],
    /// Origin times inverse, negative.
    pub(crate) offset: [f32; 3],
    /// Per axis, the bounds of a node that are met first, and those that are met last.
    pub(crate) bounds: [[Bound; 3]; 2],
}

impl LineF32 {
    #[inline(always)]
    pub(crate) fn new(line: &GridLine) -> Self {
        let origin = (line.origin * (1.0 / RADIUS)).as_vec3().to_array();
        let direction = line.direction.as_vec3().to_array();
        // A component of zero becomes a tiny one: the slab is then passed or missed as a whole.
        let invert = |d: f32| if d == 0.0 { 1e20 } else { 1.0 / d };
        let inverse = [invert(direction[0]), invert(direction[1]), invert(direction[2])];
        let offset = [-origin[0] * inverse[0], -origin[1] * inverse[1], -origin[2] * inverse[2]];
        let bound = |last: bool, axis: usize| Bound::new((direction[axis] < 0.0) != last, axis);
        let bounds = |last: bool| [bound(last, 0), bound(last, 1), bound(last, 2)];
        Self { origin, direction, inverse, offset, bounds: [bounds(false), bounds(true)] }
    }
}

/// The part of a line that matters, as distances from its origin on the grid \[radii\].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Span {
    pub(crate) from: f32,
    pub(crate) to: f32,
}

/// No point of the scene is farther from the origin of a line on the grid \[radii\].
const FAR: f64 = 4.0;

impl Span {
    /// The span between two distances \[steps of the grid\], enlarged by a slack on both sides that covers what single
    /// precision loses.
    #[inline(always)]
    pub(crate) fn new(from: f64, to: f64, slack: f64) -> Self {
        let radii = |steps: f64| (steps / RADIUS).clamp(-FAR, FAR) as f32;
        Self { from: radii(from - slack), to: radii(to + slack) }
    }
}
