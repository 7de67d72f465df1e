//! Pages as 8-bit images.

use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder};
use sir_view::srgb;

/// Share of the lit texels whose light may exceed the scale of an 8-bit image.
const CLIPPED: f64 = 1e-3;

/// Returns the light that an 8-bit image shows as one: that of the brightest band of nearly all covered texels.
pub(crate) fn scale(light: &[[f32; 3]], is_covered: impl Fn(usize) -> bool) -> f64 {
    let peak = |color: &[f32; 3]| color[0].max(color[1]).max(color[2]);
    let mut peaks: Vec<f32> =
        light.iter().enumerate().filter(|(i, _)| is_covered(*i)).map(|(_, color)| peak(color)).collect();
    if peaks.is_empty() {
        return 1.0;
    }
    let rank = ((peaks.len() as f64) * (1.0 - CLIPPED)) as usize;
    let rank = rank.min(peaks.len() - 1);
    let (_, &mut chosen, _) = peaks.select_nth_unstable_by(rank, f32::total_cmp);
    if chosen > 0.0 { f64::from(chosen) } else { 1.0 }
}

/// Returns a page as PNG in sRGB: `light / scale`, clipped to `[0, 1]`.
pub(crate) fn png_srgb(light: &[[f32; 3]], scale: f64, [width, height]: [u32; 2]) -> Vec<u8> {
    let code = |x: f32| (255.0 * srgb(f64::from(x) / scale) + 0.5) as u8;
    let bytes: Vec<u8> = light.iter().flatten().map(|&x| code(x)).collect();
    png(&bytes, width, height, ExtendedColorType::Rgb8)
}

/// Returns a page as PNG with a shared multiplier in alpha: `light = scale · (rgb · alpha)²`, with all values in `[0, 1]`.
pub(crate) fn png_rgbm(light: &[[f32; 3]], scale: f64, [width, height]: [u32; 2]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(4 * light.len());
    for color in light {
        let roots = color.map(|x| (f64::from(x) / scale).clamp(0.0, 1.0).sqrt());
        let peak = roots[0].max(roots[1]).max(roots[2]);
        // Rounded up, so that no color exceeds one.
        let multiplier = (255.0 * peak).ceil().clamp(1.0, 255.0);
        bytes.extend(roots.map(|x| (255.0 * x * 255.0 / multiplier + 0.5).min(255.0) as u8));
        bytes.push(multiplier as u8);
    }
    png(&bytes, width, height, ExtendedColorType::Rgba8)
}

/// Returns colors in sRGB with alpha as PNG.
pub(crate) fn png_rgba(colors: &[[u8; 4]], [width, height]: [u32; 2]) -> Vec<u8> {
    png(colors.as_flattened(), width, height, ExtendedColorType::Rgba8)
}

fn png(bytes: &[u8], width: u32, height: u32, color: ExtendedColorType) -> Vec<u8> {
    let mut file = Vec::new();
    // Writing to memory cannot fail, and the size is that of the page.
    let _ = PngEncoder::new(&mut file).write_image(bytes, width, height, color);
    file
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shared_multiplier_keeps_dark_colors() {
        let light: Vec<[f32; 3]> =
            (0..64u8).map(|i| [1.0, 0.3, 0.05].map(|x: f32| x * 0.83f32.powi(i.into()))).collect();
        let read = image::load_from_memory(&png_rgbm(&light, 2.0, [8, 8])).unwrap().to_rgba8();
        for (pixel, color) in read.pixels().zip(&light) {
            let [r, g, b, m] = pixel.0.map(|x| f64::from(x) / 255.0);
            for (code, &x) in [r, g, b].iter().zip(color) {
                let decoded = 2.0 * (code * m).powi(2);
                assert!((decoded - f64::from(x)).abs() < 0.02 * f64::from(color[0]) + 2e-5, "{decoded} {x}");
            }
        }
    }

    #[test]
    fn the_scale_leaves_out_a_thousandth() {
        let mut light = vec![[1.0, 2.0, 0.5]; 10_000];
        light[..9].fill([1e6; 3]);
        light[9_000..].fill([f32::MAX; 3]);
        assert_eq!(scale(&light, |i| i < 9_000), 1e6, "nine of nine thousand are kept");
        assert_eq!(scale(&light, |i| (100..9_000).contains(&i)), 2.0);
        assert_eq!(scale(&light, |_| false), 1.0);
        let read = image::load_from_memory(&png_srgb(&[[0.5, 1.0, 4.0]], 2.0, [1, 1])).unwrap().to_rgb8();
        assert_eq!(read.get_pixel(0, 0).0, [137, 188, 255]);
    }
}
