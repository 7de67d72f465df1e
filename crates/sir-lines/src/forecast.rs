//! How often lines cross a surface.

/// The expected numbers of crossings of a set of uniform lines through a convex domain.
///
/// Of `N` uniform lines through a convex body of surface `S`, a planar patch of area `A` inside it is crossed by
/// `N · 2A / S` on average (Cauchy–Crofton; Santaló 1976, *Integral Geometry and Geometric Probability*, ch. 14).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Forecast {
    /// Number of lines, `N`.
    pub lines: u64,
    /// Surface of the domain, `S`.
    pub surface: f64,
}

impl Forecast {
    /// Expected number of crossings of a patch of area `A`, in the units of the domain's surface.
    #[inline]
    #[must_use]
    pub fn crossings(&self, area: f64) -> f64 {
        self.lines as f64 * 2.0 * area / self.surface
    }
}
