//! Does a line cross a triangle?

use glam::DVec3;
use sir_geom::{Barycentric, Side, TriangleId};

use crate::grid::GridLine;

/// A triangle on the grid.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GridTriangle {
    corners: [[i32; 3]; 3],
    pub(crate) id: TriangleId,
    /// Edge functions farther from zero than this have the right sign in double precision.
    certain: f32,
}

/// A crossing, with the distance along the line in steps of the grid from the line's grid origin.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Crossing {
    pub(crate) t: f64,
    pub(crate) point: Barycentric,
    /// The side that faces the origin of the line.
    pub(crate) side: Side,
}

#[inline]
fn position(p: [i32; 3]) -> DVec3 {
    DVec3::new(f64::from(p[0]), f64::from(p[1]), f64::from(p[2]))
}

impl GridTriangle {
    pub(crate) fn new(corners: [[i32; 3]; 3], id: TriangleId) -> Self {
        let [a, b, c] = corners.map(position);
        let longest = [b - a, c - a].map(|e| e.abs().element_sum()).into_iter().fold(0.0, f64::max);
        // With u = 2⁻⁵³, offsets below M = 2³² and edges of 1-norm L, the edge functions below are off by at most
        // 50 u (M + L) L; L < 2³³, so 64 u · 3M · L = 2⁻¹³·⁴ L is safe. 2⁻¹³ L also covers rounding it to f32.
        let certain = (longest / 8192.0) as f32;
        Self { corners, id, certain }
    }

    /// Normal of the front, twice as long as the area.
    pub(crate) fn scaled_normal(&self) -> DVec3 {
        let [a, b, c] = self.corners.map(position);
        (b - a).cross(c - a)
    }

    pub(crate) fn corners(&self) -> [[i32; 3]; 3] {
        self.corners
    }

    /// The crossing of the (infinite, infinitesimally shifted) line with this triangle.
    #[inline]
    pub(crate) fn cross(&self, line: &GridLine) -> Option<Crossing> {
        let [a, b, c] = self.corners.map(position);
        let (oa, ab, ac) = (a - line.origin, b - a, c - a);
        // Edge functions d · ((p − o) × (q − o)) of the three edges, after Möller and Trumbore (1997).
        let moment = line.direction.cross(oa);
        let e_ab = moment.dot(ab);
        let e_ca = -moment.dot(ac);
        let certain = f64::from(self.certain);
        let (low, high) = (e_ab.min(e_ca), e_ab.max(e_ca));
        if low < -certain && high > certain {
            return None;
        }
        let all = line.direction.dot(ab.cross(ac));
        let e_bc = all - e_ab - e_ca;
        let (low, high) = (low.min(e_bc), high.max(e_bc));
        let side = if low > certain {
            Side::Back
        } else if high < -certain {
            Side::Front
        } else if low < -certain && high > certain {
            return None;
        } else {
            self.exact_crossing(line)?
        };
        // Weights are clamped so that a crossing is a point of the triangle whatever rounding does: this keeps
        // `t` meaningful on slivers and at grazing incidence. `max` also turns 0/0 into 0.
        let v = (e_ca / all).max(0.0).clamp(0.0, 1.0);
        let w = (e_ab / all).max(0.0).clamp(0.0, 1.0 - v);
        let t = line.direction.dot(oa + v * ab + w * ac);
        Some(Crossing { t, point: Barycentric { v, w }, side })
    }

    /// The side that faces the origin if all three edges pass on the same side of the line.
    #[cold]
    fn exact_crossing(&self, line: &GridLine) -> Option<Side> {
        let [a, b, c] = self.corners;
        let sign = line.exact_side(a, b);
        let same = sign != 0 && line.exact_side(b, c) == sign && line.exact_side(c, a) == sign;
        same.then_some(if sign > 0 { Side::Back } else { Side::Front })
    }
}
