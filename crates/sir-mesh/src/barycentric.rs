//! The regular grid of sub-triangles of one triangle.
//!
//! A triangle `(a, b, c)` whose edges are cut into `n` parts has `n` rows of sub-triangles parallel to the edge
//! `ab`. Row `j`, counted from that edge, has `2(n − j) − 1` of them, alternately upright and inverted. They are
//! numbered row by row, so row `j` starts at number `j(2n − j)`.

use sir_geom::Barycentric;

/// Returns the number, below `n²`, of the sub-triangle in which a point lies. A point on a common edge belongs to one
/// of the two sub-triangles; a point outside the triangle (by rounding) to the nearest one in its row or column.
#[inline]
pub(crate) fn locate(n: u32, p: Barycentric) -> u32 {
    let scaled = |x: f64| (x * f64::from(n)).max(0.0);
    let (x, y) = (scaled(p.v), scaled(p.w));
    // A cast of a float to an integer saturates, so anything out of range is caught by `min`.
    let j = (y as u32).min(n - 1);
    let i = (x as u32).min(n - 1 - j);
    // `&` instead of `&&`: a branch would be mispredicted half of the time.
    let inverted = (i + j + 1 < n) & ((x - f64::from(i)) + (y - f64::from(j)) > 1.0);
    j * (2 * n - j) + 2 * i + u32::from(inverted)
}

/// Returns the corners of sub-triangle `k`, in the orientation of the whole triangle.
pub(crate) fn corners(n: u32, k: u32) -> [Barycentric; 3] {
    let (i, j, inverted) = cell(n, k);
    let at = |i: u32, j: u32| Barycentric { v: f64::from(i) / f64::from(n), w: f64::from(j) / f64::from(n) };
    if inverted {
        [at(i + 1, j + 1), at(i, j + 1), at(i + 1, j)]
    } else {
        [at(i, j), at(i + 1, j), at(i, j + 1)]
    }
}

/// Returns the column and row of sub-triangle `k`, and true if it is inverted.
fn cell(n: u32, k: u32) -> (u32, u32, bool) {
    // The row j is the largest with j(2n − j) ≤ k; the floating-point estimate is off by at most one.
    let start = |j: u32| u64::from(j) * u64::from(2 * n - j);
    let (wide_n, wide_k) = (f64::from(n), f64::from(k));
    let mut j = ((wide_n - (wide_n * wide_n - wide_k).max(0.0).sqrt()) as u32).min(n - 1);
    while start(j) > u64::from(k) {
        j -= 1;
    }
    while j + 1 < n && start(j + 1) <= u64::from(k) {
        j += 1;
    }
    let in_row = (u64::from(k) - start(j)) as u32;
    (in_row / 2, j, in_row % 2 == 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn middle(c: [Barycentric; 3]) -> Barycentric {
        Barycentric { v: (c[0].v + c[1].v + c[2].v) / 3.0, w: (c[0].w + c[1].w + c[2].w) / 3.0 }
    }

    fn doubled_area([a, b, c]: [Barycentric; 3]) -> f64 {
        (b.v - a.v) * (c.w - a.w) - (b.w - a.w) * (c.v - a.v)
    }

    #[test]
    fn sub_triangles_are_congruent_and_found_by_their_middles() {
        for n in [1, 2, 3, 7, 20, 255] {
            let n2 = n * n;
            for k in 0..n2 {
                let c = corners(n, k);
                assert_eq!(locate(n, middle(c)), k, "n = {n}");
                assert!((doubled_area(c) * f64::from(n2) - 1.0).abs() < 1e-9, "n = {n}, k = {k}");
            }
        }
    }

    proptest! {
        #[test]
        fn a_point_lies_in_the_sub_triangle_that_is_found(n in 1u32..3000, x in 0.0..1.0f64, y in 0.0..1.0f64) {
            let p = if x + y > 1.0 { Barycentric { v: 1.0 - x, w: 1.0 - y } } else { Barycentric { v: x, w: y } };
            let k = locate(n, p);
            prop_assert!(k < n * n);
            let c = corners(n, k);
            for e in 0..3 {
                let sub = doubled_area([c[e], c[(e + 1) % 3], p]);
                prop_assert!(sub > -1e-12, "outside by {sub}");
            }
        }

        #[test]
        fn any_number_gives_a_patch(n in 1u32..40000, v: f64, w: f64) {
            let found = locate(n, Barycentric { v, w });
            prop_assert!(u64::from(found) < u64::from(n) * u64::from(n));
        }
    }
}
