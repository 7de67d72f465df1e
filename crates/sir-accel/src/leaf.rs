//! Leaves: up to eight triangles, culled together in single precision.

use crate::line_f32::{LineF32, Span};
use crate::simd::backend::{F32Lanes, LEAF_WIDTH, SimdBackend};
use crate::triangle::GridTriangle;

/// Triangles in single precision, one lane each, in radii of the scene about its center.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(crate) struct Leaf {
    /// The first corner, per axis.
    corner: [[f32; LEAF_WIDTH]; 3],
    /// From the first corner to the second.
    ab: [[f32; LEAF_WIDTH]; 3],
    /// From the first corner to the third.
    ac: [[f32; LEAF_WIDTH]; 3],
    /// Edge functions farther from zero than this have the right sign in single precision; not a number in unused lanes.
    certain: [f32; LEAF_WIDTH],
}

/// Three coordinates, eight of each.
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

/// Error bound of an edge function, as a part of the longest edge.
///
/// With u = 2⁻²⁴, a line that starts within 1.75 radii, and so M = 2.75 radii from any corner, and edges of length L ≤ 2:
/// the offset of the corner is off by 6 u, its moment by 18 u, the functions of two edges by 35 u L and that of the third, the
/// sum of these and of one that is off by 11 u L², by less than 110 u L. Twice as much is safe.
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

    /// Returns the mask of the triangles that the infinite line may cross, within the span if there is one.
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
        let mut may = zero.sub(certain).mask_le(low) | high.mask_le(certain);
        if let Some(Span { from, to }) = span {
            // Height over `all` is the distance. The products are off by less than 70 u L² where the distance matters, and the
            // distance as it is found in double precision by much less.
            let height = dot(normal, oa);
            let doubt = certain.mul(certain).mul(backend.splat_leaf(1.0 / DOUBT));
            let minus_doubt = zero.sub(doubt);
            let after_end = height.sub(all.mul(backend.splat_leaf(to)));
            let after_begin = height.sub(all.mul(backend.splat_leaf(from)));
            let along = zero.mask_le(all) & after_end.mask_le(doubt) & minus_doubt.mask_le(after_begin);
            let against = all.mask_le(zero) & minus_doubt.mask_le(after_end) & after_begin.mask_le(doubt);
            may &= along | against;
        }
        may
    }
}
