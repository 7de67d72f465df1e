//! Parts of lines that are searched for hits.

use std::ops::{Range, RangeFrom, RangeFull, RangeTo};

use sir_types::{Line, TriangleId};

/// A part of a line: the points whose signed distance `t` from the origin satisfies `start ≤ t < end`.
///
/// Distances have the unit of the coordinates, because directions have unit length. The range is half-open, so
/// consecutive ranges contain every hit of a line exactly once, and a shadow ray that ends on a light, `0.0..distance`,
/// does not hit the light. Bounds are compared with [`Hit::t`](crate::Hit::t) as returned, without any tolerance.
/// Either bound may be infinite. A range is empty if a bound is NaN or `end ≤ start`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TRange {
    /// Smallest distance, included.
    pub start: f64,
    /// Largest distance, excluded.
    pub end: f64,
}

impl TRange {
    /// The whole line.
    pub const ALL: Self = Self { start: f64::NEG_INFINITY, end: f64::INFINITY };

    /// The ray that starts at the origin of the line.
    pub const AHEAD: Self = Self { start: 0.0, end: f64::INFINITY };

    /// Returns true if a distance lies in the range.
    #[inline]
    #[must_use]
    pub fn contains(&self, t: f64) -> bool {
        self.start <= t && t < self.end
    }
}

impl From<Range<f64>> for TRange {
    fn from(range: Range<f64>) -> Self {
        Self { start: range.start, end: range.end }
    }
}

impl From<RangeFrom<f64>> for TRange {
    fn from(range: RangeFrom<f64>) -> Self {
        Self { start: range.start, ..Self::ALL }
    }
}

impl From<RangeTo<f64>> for TRange {
    fn from(range: RangeTo<f64>) -> Self {
        Self { end: range.end, ..Self::ALL }
    }
}

impl From<RangeFull> for TRange {
    fn from(_: RangeFull) -> Self {
        Self::ALL
    }
}

/// A part of a line, and the surface that it leaves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// The line on which the ray lies.
    pub line: Line,
    /// The part of the line that is searched.
    pub range: TRange,
    /// Triangle on which the origin lies, if the ray leaves a surface. The ray does not hit this triangle again. Of the
    /// surfaces in contact with it, the ray hits only those on top of the side that it leaves. This rule decides where
    /// the ray begins; the start of the range counts only if it is above zero.
    pub leaving: Option<TriangleId>,
}

impl Ray {
    /// Returns a ray from the origin of a line to infinity.
    #[inline]
    #[must_use]
    pub fn new(line: Line) -> Self {
        Self { line, range: TRange::AHEAD, leaving: None }
    }

    /// Returns a ray from a point of a triangle, the origin of the line, to infinity.
    #[inline]
    #[must_use]
    pub fn leaving(line: Line, triangle: TriangleId) -> Self {
        Self { line, range: TRange::AHEAD, leaving: Some(triangle) }
    }

    /// Returns the same ray with another range of distances: `Ray::new(line).within(0.0..5.0)`.
    #[inline]
    #[must_use]
    pub fn within(self, range: impl Into<TRange>) -> Self {
        Self { range: range.into(), ..self }
    }
}

impl From<Line> for Ray {
    /// Returns a ray from the origin of the line to infinity, which leaves no surface.
    #[inline]
    fn from(line: Line) -> Self {
        Self::new(line)
    }
}
