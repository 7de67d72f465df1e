//! Intersection of a line and a triangle.

use glam::DVec3;
use sir_types::{Barycentric, Side, TriangleId};

use crate::grid::{Grid, GridLine, RADIUS};
use crate::hit::Hit;
use crate::simd::backend::F64Lanes;

/// A triangle on the grid.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GridTriangle {
    pub(crate) corners: [[i32; 3]; 3],
    pub(crate) id: TriangleId,
    /// Error bound of edge functions in double precision: larger absolute values have the right sign.
    pub(crate) certain: f32,
    /// Rank among the triangles in stacks: of two in one stack, the one of higher rank is on top. [`NOT_STACKED`] if the
    /// triangle is in none.
    pub(crate) rank: u32,
}

/// Rank of triangles that are not in a stack.
pub(crate) const NOT_STACKED: u32 = u32::MAX;

/// A crossing of a line and a triangle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Crossing {
    /// Distance along the line from its origin on the grid \[steps of the grid\].
    pub(crate) t: f64,
    pub(crate) point: Barycentric,
    /// The side that faces the origin of the line.
    pub(crate) side: Side,
    pub(crate) id: TriangleId,
    /// Distance within which the triangle may be in contact with others \[steps of the grid\]; infinite in a stack.
    near: f32,
}

/// Edge functions of pairs of a line and a triangle, one pair per lane, and the decisions that follow from their signs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EdgeTest<N> {
    /// Mask of the triangles that the (infinite, infinitesimally shifted) line certainly crosses, with their back
    /// towards its origin.
    pub(crate) back: u32,
    /// Mask of the triangles that it certainly crosses, with their front towards its origin.
    pub(crate) front: u32,
    /// Mask of the triangles that need the exact test, because rounding may have changed a sign.
    pub(crate) doubt: u32,
    /// Input of [`Crossing::locate`].
    pub(crate) factors: Factors<N>,
}

/// Edge functions of the edges `ab` and `ca`, and the sum over all three edges; then the distances along the line from
/// the origin to the first corner, and from the first corner to the second and the third.
pub(crate) type Factors<N> = [N; 6];

/// Three coordinates.
type Vector<D> = [D; 3];

#[inline(always)]
fn sub<D: F64Lanes>(a: Vector<D>, b: Vector<D>) -> Vector<D> {
    [a[0].sub(b[0]), a[1].sub(b[1]), a[2].sub(b[2])]
}

#[inline(always)]
fn dot<D: F64Lanes>(a: Vector<D>, b: Vector<D>) -> D {
    a[0].mul(b[0]).add(a[1].mul(b[1])).add(a[2].mul(b[2]))
}

#[inline(always)]
fn cross<D: F64Lanes>(a: Vector<D>, b: Vector<D>) -> Vector<D> {
    [
        a[1].mul(b[2]).sub(a[2].mul(b[1])),
        a[2].mul(b[0]).sub(a[0].mul(b[2])),
        a[0].mul(b[1]).sub(a[1].mul(b[0])),
    ]
}

impl<D: F64Lanes> EdgeTest<D> {
    #[inline(always)]
    pub(crate) fn new(
        [a, b, c]: [Vector<D>; 3],
        certain: D,
        origin: Vector<D>,
        direction: Vector<D>,
    ) -> Self {
        let (oa, ab, ac) = (sub(a, origin), sub(b, a), sub(c, a));
        // Edge functions d · ((p − o) × (q − o)) of the three edges, after Möller and Trumbore (1997).
        let zero = certain.splat(0.0);
        let moment = cross(direction, oa);
        let e_ab = dot(moment, ab);
        let e_ca = zero.sub(dot(moment, ac));
        let all = dot(direction, cross(ab, ac));
        let e_bc = all.sub(e_ab).sub(e_ca);
        let (low, high) = (e_ab.min(e_ca).min(e_bc), e_ab.max(e_ca).max(e_bc));
        let minus_certain = zero.sub(certain);
        let (back, front) = (certain.mask_lt(low), high.mask_lt(minus_certain));
        let doubt = (minus_certain.mask_le(low) | high.mask_le(certain)) & !(back | front);
        let factors = [e_ab, e_ca, all, dot(direction, oa), dot(direction, ab), dot(direction, ac)];
        Self { back, front, doubt, factors }
    }
}

impl Crossing {
    #[inline(always)]
    pub(crate) fn new(triangle: &GridTriangle, t: f64, point: Barycentric, side: Side) -> Self {
        // More than `Stacks::distance`, which is at most 2⁻¹⁵ extents and four steps. `certain` is at least 2⁻¹⁴ extents.
        let near = if triangle.rank == NOT_STACKED { 0.51 * triangle.certain + 4.0 } else { f32::INFINITY };
        Self { t, point, side, id: triangle.id, near }
    }

