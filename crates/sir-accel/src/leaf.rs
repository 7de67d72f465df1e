//! Leaves: up to eight triangles, among which those are found that a line may cross.

use crate::lanes::{Kit, Singles, TRIANGLES};
use crate::search::ShortLine;
use crate::triangle::GridTriangle;

/// Triangles in single precision, one lane each, in radii of the scene about its centre.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(crate) struct Leaf {
    /// The first corner, per axis.
    corner: [[f32; TRIANGLES]; 3],
    /// From the first corner to the second.
    ab: [[f32; TRIANGLES]; 3],
    /// From the first corner to the third.
    ac: [[f32; TRIANGLES]; 3],
    /// Edge functions farther from zero than this have the right sign in single precision; not a number in unused lanes.
    certain: [f32; TRIANGLES],
}

/// The part of a line that matters \[radii\]: finite numbers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Span {
    pub(crate) from: f32,
    pub(crate) to: f32,
}

/// Three coordinates, eight of each.
type Vectors<K> = [<K as Kit>::Triangles; 3];

#[inline(always)]
fn load<K: Kit>(v: &[[f32; TRIANGLES]; 3]) -> Vectors<K> {
    [K::Triangles::load(&v[0]), K::Triangles::load(&v[1]), K::Triangles::load(&v[2])]
}

#[inline(always)]
fn splat<K: Kit>(v: [f32; 3]) -> Vectors<K> {
    [K::Triangles::splat(v[0]), K::Triangles::splat(v[1]), K::Triangles::splat(v[2])]
}

#[inline(always)]
fn dot<K: Kit>(a: Vectors<K>, b: Vectors<K>) -> K::Triangles {
    a[0].times_plus(b[0], a[1].times_plus(b[1], a[2].times(b[2])))
}

#[inline(always)]
fn cross<K: Kit>(a: Vectors<K>, b: Vectors<K>) -> Vectors<K> {
    [
        a[1].times_minus(b[2], a[2].times(b[1])),
        a[2].times_minus(b[0], a[0].times(b[2])),
        a[0].times_minus(b[1], a[1].times(b[0])),
    ]
}

/// Rounding may take this much of the longest edge from an edge function.
///
/// With u = 2⁻²⁴, a line that starts within 1.75 radii, and so M = 2.75 radii from any corner, and edges of length L ≤ 2:
/// the offset of the corner is off by 6 u, its moment by 18 u, the functions of two edges by 35 u L and that of the third, the
/// sum of these and of one that is off by 11 u L², by less than 110 u L. Twice as much is safe.
const DOUBT: f32 = 1.0 / 65536.0;

impl Leaf {
    pub(crate) fn new<'t>(triangles: impl Iterator<Item = &'t GridTriangle>) -> Self {
        let none = [[0.0; TRIANGLES]; 3];
        let mut leaf = Self { corner: none, ab: none, ac: none, certain: [f32::NAN; TRIANGLES] };
        for (lane, triangle) in triangles.enumerate().take(TRIANGLES) {
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

    /// Lanes of triangles that the infinite line may cross, within the span if there is one, as a mask.
    #[inline(always)]
    pub(crate) fn candidates<K: Kit>(&self, line: &ShortLine, span: Option<Span>) -> u32 {
        let (origin, direction) = (splat::<K>(line.origin), splat::<K>(line.direction));
        let (corner, ab, ac) = (load::<K>(&self.corner), load::<K>(&self.ab), load::<K>(&self.ac));
        let oa = [corner[0].minus(origin[0]), corner[1].minus(origin[1]), corner[2].minus(origin[2])];
        // As in `Crossed::new`.
        let zero = K::Triangles::splat(0.0);
        let moment = cross::<K>(direction, oa);
        let normal = cross::<K>(ab, ac);
        let e_ab = dot::<K>(moment, ab);
        let e_ca = zero.minus(dot::<K>(moment, ac));
        let all = dot::<K>(direction, normal);
        let e_bc = all.minus(e_ab).minus(e_ca);
        let (low, high) = (e_ab.min(e_ca).min(e_bc), e_ab.max(e_ca).max(e_bc));
        let certain = K::Triangles::load(&self.certain);
        let mut may = zero.minus(certain).at_most(low) | high.at_most(certain);
        if let Some(Span { from, to }) = span {
            // Height over `all` is the distance. The products are off by less than 70 u L² where the distance matters, and the
            // distance as it is found in double precision by much less.
            let height = dot::<K>(normal, oa);
            let doubt = certain.times(certain).times(K::Triangles::splat(1.0 / DOUBT));
            let minus_doubt = zero.minus(doubt);
            let after_end = height.minus(all.times(K::Triangles::splat(to)));
            let after_begin = height.minus(all.times(K::Triangles::splat(from)));
            let along = zero.at_most(all) & after_end.at_most(doubt) & minus_doubt.at_most(after_begin);
            let against = all.at_most(zero) & minus_doubt.at_most(after_end) & after_begin.at_most(doubt);
            may &= along | against;
        }
        may
    }
}
