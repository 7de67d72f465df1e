//! PNG pictures, for the screen.

use std::io;
use std::path::Path;

use image::ExtendedColorType;
use image::ImageEncoder;
use image::codecs::png::PngEncoder;

use crate::atomic_file::write_atomically;
use crate::error::ViewError;
use crate::exposure::Exposure;
use crate::picture::Picture;
use crate::tone::{rgb, srgb, tone_map};

/// Writes a picture as PNG: 8-bit sRGB after exposure and tone mapping.
///
/// # Errors
///
/// If the file cannot be written.
pub fn write_png(path: &Path, picture: &Picture, exposure: Exposure) -> Result<(), ViewError> {
    let bytes = encode(picture, exposure.factor_for_picture(picture));
    write_atomically(path, |file| {
        PngEncoder::new(file)
            .write_image(&bytes, picture.width, picture.height, ExtendedColorType::Rgb8)
            .map_err(io::Error::other)
    })
}

fn encode(picture: &Picture, factor: f64) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(3 * picture.shown.len());
    for (i, pixel) in (0..).zip(&picture.shown) {
        let dither = threshold(i % picture.width, i / picture.width);
        let shown = tone_map(factor * rgb(pixel));
        bytes.extend(shown.to_array().map(|band| (255.0 * srgb(band) + dither) as u8));
    }
    bytes
}

/// Returns the dither threshold in `[0, 1)` of a pixel: interleaved gradient noise (Jimenez 2014). It preserves the
/// mean of a slow gradient despite integer levels, so that walls show no banding.
fn threshold(x: u32, y: u32) -> f64 {
    let ramp = 0.067_110_56 * f64::from(x) + 0.005_837_15 * f64::from(y);
    (52.982_918_9 * ramp.fract()).fract()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_png_is_read_back_with_the_right_values() {
        let shown = (0..64 * 64).map(|i| [0.1, if i < 2048 { 0.0 } else { 1e6 }, 0.1004]).collect();
        let picture =
            Picture { width: 64, height: 64, radiance: vec![[0.0; 3]; 64 * 64], shown, surface: Vec::new() };
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("a.png");
        write_png(&path, &picture, Exposure::Factor(1.0)).unwrap();
        let read = image::open(&path).unwrap().to_rgb8();
        assert_eq!(read.dimensions(), (64, 64));
        assert_eq!(read.get_pixel(0, 63).0[1], 255);
        let mean = |band: usize| read.pixels().take(2048).map(|p| f64::from(p.0[band])).sum::<f64>() / 2048.0;
        assert_eq!(mean(1), 0.0);
        for (band, linear) in [(0, 0.1), (2, 0.1004)] {
            // Dithering preserves the mean to a small fraction of a level.
            assert!((mean(band) - 255.0 * srgb(linear)).abs() < 0.02, "{}", mean(band));
        }
    }
}
