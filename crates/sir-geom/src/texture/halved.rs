//! Smaller images of textures, for distant views.

use crate::color::Rgb;
use crate::texture::image::{Texture, srgb_to_linear};

impl Texture {
    /// Returns the image at half its size, rounded down, but at least one texel wide and high. Each texel is the mean,
    /// in linear color, of what it covers; if `by_alpha`, the mean weighted by alpha, unless alpha is zero. Colors are
    /// rounded to 8 bits of sRGB: good enough for display, not for computation.
    #[must_use]
    pub fn halved(&self, by_alpha: bool) -> Self {
        let [columns, rows] = [self.width, self.height].map(Covered::new);
        let mut texels = Vec::with_capacity(columns.count * rows.count);
        for row in 0..rows.count {
            for column in 0..columns.count {
                let (mut plain, mut weighted, mut alphas) = (Rgb::ZERO, Rgb::ZERO, 0.0);
                for (y, height) in rows.by(row) {
                    for (x, width) in columns.by(column) {
                        let [r, g, b, alpha] = self.texels[y * self.width as usize + x];
                        let color = Rgb::from_array([r, g, b].map(srgb_to_linear));
                        let alpha = width * height * f64::from(alpha);
                        plain += width * height * color;
                        weighted += alpha * color;
                        alphas += alpha;
                    }
                }
                let color = if by_alpha && alphas > 0.0 { weighted / alphas } else { plain };
                let [r, g, b] = color.to_array().map(linear_to_srgb);
                texels.push([r, g, b, alphas.round() as u8]);
            }
        }
        Self { width: columns.count as u32, height: rows.count as u32, texels }
    }
}

/// Old texels that the new ones cover, along one edge of an image.
struct Covered {
    old: usize,
    count: usize,
}

impl Covered {
    fn new(old: u32) -> Self {
        let old = old as usize;
        Self { old, count: (old / 2).max(1) }
    }

    /// Returns the old texels under a new one, and the share that each has of it.
    fn by(&self, new: usize) -> impl Iterator<Item = (usize, f64)> + use<> {
        // In units in which old texels have the length `count`, and new ones `old`.
        let (old, count) = (self.old, self.count);
        let (start, end) = (new * old, (new + 1) * old);
        (start / count..end.div_ceil(count)).map(move |i| {
            let covered = ((i + 1) * count).min(end) - (i * count).max(start);
            (i, covered as f64 / old as f64)
        })
    }
}

/// Returns the 8-bit value of sRGB nearest to a linear one.
fn linear_to_srgb(linear: f64) -> u8 {
    let (mut below, mut above) = (0u8, 255u8);
    while below < above {
        let middle = below + (above - below) / 2;
        if srgb_to_linear(middle) + srgb_to_linear(middle + 1) > 2.0 * linear {
            above = middle;
        } else {
            below = middle + 1;
        }
    }
    below
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_value_is_nearest_to_itself() {
        assert!((0..=255).all(|v| linear_to_srgb(srgb_to_linear(v)) == v));
        assert_eq!((linear_to_srgb(-1.0), linear_to_srgb(0.5), linear_to_srgb(2.0)), (0, 188, 255));
    }

    #[test]
    fn texels_have_the_mean_of_what_they_cover() {
        // Black and white make a linear 0.5, which is 188.
        let board = (0..16u32).map(|i| [if (i % 4 + i / 4).is_multiple_of(2) { 0 } else { 255 }; 4]);
        let board = Texture::new(4, 4, board.collect()).unwrap();
        let half = board.halved(false);
        assert_eq!((half.size(), half.texels()), ([2, 2], &[[188, 188, 188, 128]; 4][..]));
        assert_eq!(
            board.halved(true).texels(),
            [[255, 255, 255, 128]; 4],
            "transparent texels have no color"
        );
        // Five in two: two and a half each.
        let row = [0, 0, 255, 0, 0].map(|v| [v, 0, 0, 255]);
        let half = Texture::new(5, 1, row.to_vec()).unwrap().halved(true);
        // The value of 0.2.
        assert_eq!((half.size(), half.texels()), ([2, 1], &[[124, 0, 0, 255]; 2][..]));
    }

    #[test]
    fn the_smallest_image_has_nearly_the_mean() {
        let texels = (0..7 * 300).map(|i: u32| [(i * 37 % 256) as u8, (i * 101 % 251) as u8, 9, 255]);
        let texture = Texture::new(7, 300, texels.collect()).unwrap();
        let mean = texture.mean_color();
        let mut smaller = texture;
        while smaller.size() != [1, 1] {
            smaller = smaller.halved(false);
        }
        // Rounding costs half a step of sRGB at some of the levels.
        assert!((smaller.mean_color() / mean - 1.0).abs().max_element() < 0.02);
    }
}
