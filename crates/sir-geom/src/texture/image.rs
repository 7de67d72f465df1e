//! Images, and their mapping to surfaces.

use std::sync::LazyLock;

use glam::{DVec2, IVec2};

use crate::color::Rgb;
use sir_types::typed_index;

typed_index!(
    /// Index of a texture of a [`Scene`](crate::Scene).
    TextureId
);

/// An image: colors in 8-bit sRGB and 8 linear bits of alpha.
///
/// Coordinates are those of glTF: `(0, 0)` is the upper left corner of the image and `(1, 1)` the lower right. The
/// color is constant over the square of a texel, so that the mean over an area is well defined; only pictures
/// interpolate between texels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Texture {
    pub(super) width: u32,
    pub(super) height: u32,
    /// Row by row from the top.
    pub(super) texels: Vec<[u8; 4]>,
}

/// Extension of a texture beyond its square.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum Wrap {
    /// Periodic repetition.
    #[default]
    Repeat,
    /// Periodic repetition, with every other image mirrored.
    Mirror,
    /// The color of the nearest edge.
    Clamp,
}

/// Texture on a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TextureMap {
    /// The image.
    pub texture: TextureId,
    /// Extension beyond the image, horizontally and vertically.
    pub wrap: [Wrap; 2],
    /// Index of the coordinate set of the triangles that it uses.
    pub coordinates: u8,
}

/// A texture whose colors are multiplied by a factor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColorMap {
    /// The texture.
    pub map: TextureMap,
    /// Factor, in the unit of the product.
    pub factor: Rgb,
}

impl Texture {
    /// Returns an image of texels `[red, green, blue, alpha]`, row by row from the top; `None` if their number is zero
    /// or not `width × height`.
    #[must_use]
    pub fn new(width: u32, height: u32, texels: Vec<[u8; 4]>) -> Option<Self> {
        let count = u64::from(width) * u64::from(height);
        let is_size = |x: u32| i32::try_from(x).is_ok();
        (count > 0 && count == texels.len() as u64 && is_size(width) && is_size(height)).then_some(Self {
            width,
            height,
            texels,
        })
    }

    /// Returns width and height in texels.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        [self.width, self.height]
    }

    /// Returns the texels `[red, green, blue, alpha]`, row by row from the top: colors in sRGB, alpha linear.
    #[must_use]
    pub fn texels(&self) -> &[[u8; 4]] {
        &self.texels
    }

    /// Returns the mean linear color; alpha is ignored.
    #[must_use]
    pub fn mean_color(&self) -> Rgb {
        // Sums of integers do not depend on the order.
        let mut histogram = [[0u64; 3]; 256];
        for texel in &self.texels {
            for (channel, &value) in texel[..3].iter().enumerate() {
                histogram[usize::from(value)][channel] += 1;
            }
        }
        let mut sum = Rgb::ZERO;
        for (value, counts) in (0u8..=255).zip(histogram) {
            sum += srgb_to_linear(value) * Rgb::from_array(counts.map(|n| n as f64));
        }
        sum / self.texels.len() as f64
    }

    /// Returns the mean of alpha, in `[0, 1]`.
    #[must_use]
    pub fn mean_alpha(&self) -> f64 {
        let sum: u64 = self.texels.iter().map(|texel| u64::from(texel[3])).sum();
        sum as f64 / (255.0 * self.texels.len() as f64)
    }

    /// Returns the linear color at a place, interpolated between the four nearest texels.
    #[must_use]
    pub fn color_at(&self, place: DVec2, wrap: [Wrap; 2]) -> Rgb {
        let p = self.in_texels(place) - 0.5;
        let (corner, part) = (p.floor(), p - p.floor());
        let corner = corner.as_ivec2();
        let color = |x: i32, y: i32| {
            let [r, g, b, _] = self.texel(corner.wrapping_add(IVec2::new(x, y)), wrap);
            Rgb::new(srgb_to_linear(r), srgb_to_linear(g), srgb_to_linear(b))
        };
        let row = |y: i32| color(0, y).lerp(color(1, y), part.x);
        row(0).lerp(row(1), part.y)
    }

    /// Returns the alpha of the texel at a place, in `[0, 1]`.
    #[inline]
    #[must_use]
    pub fn alpha_at(&self, place: DVec2, wrap: [Wrap; 2]) -> f64 {
        let [.., alpha] = self.texel(self.in_texels(place).floor().as_ivec2(), wrap);
        f64::from(alpha) / 255.0
    }

    pub(super) fn in_texels(&self, place: DVec2) -> DVec2 {
        place * DVec2::new(f64::from(self.width), f64::from(self.height))
    }

    /// Returns the texel in a column and row.
    pub(super) fn texel(&self, at: IVec2, wrap: [Wrap; 2]) -> [u8; 4] {
        let column = wrap[0].inside(i64::from(at.x), i64::from(self.width));
        let row = wrap[1].inside(i64::from(at.y), i64::from(self.height));
        self.texels[row * self.width as usize + column]
    }
}

