//! Means of a texture over triangles, without sampling.
//!
//! The color is constant over the square of a texel, so the integral over a triangle is a sum over texels of value
//! times common area. By Green's theorem it is also an integral along the boundary, `∬ f = ∮ G dy` with
//! `G(x, y) = ∫₀ˣ f(x′, y) dx′`. It needs only the texels that the boundary crosses, if sums along rows are known.

use glam::{DVec2, DVec4};

use crate::color::Rgb;
use crate::texture::image::{Texture, Wrap, srgb_to_linear};

/// Number of texels in a row between stored sums.
const BLOCK: usize = 16;

/// Maximum number of texels visited along the edges of a triangle; a larger triangle has the mean of the whole image.
const MAX_BOUNDARY_TEXELS: f64 = 65_536.0;

/// Mean of a texture over an area.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureMean {
    /// Mean linear color, weighted by the weights of the texels.
    pub color: Rgb,
    /// Mean weight.
    pub weight: f64,
}

/// A texture prepared for means over triangles. Uses 2 bytes per texel besides those of the texture.
#[derive(Clone, Debug)]
pub struct TextureSums<'a> {
    texture: &'a Texture,
    wrap: [Wrap; 2],
    /// Weight of each value of alpha.
    weights: [f64; 256],
    /// Sums of the texels of a row before each block, and after the last.
    blocks: Vec<DVec4>,
    blocks_per_row: usize,
    whole: DVec4,
}

impl<'a> TextureSums<'a> {
    /// Prepares a texture. `weight` maps the alpha of a texel, from 0 to 1, to its weight.
    #[must_use]
    pub fn new(texture: &'a Texture, wrap: [Wrap; 2], weight: impl Fn(f64) -> f64) -> Self {
        let width = texture.width as usize;
        let blocks_per_row = width / BLOCK + 2;
        let mut sums = Self {
            texture,
            wrap,
            weights: std::array::from_fn(|alpha| weight(alpha as f64 / 255.0)),
            blocks: Vec::with_capacity(blocks_per_row * texture.height as usize),
            blocks_per_row,
            whole: DVec4::ZERO,
        };
        for (row, end) in texture.texels.chunks_exact(width).zip((blocks_per_row..).step_by(blocks_per_row)) {
            let mut sum = DVec4::ZERO;
            for block in row.chunks(BLOCK) {
                sums.blocks.push(sum);
                sum += block.iter().map(|&texel| sums.value(texel)).sum::<DVec4>();
            }
            // The last one is the sum of the whole row.
            sums.blocks.resize(end, sum);
            sums.whole += sum;
        }
        sums.whole /= texture.texels.len() as f64;
        sums
    }

    /// Returns the mean over a triangle, given by the coordinates of its corners.
    ///
    /// If these are collinear or coincide, it is the mean of nine points along the longest edge. If the edges have more
    /// than 65,536 texels, it is that of the whole image.
    #[must_use]
    pub fn mean(&self, corners: [DVec2; 3]) -> TextureMean {
        self.finish(self.weighted_mean(corners.map(|corner| self.texture.in_texels(corner))))
    }

    /// Returns the mean of colors times weights (`xyz`), and of weights (`w`).
    fn weighted_mean(&self, corners: [DVec2; 3]) -> DVec4 {
        let edges = [0, 1, 2].map(|i| (corners[i], corners[(i + 1) % 3]));
        let length = |&(a, b): &(DVec2, DVec2)| (b - a).abs().element_sum();
        let around: f64 = edges.iter().map(length).sum();
        if around.is_nan() || around > MAX_BOUNDARY_TEXELS {
            return self.whole;
        }
        // Near the origin, sums cancel without loss of precision.
        let origin = corners[0].min(corners[1]).min(corners[2]);
        let shift = DVec2::new(self.shift(0, origin.x), self.shift(1, origin.y));
        let [a, b, c] = corners.map(|corner| corner - shift);
        if a.abs().max_element() > 1e9 {
            return self.whole;
        }
        let doubled_area = (b - a).perp_dot(c - a);
        if doubled_area.abs() <= 1e-7 * around * around || around < 1e-3 {
            let longest = edges.iter().max_by(|a, b| length(a).total_cmp(&length(b)));
            let &(from, to) = longest.unwrap_or(&edges[0]);
            let at = |i: i32| from.lerp(to, (f64::from(i) + 0.5) / 9.0).floor().as_ivec2();
            return (0..9).map(|i| self.value(self.texture.texel(at(i), self.wrap))).sum::<DVec4>() / 9.0;
        }
        2.0 * (self.edge_integral(a, b) + self.edge_integral(b, c) + self.edge_integral(c, a)) / doubled_area
    }

    /// Returns a whole number of periods of the pattern, at most `least`.
    fn shift(&self, axis: usize, least: f64) -> f64 {
        let size = f64::from(self.texture.size()[axis]);
        match self.wrap[axis] {
            Wrap::Repeat => (least / size).floor() * size,
            Wrap::Mirror => (least / (2.0 * size)).floor() * 2.0 * size,
            Wrap::Clamp => 0.0,
        }
    }

