//! Decoding of images, and limits on all images of a scene together.

use std::io::Cursor;

use glam::{DVec2, Vec2};
use image::{ImageError, ImageReader, Limits};

use crate::builder::SceneBuilder;
use crate::color::Rgb;
use crate::load::notes::Notes;
use crate::material::Opacity;
use crate::texture::{ColorMap, Texture, TextureId, TextureMap, Wrap};

/// Warning about textures that cannot be read.
pub(super) const UNREADABLE: &str = "textures cannot be read; only their color factors are used";

/// Warning about textures beyond the limit of texels.
const TOO_MANY: &str =
    "textures exceed the limit of 268 million texels per scene and were replaced by their mean colors";

/// Maximum memory for a decoded image \[bytes\].
const MAX_MEMORY: u64 = 512 << 20;

/// Maximum number of texels in memory (1 GiB).
const MAX_TEXELS: u64 = 1 << 28;

/// Maximum number of decoded texels. Many images that refer to the same bytes in different ways would otherwise take
/// unbounded time.
const MAX_DECODED: u64 = 1 << 30;

/// Maximum number of pixels per byte of a file. Deflate packs 1,032 bytes into one, and PNG has up to 8 pixels in a byte.
/// JPEG needs a bit for each of the at least six blocks of 256 pixels, which makes 340.
const MAX_PIXELS_PER_BYTE: u64 = 8 * 1032;

/// Number of pixels that any file may have.
const FREE_PIXELS: u64 = 1 << 16;

/// Cached data about an image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Image {
    /// Its texture; `None` if all texels are equal or exceed the limit.
    texels: Option<TextureId>,
    /// Mean linear color.
    color: Rgb,
    /// Mean alpha, in `[0, 1]`.
    alpha: f64,
    /// True if alpha is the same everywhere.
    uniform_alpha: bool,
}

impl Image {
    #[cfg(feature = "obj")]
    /// Returns true if it is not opaque everywhere.
    pub(super) fn has_alpha(&self) -> bool {
        self.alpha < 1.0
    }
}

/// Remaining budget of texels for the images of a scene.
#[derive(Debug)]
pub(super) struct Images {
    /// Number of texels that may still be kept in memory.
    texels_left: u64,
    /// Number of texels that may still be decoded.
    decodes_left: u64,
}

impl Default for Images {
    fn default() -> Self {
        Self { texels_left: MAX_TEXELS, decodes_left: MAX_DECODED }
    }
}

impl Images {
    /// Decodes an image.
    ///
    /// # Errors
    ///
    /// The reason why the image cannot be read.
    pub(super) fn decode(&mut self, bytes: &[u8]) -> Result<Texture, String> {
        if self.decodes_left == 0 {
            return Err("the images of this scene have more than a billion texels".to_owned());
        }
        let texture = decode(bytes)?;
        self.decodes_left = self.decodes_left.saturating_sub(texture.texels().len() as u64);
        Ok(texture)
    }

    /// Adds an image to a scene, unless its means suffice because all texels are equal.
    pub(super) fn add(
        &mut self,
        texture: Texture,
        name: &str,
        builder: &mut SceneBuilder,
        notes: &mut Notes,
    ) -> Image {
        let texels = texture.texels();
        let is_uniform = texels.iter().all(|texel| *texel == texels[0]);
        let uniform_alpha = texels.iter().all(|texel| texel[3] == texels[0][3]);
        let count = texels.len() as u64;
        let (color, alpha) = (texture.mean_color(), texture.mean_alpha());
        let fits = count <= self.texels_left;
        if !is_uniform && !fits {
            notes.name(TOO_MANY, name);
        }
        let texels = (!is_uniform && fits).then(|| {
            self.texels_left -= count;
            builder.add_texture(texture)
        });
        Image { texels, color, alpha, uniform_alpha }
    }
}

/// Image on a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Layer {
    pub(super) image: Image,
    pub(super) wrap: [Wrap; 2],
    /// Index of the coordinate set of its material that it uses.
    pub(super) coordinates: u8,
}

impl Layer {
    /// Creates a layer whose coordinates are those of `place`, which is added to the `sets` of a material if it is new.
    pub(super) fn new<S: PartialEq>(image: Image, wrap: [Wrap; 2], place: S, sets: &mut Vec<S>) -> Self {
        let number = image.texels.map_or(0, |_| {
            sets.iter().position(|set| *set == place).unwrap_or_else(|| {
                sets.push(place);
                sets.len() - 1
            })
        });
        Self { image, wrap, coordinates: number as u8 }
    }

    fn map(&self) -> Option<TextureMap> {
        let texture = self.image.texels?;
        Some(TextureMap { texture, wrap: self.wrap, coordinates: self.coordinates })
    }
}

/// Returns a color times the mean of an image, if there is one, and the map of its variation.
pub(super) fn color(factor: Rgb, layer: Option<&Layer>) -> (Rgb, Option<ColorMap>) {
    let mean = layer.map_or(Rgb::ONE, |layer| layer.image.color);
    let map = layer.and_then(Layer::map).filter(|_| factor != Rgb::ZERO);
    (factor * mean, map.map(|map| ColorMap { map, factor }))
}

/// Returns an opacity times the alpha of an image, if there is one.
pub(super) fn opacity(factor: f64, layer: Option<&Layer>, cutoff: Option<f64>) -> Opacity {
    let plain = |factor| Opacity { factor, map: None, cutoff };
    match layer {
        None => plain(factor),
        Some(layer) if layer.image.uniform_alpha => plain(factor * layer.image.alpha),
        Some(layer) => match layer.map() {
            Some(map) => Opacity { factor, map: Some(map), cutoff },
            // A mean cannot be compared with a threshold.
            None if cutoff.is_some() => plain(factor),
            None => plain(factor * layer.image.alpha),
        },
    }
}

