//! Leaves: up to eight triangles, culled together in single precision.

use crate::line_f32::{LineF32, Span};
use crate::simd::backend::{F32Lanes, LEAF_WIDTH, SimdBackend};
use crate::triangle::GridTriangle;

/// Triangles in single precision, one per lane, in radii of the scene relative to its center.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(crate) struct Leaf {
    /// First corner, per axis.
    corner: [[f32; LEAF_WIDTH]; 3],
    /// Edge from the first corner to the second.
    ab: [[f32; LEAF_WIDTH]; 3],
    /// Edge from the first corner to the third.
    ac: [[f32; LEAF_WIDTH]; 3],
    /// Error bound of edge functions in single precision: larger absolute values have the right sign. NaN in unused
    /// lanes.
    certain: [f32; LEAF_WIDTH],
}

/// Three coordinates of eight vectors.
type Vectors<B> = [<B as SimdBackend>::LeafF32; 3];

#[inline(always)]
fn load<B: SimdBackend>(backend: B, v: &[[f32; LEAF_WIDTH]; 3]) -> Vectors<B> {
    [backend.load_leaf(&v[0]), backend.load_leaf(&v[1]), backend.load_leaf(&v[2])]
}

#[inline(always)]
fn splat<B: SimdBackend>(backend: B, v: [f32; 3]) -> Vectors<B> {
    [backend.splat_leaf(v[0]), backend.splat_leaf(v[1]), backend.splat_leaf(v[2])]
}

#[inline(always)]
fn dot<V: F32Lanes<LEAF_WIDTH>>(a: [V; 3], b: [V; 3]) -> V {
    a[0].mul_add(b[0], a[1].mul_add(b[1], a[2].mul(b[2])))
}

#[inline(always)]
fn cross<V: F32Lanes<LEAF_WIDTH>>(a: [V; 3], b: [V; 3]) -> [V; 3] {
    [
        a[1].mul_sub(b[2], a[2].mul(b[1])),
        a[2].mul_sub(b[0], a[0].mul(b[2])),
        a[0].mul_sub(b[1], a[1].mul(b[0])),
    ]
}

/// Error bound of an edge function, relative to the longest edge.
///
/// Let u = 2⁻²⁴. A line starts within 1.75 radii of the center, and so within M = 2.75 radii of any corner; edges have
/// the length L ≤ 2. Then the offset of the corner has the error 6 u, its moment 18 u, and the functions of two edges
/// 35 u L. The function of the third edge is the sum of these and of a term with the error 11 u L², so its error is
/// less than 110 u L. Twice as much is safe.
const DOUBT: f32 = 1.0 / 65536.0;

impl Leaf {
    pub(crate) fn new<'t>(triangles: impl Iterator<Item = &'t GridTriangle>) -> Self {
        let none = [[0.0; LEAF_WIDTH]; 3];
        let mut leaf = Self { corner: none, ab: none, ac: none, certain: [f32::NAN; LEAF_WIDTH] };
        for (lane, triangle) in triangles.enumerate().take(LEAF_WIDTH) {
            let [corner, ab, ac] = triangle.in_radii();
            for axis in 0..3 {
                leaf.corner[axis][lane] = corner[axis] as f32;
                leaf.ab[axis][lane] = ab[axis] as f32;
                leaf.ac[axis][lane] = ac[axis] as f32;
            }
            leaf.certain[lane] = ab.length().max(ac.length()) as f32 * DOUBT;
        }
        leaf
    }

    /// Returns the mask of the triangles that the infinite line may cross, within the span if one is given.
    #[inline(always)]
    pub(crate) fn candidates<B: SimdBackend>(&self, backend: B, line: &LineF32, span: Option<Span>) -> u32 {
        let (origin, direction) = (splat(backend, line.origin), splat(backend, line.direction));
        let (corner, ab, ac) =
            (load(backend, &self.corner), load(backend, &self.ab), load(backend, &self.ac));
        let oa = [corner[0].sub(origin[0]), corner[1].sub(origin[1]), corner[2].sub(origin[2])];
        // As in `EdgeTest::new`.
        let zero = backend.splat_leaf(0.0);
        let moment = cross(direction, oa);
        let normal = cross(ab, ac);
        let e_ab = dot(moment, ab);
        let e_ca = zero.sub(dot(moment, ac));
        let all = dot(direction, normal);
        let e_bc = all.sub(e_ab).sub(e_ca);
        let (low, high) = (e_ab.min(e_ca).min(e_bc), e_ab.max(e_ca).max(e_bc));
        let certain = backend.load_leaf(&self.certain);
        let mut mask = zero.sub(certain).mask_le(low) | high.mask_le(certain);
        if let Some(Span { from, to }) = span {
            // The distance is `height / all`. The products have an error below 70 u L² where the distance matters; the
            // distance in double precision has a much smaller error.
            let height = dot(normal, oa);
            let doubt = certain.mul(certain).mul(backend.splat_leaf(1.0 / DOUBT));
            let minus_doubt = zero.sub(doubt);
            let after_end = height.sub(all.mul(backend.splat_leaf(to)));
            let after_begin = height.sub(all.mul(backend.splat_leaf(from)));
            let along = zero.mask_le(all) & after_end.mask_le(doubt) & minus_doubt.mask_le(after_begin);
            let against = all.mask_le(zero) & minus_doubt.mask_le(after_end) & after_begin.mask_le(doubt);
            mask &= along | against;
        }
        mask
    }
}