    fn finish(&self, mean: DVec4) -> TextureMean {
        let weight = mean.w.clamp(0.0, 1.0);
        // If the weight is zero, any color will do: that of the whole image is used.
        let of = [mean, self.whole].into_iter().find(|mean| mean.w > 1e-9);
        let color = of.map_or(Rgb::ZERO, |mean| (mean.truncate() / mean.w).clamp(Rgb::ZERO, Rgb::ONE));
        TextureMean { color, weight }
    }

    fn value(&self, [r, g, b, alpha]: [u8; 4]) -> DVec4 {
        let weight = self.weights[usize::from(alpha)];
        weight * DVec4::new(srgb_to_linear(r), srgb_to_linear(g), srgb_to_linear(b), 1.0)
    }

    /// Returns `∫ G dy` along an edge.
    fn edge_integral(&self, from: DVec2, to: DVec2) -> DVec4 {
        let (low, high, sign) = if from.y <= to.y { (from, to, 1.0) } else { (to, from, -1.0) };
        let height = high.y - low.y;
        if height == 0.0 {
            return DVec4::ZERO;
        }
        let at = |y: f64| low.x + (high.x - low.x) * ((y - low.y) / height).clamp(0.0, 1.0);
        let mut sum = DVec4::ZERO;
        let mut row = low.y.floor();
        while row < high.y {
            let (bottom, top) = (row.max(low.y), (row + 1.0).min(high.y));
            let (start, end) = (at(bottom), at(top));
            sum += (top - bottom) * self.in_row(row as i64, start.min(end), start.max(end));
            row += 1.0;
        }
        sign * sum
    }

    /// Returns the mean of `G` between two places in a row.
    fn in_row(&self, row: i64, start: f64, end: f64) -> DVec4 {
        let mut column = start.floor();
        let mut before = self.before(row, column as i64);
        let at = |column: f64| glam::I64Vec2::new(column as i64, row).as_ivec2();
        let value = |column: f64| self.value(self.texture.texel(at(column), self.wrap));
        if end <= column + 1.0 {
            return before + (0.5 * (start + end) - column) * value(column);
        }
        let mut sum = DVec4::ZERO;
        while column < end {
            let (left, right, here) = (column.max(start), (column + 1.0).min(end), value(column));
            sum += (right - left) * (before + (0.5 * (left + right) - column) * here);
            before += here;
            column += 1.0;
        }
        sum / (end - start)
    }

