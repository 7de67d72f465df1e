//! Does a line cross a triangle?

use glam::DVec3;
use sir_geom::{Barycentric, Side, TriangleId};

use crate::grid::{Grid, GridLine, RADIUS};
use crate::hit::Hit;
use crate::lanes::Doubles;

/// A triangle on the grid.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GridTriangle {
    pub(crate) corners: [[i32; 3]; 3],
    pub(crate) id: TriangleId,
    /// Edge functions farther from zero than this have the right sign in double precision.
    pub(crate) certain: f32,
}

/// A crossing of a line and a triangle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Crossing {
    /// Distance along the line in steps of the grid, from the line's origin on the grid.
    pub(crate) t: f64,
    pub(crate) point: Barycentric,
    /// The side that faces the origin of the line.
    pub(crate) side: Side,
    pub(crate) id: TriangleId,
}

/// How triangles lie to lines: one of each per lane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Crossed<N> {
    /// Lanes whose triangle is certainly crossed by the (infinite, infinitesimally shifted) line, with the back, or with the
    /// front, towards the origin, as masks.
    pub(crate) back: u32,
    pub(crate) front: u32,
    /// Lanes of which rounding leaves it open.
    pub(crate) doubt: u32,
    /// From what the crossing follows, see [`Crossing::locate`].
    pub(crate) factors: Factors<N>,
}

/// The edge functions of the edges `ab` and `ca`, and their sum for all three edges; and how far, along the line, the first
/// corner lies from the origin, and the second and the third from the first.
pub(crate) type Factors<N> = [N; 6];

/// Three coordinates.
type Vector<D> = [D; 3];

#[inline(always)]
fn minus<D: Doubles>(a: Vector<D>, b: Vector<D>) -> Vector<D> {
    [a[0].minus(b[0]), a[1].minus(b[1]), a[2].minus(b[2])]
}

#[inline(always)]
fn dot<D: Doubles>(a: Vector<D>, b: Vector<D>) -> D {
    a[0].times(b[0]).plus(a[1].times(b[1])).plus(a[2].times(b[2]))
}

#[inline(always)]
fn cross<D: Doubles>(a: Vector<D>, b: Vector<D>) -> Vector<D> {
    [
        a[1].times(b[2]).minus(a[2].times(b[1])),
        a[2].times(b[0]).minus(a[0].times(b[2])),
        a[0].times(b[1]).minus(a[1].times(b[0])),
    ]
}

impl<D: Doubles> Crossed<D> {
    #[inline(always)]
    pub(crate) fn new(
        [a, b, c]: [Vector<D>; 3],
        certain: D,
        origin: Vector<D>,
        direction: Vector<D>,
    ) -> Self {
        let (oa, ab, ac) = (minus(a, origin), minus(b, a), minus(c, a));
        // Edge functions d · ((p − o) × (q − o)) of the three edges, after Möller and Trumbore (1997).
        let zero = D::splat(0.0);
        let moment = cross(direction, oa);
        let e_ab = dot(moment, ab);
        let e_ca = zero.minus(dot(moment, ac));
        let all = dot(direction, cross(ab, ac));
        let e_bc = all.minus(e_ab).minus(e_ca);
        let (low, high) = (e_ab.min(e_ca).min(e_bc), e_ab.max(e_ca).max(e_bc));
        let minus_certain = zero.minus(certain);
        let (back, front) = (certain.below(low), high.below(minus_certain));
        let doubt = (minus_certain.at_most(low) | high.at_most(certain)) & !(back | front);
        let factors = [e_ab, e_ca, all, dot(direction, oa), dot(direction, ab), dot(direction, ac)];
        Self { back, front, doubt, factors }
    }
}

impl Crossing {
    /// The crossing as a hit in the scene.
    #[inline(always)]
    pub(crate) fn hit(&self, grid: &Grid, line: &GridLine) -> Hit {
        let Self { t, point, side, id } = *self;
        Hit { t: grid.length(t + line.start), triangle: id, point, side }
    }

    /// Distance and place of a crossing.
    ///
    /// Weights are clamped so that a crossing is a point of the triangle whatever rounding does: this keeps the distance
    /// meaningful on slivers and at grazing incidence.
    #[inline(always)]
    pub(crate) fn locate([e_ab, e_ca, all, a, ab, ac]: Factors<f64>) -> (f64, Barycentric) {
        // Comparisons that also turn 0/0 into 0.
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
        // With u = 2⁻⁵³, offsets below M = 2³² and edges of 1-norm L, the edge functions are off by at most 50 u (M + L) L;
        // L < 2³³, so 64 u · 3M · L = 2⁻¹³·⁴ L is safe. 2⁻¹³ L also covers rounding it to f32.
        let certain = (longest / 8192.0) as f32;
        Self { corners, id, certain }
    }

    /// Normal of the front, twice as long as the area.
    pub(crate) fn scaled_normal(&self) -> DVec3 {
        let [a, b, c] = self.corners.map(position);
        (b - a).cross(c - a)
    }

    /// First corner, and the edges from there to the second and the third, in radii of the scene.
    pub(crate) fn in_radii(&self) -> [DVec3; 3] {
        let [a, b, c] = self.corners.map(position);
        [a / RADIUS, (b - a) / RADIUS, (c - a) / RADIUS]
    }

    /// The crossing of a line with this triangle.
    #[inline(always)]
    pub(crate) fn cross(&self, line: &GridLine) -> Option<Crossing> {
        let [a, b, c] = self.corners;
        let corner = |p: [i32; 3]| [f64::from(p[0]), f64::from(p[1]), f64::from(p[2])];
        let corners = [corner(a), corner(b), corner(c)];
        let (origin, direction) = (line.origin.to_array(), line.direction.to_array());
        let crossed = Crossed::new(corners, f64::from(self.certain), origin, direction);
        let side = if crossed.back != 0 {
            Side::Back
        } else if crossed.front != 0 {
            Side::Front
        } else if crossed.doubt != 0 {
            self.exact_crossing(line)?
        } else {
            return None;
        };
        let (t, point) = Crossing::locate(crossed.factors);
        Some(Crossing { t, point, side, id: self.id })
    }

    /// The side that faces the origin if all three edges pass on the same side of the line.
    #[cold]
    #[inline(never)]
    pub(crate) fn exact_crossing(&self, line: &GridLine) -> Option<Side> {
        let [a, b, c] = self.corners;
        let sign = line.exact_side(a, b);
        let same = sign != 0 && line.exact_side(b, c) == sign && line.exact_side(c, a) == sign;
        same.then_some(if sign > 0 { Side::Back } else { Side::Front })
    }
}
