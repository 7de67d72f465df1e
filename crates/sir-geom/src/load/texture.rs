//! Decoding images.

use std::io::Cursor;

use image::{ImageReader, Limits};

use crate::Texture;

/// The kind of warning about textures whose mean is not known.
pub(super) const UNREADABLE: &str = "textures cannot be read, and their colour factor alone is used";

/// The most memory for a decoded image, in bytes.
const MAX_MEMORY: u64 = 512 << 20;

/// The most bytes of pixels that a byte of a file can stand for. PNG packs 1,032 into one (the limit of deflate); JPEG needs a
/// bit for each of the six blocks that 256 pixels have at least, which makes 1,024. Sixteen bits per channel may need
/// room for two copies.
const EXPANSION: u64 = 2200;

/// A PNG or JPEG image, its values read as sRGB with 8 bits.
///
/// Decoders may use as much memory as a file of this size can need, 512 MiB at most.
///
/// # Errors
///
/// The message of the decoder.
pub(super) fn decode(bytes: &[u8]) -> Result<Texture, String> {
    let mut reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format().map_err(|e| e.to_string())?;
    let mut limits = Limits::default();
    limits.max_alloc = Some(MAX_MEMORY.min(EXPANSION.saturating_mul(bytes.len() as u64) + (1 << 20)));
    reader.limits(limits);
    let pixels = reader.decode().map_err(|e| e.to_string())?.into_rgba8();
    let (width, height) = pixels.dimensions();
    let (texels, _) = pixels.as_chunks::<4>();
    Texture::new(width, height, texels.to_vec()).ok_or_else(|| "the image has no pixels".to_owned())
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
}