    /// Returns the sum of the texels of a row from column 0 up to, but not including, a column; to the left of column 0
    /// it is negative.
    fn before(&self, row: i64, column: i64) -> DVec4 {
        let (width, row) =
            (i64::from(self.texture.width), self.wrap[1].inside(row, i64::from(self.texture.height)));
        let sums = &self.blocks[row * self.blocks_per_row..][..self.blocks_per_row];
        let texels = &self.texture.texels[row * width as usize..][..width as usize];
        let inside = |column: i64| {
            let (column, block) = (column as usize, column as usize / BLOCK);
            let rest = texels[block * BLOCK..column].iter();
            sums[block] + rest.map(|&texel| self.value(texel)).sum::<DVec4>()
        };
        let all = sums[self.blocks_per_row - 1];
        match self.wrap[0] {
            Wrap::Repeat => column.div_euclid(width) as f64 * all + inside(column.rem_euclid(width)),
            Wrap::Mirror => {
                let there_and_back = column.rem_euclid(2 * width);
                let part = if there_and_back <= width {
                    inside(there_and_back)
                } else {
                    2.0 * all - inside(2 * width - there_and_back)
                };
                column.div_euclid(2 * width) as f64 * 2.0 * all + part
            }
            Wrap::Clamp if column < 0 => column as f64 * self.value(texels[0]),
            Wrap::Clamp if column > width => {
                all + (column - width) as f64 * self.value(texels[width as usize - 1])
            }
            Wrap::Clamp => inside(column),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// An image without symmetry.
    fn image(width: u32, height: u32) -> Texture {
        let texel = |i: u32| {
            let x = i.wrapping_mul(2_654_435_761);
            [x >> 24, x >> 16, x >> 8, x >> 20].map(|byte| byte as u8)
        };
        Texture::new(width, height, (0..width * height).map(texel).collect()).unwrap()
    }

    /// Returns the mean over a triangle, from very many points.
    fn sampled(texture: &Texture, wrap: [Wrap; 2], [a, b, c]: [DVec2; 3], n: u32) -> TextureMean {
        let (mut sum, mut weights) = (Rgb::ZERO, 0.0);
        let mut count = 0.0;
        for i in 0..n {
            for j in 0..n - i {
                let (v, w) =
                    ((f64::from(i) + 1.0 / 3.0) / f64::from(n), (f64::from(j) + 1.0 / 3.0) / f64::from(n));
                let p = texture.in_texels(a + v * (b - a) + w * (c - a)).floor().as_ivec2();
                let [r, g, b, alpha] = texture.texel(p, wrap);
                let weight = f64::from(alpha) / 255.0;
                sum += weight * Rgb::new(srgb_to_linear(r), srgb_to_linear(g), srgb_to_linear(b));
                weights += weight;
                count += 1.0;
            }
        }
        TextureMean { color: sum / weights, weight: weights / count }
    }

    #[test]
    fn two_triangles_make_the_whole_image() {
        for (width, height) in [(1, 1), (16, 3), (37, 53)] {
            let texture = image(width, height);
            let sums = TextureSums::new(&texture, [Wrap::Repeat; 2], |_| 1.0);
            let [lower, upper] =
                [DVec2::Y, DVec2::X].map(|third| sums.mean([DVec2::ZERO, DVec2::ONE, third]).color);
            let mean = texture.mean_color();
            assert!((0.5 * (lower + upper) - mean).length() < 1e-12, "{width} x {height}");
            let alpha = TextureSums::new(&texture, [Wrap::Clamp; 2], |alpha| alpha);
            let weights = [DVec2::Y, DVec2::X].map(|c| alpha.mean([DVec2::ZERO, DVec2::ONE, c]).weight);
            assert!((0.5 * (weights[0] + weights[1]) - texture.mean_alpha()).abs() < 1e-12);
        }
    }

    #[test]
    fn a_single_texel_and_a_single_point_have_their_own_color() {
        let texture = image(5, 4);
        let sums = TextureSums::new(&texture, [Wrap::Repeat; 2], |_| 1.0);
        let [r, g, b, _] = texture.texels()[5 + 3];
        let color = Rgb::new(srgb_to_linear(r), srgb_to_linear(g), srgb_to_linear(b));
        let at = |x: f64, y: f64| DVec2::new(x / 5.0 - 7.0, y / 4.0 + 3.0);
        for corners in [
            [at(3.1, 1.1), at(3.9, 1.2), at(3.4, 1.95)],
            [at(3.1, 1.5), at(3.5, 1.5), at(3.9, 1.5)],
            [at(3.5, 1.5); 3],
        ] {
            assert!((sums.mean(corners).color - color).length() < 1e-9, "{corners:?}");
        }
    }

    #[test]
    fn cut_out_texels_do_not_color_what_is_left() {
        let texels = (0..64).map(|i| if i % 2 == 0 { [255, 0, 0, 255] } else { [0, 255, 0, 10] }).collect();
        let texture = Texture::new(8, 8, texels).unwrap();
        let sums = TextureSums::new(&texture, [Wrap::Repeat; 2], |alpha| f64::from(u8::from(alpha >= 0.5)));
        let mean = sums.mean([DVec2::ZERO, DVec2::new(2.0, 0.0), DVec2::new(0.0, 1.0)]);
        assert!((mean.color - Rgb::X).length() < 1e-9 && (mean.weight - 0.5).abs() < 0.05, "{mean:?}");
    }

    #[test]
    fn absurd_coordinates_give_the_mean_of_the_image() {
        let texture = image(8, 8);
        let sums = TextureSums::new(&texture, [Wrap::Clamp; 2], |_| 1.0);
        for corner in [DVec2::NAN, DVec2::INFINITY, DVec2::splat(1e300), DVec2::splat(-1e30), DVec2::X * 1e12]
        {
            let mean = sums.mean([corner, DVec2::X, DVec2::Y]);
            assert!((mean.color - texture.mean_color()).length() < 1e-12, "{corner}");
            assert!(sums.mean([corner; 3]).color.is_finite());
        }
    }

    proptest! {
        #[test]
        fn the_mean_is_that_of_many_points(
            c in proptest::array::uniform6(-3.0..3.0f64),
            wraps in 0..9usize,
        ) {
            const WRAPS: [Wrap; 3] = [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp];
            let wrap = [WRAPS[wraps % 3], WRAPS[wraps / 3]];
            let texture = image(19, 7);
            let corners = [DVec2::new(c[0], c[1]), DVec2::new(c[2], c[3]), DVec2::new(c[4], c[5])];
            let area = (corners[1] - corners[0]).perp_dot(corners[2] - corners[0]).abs();
            prop_assume!(area > 0.2);
            let mean = TextureSums::new(&texture, wrap, |alpha| alpha).mean(corners);
            let expected = sampled(&texture, wrap, corners, 400);
            // Transparent areas have no color.
            prop_assume!(expected.weight > 0.02);
            prop_assert!((mean.weight - expected.weight).abs() < 4e-3, "{} {}", mean.weight, expected.weight);
            prop_assert!((mean.color - expected.color).length() < 8e-3, "{} {}", mean.color, expected.color);
        }
    }
}
