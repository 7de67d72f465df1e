//! Forecast of how often lines cross a surface.

/// Expected numbers of crossings of uniform lines through a convex domain.
///
/// Of `N` uniform lines through a convex body of surface `S`, on average `N · 2A / S` cross a planar patch of area `A`
/// inside it (Cauchy–Crofton; Santaló 1976, *Integral Geometry and Geometric Probability*, ch. 14).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Forecast {
    /// Number of lines, `N`.
    pub lines: u64,
    /// Surface of the domain, `S`.
    pub surface: f64,
}

impl Forecast {
    /// Returns the expected number of crossings of a patch of area `A`, given in the unit of the domain's surface.
    #[inline]
    #[must_use]
    pub fn crossings(&self, area: f64) -> f64 {
        self.lines as f64 * 2.0 * area / self.surface
    }
}