    /// Returns a distance within which the order of contacts may decide whether the crossing is ahead of another
    /// \[steps of the grid\].
    #[inline(always)]
    pub(crate) fn near(&self) -> f64 {
        f64::from(self.near)
    }

    /// Returns true if the triangle is in a stack.
    #[inline(always)]
    pub(crate) fn is_stacked(&self) -> bool {
        self.near == f32::INFINITY
    }

    /// Converts the crossing to a hit.
    #[inline(always)]
    pub(crate) fn hit(&self, grid: &Grid, line: &GridLine) -> Hit {
        let Self { t, point, side, id, .. } = *self;
        Hit { t: grid.length(t + line.start), triangle: id, point, side }
    }

    /// Returns the distance of a crossing along the line, and its point on the triangle.
    ///
    /// Weights are clamped so that the crossing is a point of the triangle in spite of rounding. This keeps the
    /// distance meaningful on slivers and at grazing incidence.
    #[inline(always)]
    pub(crate) fn locate([e_ab, e_ca, all, a, ab, ac]: Factors<f64>) -> (f64, Barycentric) {
        // These comparisons also turn 0/0 into 0.
        let clamp = |x: f64, most: f64| {
            let x = if x > 0.0 { x } else { 0.0 };
            if x < most { x } else { most }
        };
        let v = clamp(e_ca / all, 1.0);
        let w = clamp(e_ab / all, 1.0 - v);
        (a + v * ab + w * ac, Barycentric { v, w })
    }
}

#[inline]
fn position(p: [i32; 3]) -> DVec3 {
    DVec3::from_array(p.map(f64::from))
}

impl GridTriangle {
    pub(crate) fn new(corners: [[i32; 3]; 3], id: TriangleId) -> Self {
        let [a, b, c] = corners.map(position);
        let longest = [b - a, c - a].map(|e| e.abs().element_sum()).into_iter().fold(0.0, f64::max);
        // With u = 2⁻⁵³, offsets below M = 2³² and edges of 1-norm L, the edge functions have an error of at most
        // 50 u (M + L) L. L < 2³³, so 64 u · 3M · L = 2⁻¹³·⁴ L is a safe bound. 2⁻¹³ L also covers its rounding to f32.
        let certain = (longest / 8192.0) as f32;
        Self { corners, id, certain, rank: NOT_STACKED }
    }

    /// Returns the corners \[steps of the grid\].
    pub(crate) fn positions(&self) -> [DVec3; 3] {
        self.corners.map(position)
    }

    /// Returns the normal of the front; its length is twice the area.
    pub(crate) fn scaled_normal(&self) -> DVec3 {
        let [a, b, c] = self.positions();
        (b - a).cross(c - a)
    }

    /// Returns the first corner, and the edges from it to the second and the third, in radii of the scene.
    pub(crate) fn in_radii(&self) -> [DVec3; 3] {
        let [a, b, c] = self.positions();
        [a / RADIUS, (b - a) / RADIUS, (c - a) / RADIUS]
    }

    /// Returns the crossing of a line with this triangle.
    #[inline(always)]
    pub(crate) fn cross(&self, line: &GridLine) -> Option<Crossing> {
        let [a, b, c] = self.corners;
        let corner = |p: [i32; 3]| [f64::from(p[0]), f64::from(p[1]), f64::from(p[2])];
        let corners = [corner(a), corner(b), corner(c)];
        let (origin, direction) = (line.origin.to_array(), line.direction.to_array());
        let test = EdgeTest::new(corners, f64::from(self.certain), origin, direction);
        let side = if test.back != 0 {
            Side::Back
        } else if test.front != 0 {
            Side::Front
        } else if test.doubt != 0 {
            self.exact_crossing(line)?
        } else {
            return None;
        };
        let (t, point) = Crossing::locate(test.factors);
        Some(Crossing::new(self, t, point, side))
    }

    /// Returns the side that faces the origin of the line; `None` unless all three edges pass on the same side of the
    /// line. The test is exact.
    #[cold]
    #[inline(never)]
    pub(crate) fn exact_crossing(&self, line: &GridLine) -> Option<Side> {
        let [a, b, c] = self.corners;
        let sign = line.exact_side(a, b);
        let same = sign != 0 && line.exact_side(b, c) == sign && line.exact_side(c, a) == sign;
        same.then_some(if sign > 0 { Side::Back } else { Side::Front })
    }
}