/// Affine transform of texture coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Placement {
    pub(super) x_axis: DVec2,
    pub(super) y_axis: DVec2,
    pub(super) offset: DVec2,
}

impl Placement {
    #[cfg(feature = "gltf")]
    /// The identity.
    pub(super) const PLAIN: Self = Self { x_axis: DVec2::X, y_axis: DVec2::Y, offset: DVec2::ZERO };

    /// Transforms coordinates.
    pub(super) fn apply(&self, place: Vec2) -> Vec2 {
        let place = place.as_dvec2();
        (place.x * self.x_axis + place.y * self.y_axis + self.offset).as_vec2()
    }
}

/// Decodes a PNG or JPEG image, whose values are read as 8-bit sRGB.
///
/// The decoder may use 512 MiB. An image with more pixels than a file of this size can have is not decoded.
///
/// # Errors
///
/// The reason why the image cannot be read.
fn decode(bytes: &[u8]) -> Result<Texture, String> {
    let reader = || ImageReader::new(Cursor::new(bytes)).with_guessed_format().map_err(|e| e.to_string());
    let (width, height) = reader()?.into_dimensions().map_err(|e| reason(&e))?;
    let pixels = u64::from(width) * u64::from(height);
    if pixels > FREE_PIXELS.max(MAX_PIXELS_PER_BYTE.saturating_mul(bytes.len() as u64)) {
        return Err(format!("its {} bytes cannot have {width} × {height} pixels", bytes.len()));
    }
    let mut reader = reader()?;
    let mut limits = Limits::default();
    limits.max_alloc = Some(MAX_MEMORY);
    reader.limits(limits);
    let pixels = reader.decode().map_err(|e| reason(&e))?.into_rgba8();
    let (texels, _) = pixels.as_chunks::<4>();
    Texture::new(width, height, texels.to_vec()).ok_or_else(|| "the image has no pixels".to_owned())
}

/// Returns the reason why an image cannot be decoded.
fn reason(error: &ImageError) -> String {
    match error {
        ImageError::Unsupported(_) => "it is neither a PNG nor a JPEG image".to_owned(),
        ImageError::Limits(_) => "it needs more than 512 MiB".to_owned(),
        other => other.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::{ImageFormat, Rgba, RgbaImage};

    fn png(image: &RgbaImage) -> Vec<u8> {
        let mut bytes = Cursor::new(Vec::new());
        image.write_to(&mut bytes, ImageFormat::Png).unwrap();
        bytes.into_inner()
    }

    #[test]
    fn images_are_read_as_they_are() {
        let image = RgbaImage::from_fn(4, 2, |x, y| Rgba([x as u8, y as u8, 128, 255 - x as u8]));
        let texture = decode(&png(&image)).unwrap();
        assert_eq!(texture.size(), [4, 2]);
        assert_eq!(texture.texels()[6], [2, 1, 128, 253]);
    }

    #[test]
    fn broken_images_are_errors() {
        let whole = png(&RgbaImage::from_pixel(64, 64, Rgba([1, 2, 3, 4])));
        for bytes in [&b""[..], b"no image", &whole[..whole.len() / 2], &whole[..20]] {
            assert!(decode(bytes).is_err());
        }
    }

    /// Returns an image of two columns: black and transparent, white and opaque.
    fn halves() -> Vec<u8> {
        png(&RgbaImage::from_fn(2, 3, |x, _| Rgba([255 * x as u8, 0, 0, 255 * x as u8])))
    }

    #[test]
    fn images_without_room_are_means() {
        let (mut builder, mut notes) = (SceneBuilder::new(), Notes::default());
        let mut images = Images { texels_left: 10, decodes_left: 13 };
        let mut found = Vec::new();
        for _ in 0..3 {
            let texture = images.decode(&halves()).unwrap();
            found.push(images.add(texture, "halves", &mut builder, &mut notes));
        }
        assert_eq!(found[0].texels, Some(TextureId::new(0)));
        assert_eq!((found[1].texels, found[1].color, found[1].alpha), (None, Rgb::X / 2.0, 0.5));
        assert!(images.decode(&halves()).unwrap_err().contains("billion"));
        // Without its mask the surface is solid, because a comparison of the mean alpha with the threshold is
        // meaningless.
        let layer = Layer { image: found[1], wrap: [Wrap::Repeat; 2], coordinates: 0 };
        assert_eq!(opacity(0.5, Some(&layer), Some(0.4)).factor, 0.5);
        assert_eq!(opacity(0.5, Some(&layer), None).factor, 0.25);
        assert_eq!(color(Rgb::ONE, Some(&layer)), (Rgb::X / 2.0, None));
    }

    #[test]
    fn images_of_one_color_need_no_texels() {
        let (mut builder, mut notes) = (SceneBuilder::new(), Notes::default());
        let mut images = Images::default();
        let texture = images.decode(&png(&RgbaImage::from_pixel(64, 64, Rgba([255, 0, 0, 51])))).unwrap();
        let image = images.add(texture, "", &mut builder, &mut notes);
        let mut sets = Vec::new();
        let layer = Layer::new(image, [Wrap::Repeat; 2], (), &mut sets);
        assert_eq!(color(Rgb::splat(0.5), Some(&layer)), (Rgb::X / 2.0, None));
        assert_eq!(opacity(0.5, Some(&layer), None), Opacity { factor: 0.1, ..Opacity::default() });
        assert!(sets.is_empty() && images.texels_left == MAX_TEXELS);
    }
}