impl Wrap {
    /// Returns the column of an image of this width that appears at any column.
    pub(super) fn inside(self, column: i64, width: i64) -> usize {
        let inside = match self {
            Self::Repeat => column.rem_euclid(width),
            Self::Mirror => {
                let there_and_back = column.rem_euclid(2 * width);
                there_and_back.min(2 * width - 1 - there_and_back)
            }
            Self::Clamp => column.clamp(0, width - 1),
        };
        inside as usize
    }
}

/// Decodes an 8-bit value of sRGB (IEC 61966-2-1).
#[inline]
pub(crate) fn srgb_to_linear(value: u8) -> f64 {
    static VALUES: LazyLock<[f64; 256]> =
        LazyLock::new(|| std::array::from_fn(|value| srgb_to_linear_at(value as f64 / 255.0)));
    VALUES[usize::from(value)]
}

/// Decodes a value of sRGB in `[0, 1]`.
pub(crate) fn srgb_to_linear_at(s: f64) -> f64 {
    if s <= 0.04045 {
        return s / 12.92;
    }
    let x = (s + 0.055) / 1.055;
    x * x * fifth_root(x * x)
}

/// Returns the fifth root of a number in `(0, 1]`, by Newton's iteration.
///
/// `powf` may differ in the last bits between machines, and tallies depend on reflectances.
fn fifth_root(x: f64) -> f64 {
    let mut root = 1.0;
    // From above, the iterates decrease until rounding stops them.
    loop {
        let next = (4.0 * root + x / (root * root * root * root)) / 5.0;
        if next < root {
            root = next;
        } else {
            return root;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn srgb_agrees_with_its_formula() {
        for value in 0..=255u8 {
            let s = f64::from(value) / 255.0;
            let expected = if s <= 0.04045 { s / 12.92 } else { ((s + 0.055) / 1.055).powf(2.4) };
            assert!((srgb_to_linear(value) - expected).abs() < 1e-14, "{value}");
        }
    }

    #[test]
    fn the_mean_is_taken_of_linear_colors() {
        let texels = (0..8).map(|i| if i % 4 < 1 { [255, 0, 128, 0] } else { [0, 0, 128, 255] });
        let texture = Texture::new(4, 2, texels.collect()).unwrap();
        let mean = texture.mean_color();
        assert!((mean - Rgb::new(0.25, 0.0, 0.215_860_500_113_899_26)).length() < 1e-14, "{mean}");
        assert_eq!(texture.mean_alpha(), 0.75);
    }

    #[test]
    fn images_go_on_as_their_wrap_says() {
        let inside = |wrap: Wrap| (-4..8).map(|i| wrap.inside(i, 3)).collect::<Vec<_>>();
        assert_eq!(inside(Wrap::Repeat), [2, 0, 1, 2, 0, 1, 2, 0, 1, 2, 0, 1]);
        assert_eq!(inside(Wrap::Mirror), [2, 2, 1, 0, 0, 1, 2, 2, 1, 0, 0, 1]);
        assert_eq!(inside(Wrap::Clamp), [0, 0, 0, 0, 0, 1, 2, 2, 2, 2, 2, 2]);
    }

    #[test]
    fn colors_are_interpolated_between_the_middles_of_texels() {
        let texture = Texture::new(2, 1, vec![[0, 0, 0, 0], [255, 255, 255, 255]]).unwrap();
        for (u, repeated, clamped) in [(0.25, 0.0, 0.0), (0.5, 0.5, 0.5), (0.75, 1.0, 1.0), (1.0, 0.5, 1.0)] {
            for (wrap, expected) in [(Wrap::Repeat, repeated), (Wrap::Clamp, clamped)] {
                let found = texture.color_at(DVec2::new(u, 0.3), [wrap; 2]);
                assert!((found - Rgb::splat(expected)).length() < 1e-14, "{u} {wrap:?}: {found}");
            }
        }
        assert_eq!(texture.alpha_at(DVec2::new(0.49, 7.0), [Wrap::Repeat; 2]), 0.0);
        assert_eq!(texture.alpha_at(DVec2::new(-0.49, 7.0), [Wrap::Repeat; 2]), 1.0);
    }

    #[test]
    fn an_image_has_as_many_texels_as_its_size_says() {
        assert!(Texture::new(2, 2, vec![[0; 4]; 3]).is_none());
        assert!(Texture::new(0, 2, Vec::new()).is_none());
    }
}
