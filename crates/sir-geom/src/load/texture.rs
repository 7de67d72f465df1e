//! The one thing that a texture is asked for: its mean colour.

use std::io::Cursor;

use image::{DynamicImage, ImageReader, Limits};

use crate::Rgb;

/// The kind of warning about textures whose mean is not known.
pub(super) const UNREADABLE: &str = "textures cannot be read, and their colour factor alone is used";

/// The most memory for a decoded image, in bytes.
const MAX_MEMORY: u64 = 512 << 20;

/// The most bytes of pixels that a byte of a file can stand for. PNG packs 1,032 into one (the limit of deflate); JPEG needs a
/// bit for each of the six blocks that 256 pixels have at least, which makes 1,024. Sixteen bits per channel may need
/// room for two copies.
const EXPANSION: u64 = 2200;

/// The mean linear colour of a PNG or JPEG image, its 8-bit values read as sRGB and its alpha ignored.
///
/// Decoders may use as much memory as a file of this size can need, 512 MiB at most.
///
/// # Errors
///
/// The message of the decoder.
pub(super) fn mean_colour(bytes: &[u8]) -> Result<Rgb, String> {
    let mut reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format().map_err(|e| e.to_string())?;
    let mut limits = Limits::default();
    limits.max_alloc = Some(MAX_MEMORY.min(EXPANSION.saturating_mul(bytes.len() as u64) + (1 << 20)));
    reader.limits(limits);
    let pixels = match reader.decode().map_err(|e| e.to_string())? {
        DynamicImage::ImageRgb8(pixels) => pixels,
        other => other.into_rgb8(),
    };
    // Whole numbers add up to the same sum in any order.
    let mut histogram = [[0u64; 3]; 256];
    for pixel in pixels.pixels() {
        for (channel, &value) in pixel.0.iter().enumerate() {
            histogram[usize::from(value)][channel] += 1;
        }
    }
    let count = pixels.pixels().len() as f64;
    if count == 0.0 {
        return Err("the image has no pixels".to_owned());
    }
    let mut sum = Rgb::ZERO;
    for (value, counts) in (0u8..=255).zip(histogram) {
        sum += srgb_to_linear(value) * Rgb::from_array(counts.map(|n| n as f64));
    }
    Ok(sum / count)
}

/// Decodes an 8-bit value of sRGB (IEC 61966-2-1).
fn srgb_to_linear(value: u8) -> f64 {
    let s = f64::from(value) / 255.0;
    if s <= 0.04045 {
        return s / 12.92;
    }
    let x = (s + 0.055) / 1.055;
    x * x * fifth_root(x * x)
}

/// The fifth root of a number in `(0, 1]` by Newton's iteration.
///
/// `powf` may differ in the last bits from one machine to another, and reflectances decide tallies.
fn fifth_root(x: f64) -> f64 {
    let mut root = 1.0;
    // From above, the iterates fall until rounding stops them.
    loop {
        let next = (4.0 * root + x / (root * root * root * root)) / 5.0;
        if next >= root {
            return root;
        }
        root = next;
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
    fn srgb_agrees_with_its_formula() {
        for value in 0..=255u8 {
            let s = f64::from(value) / 255.0;
            let expected = if s <= 0.04045 { s / 12.92 } else { ((s + 0.055) / 1.055).powf(2.4) };
            assert!((srgb_to_linear(value) - expected).abs() < 1e-14, "{value}");
        }
    }

    #[test]
    fn the_mean_is_taken_of_linear_colours() {
        let image =
            RgbaImage::from_fn(4, 2, |x, _| Rgba(if x < 1 { [255, 0, 128, 0] } else { [0, 0, 128, 255] }));
        let mean = mean_colour(&png(&image)).unwrap();
        assert!((mean - Rgb::new(0.25, 0.0, 0.215_860_500_113_899_26)).length() < 1e-14, "{mean}");
    }

    #[test]
    fn broken_images_are_errors() {
        let whole = png(&RgbaImage::from_pixel(64, 64, Rgba([1, 2, 3, 4])));
        for bytes in [&b""[..], b"no image", &whole[..whole.len() / 2], &whole[..20]] {
            assert!(mean_colour(bytes).is_err());
        }
    }
}
