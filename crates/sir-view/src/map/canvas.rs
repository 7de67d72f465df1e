//! Drawing of rectangles and text.

use std::io;
use std::path::Path;

use ab_glyph::{Font, FontRef, InvalidFont, PxScale, ScaleFont, point};
use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder, Rgb, RgbImage};

use crate::atomic_file::write_atomically;
use crate::error::ViewError;

pub(super) const WHITE: Rgb<u8> = Rgb([255, 255, 255]);
pub(super) const INK: Rgb<u8> = Rgb([40, 40, 40]);

/// Color where there is no value.
pub(super) const NO_VALUE: Rgb<u8> = Rgb([225, 225, 225]);
/// Size of a title \[pixels\].
pub(super) const TITLE_SIZE: f32 = 25.0;

/// Reference point of a text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Anchor {
    /// Left end.
    Start,
    /// Middle.
    Middle,
    /// Right end.
    End,
}

/// Image to draw on, initially white.
pub(super) struct Canvas {
    pub(super) image: RgbImage,
    font: FontRef<'static>,
}

impl Canvas {
    pub(super) fn new(width: u32, height: u32) -> Result<Self, InvalidFont> {
        let font = FontRef::try_from_slice(epaint_default_fonts::UBUNTU_LIGHT)?;
        Ok(Self { image: RgbImage::from_pixel(width, height, WHITE), font })
    }

    /// Writes the image as PNG.
    pub(super) fn save(&self, path: &Path) -> Result<(), ViewError> {
        let image = &self.image;
        write_atomically(path, |file| {
            PngEncoder::new(file)
                .write_image(image, image.width(), image.height(), ExtendedColorType::Rgb8)
                .map_err(io::Error::other)
        })
    }

    /// Fills the pixels from `x.start` to before `x.end`, and likewise in `y`.
    pub(super) fn fill(&mut self, x: std::ops::Range<u32>, y: std::ops::Range<u32>, color: Rgb<u8>) {
        for y in y.start..y.end.min(self.image.height()) {
            for x in x.start..x.end.min(self.image.width()) {
                self.image.put_pixel(x, y, color);
            }
        }
    }

    /// Draws the outline of a rectangle, one pixel wide and outside of it.
    pub(super) fn frame(&mut self, x: std::ops::Range<u32>, y: std::ops::Range<u32>) {
        let (outer_x, outer_y) = (x.start.saturating_sub(1)..x.end + 1, y.start.saturating_sub(1)..y.end + 1);
        for row in [outer_y.start, y.end] {
            self.fill(outer_x.clone(), row..row + 1, INK);
        }
        for column in [outer_x.start, x.end] {
            self.fill(column..column + 1, outer_y.clone(), INK);
        }
    }

    /// Returns the width of a text in pixels.
    pub(super) fn width(&self, text: &str, size: f32) -> f32 {
        let font = self.font.as_scaled(PxScale::from(size));
        text.chars().map(|c| font.h_advance(font.glyph_id(c))).sum()
    }

    /// Draws a line of text in ink, vertically centered at `y`.
    pub(super) fn write(&mut self, text: &str, place: (f32, f32), anchor: Anchor, size: f32) {
        self.write_in(text, place, anchor, size, INK);
    }

    /// Draws a line of text in a color.
    pub(super) fn write_in(
        &mut self,
        text: &str,
        (x, y): (f32, f32),
        anchor: Anchor,
        size: f32,
        color: Rgb<u8>,
    ) {
        let mut x = match anchor {
            Anchor::Start => x,
            Anchor::Middle => x - 0.5 * self.width(text, size),
            Anchor::End => x - self.width(text, size),
        };
        let font = self.font.as_scaled(PxScale::from(size));
        // Digits are about two thirds of the size high.
        let baseline = y + size / 3.0;
        for c in text.chars() {
            let mut glyph = font.scaled_glyph(c);
            glyph.position = point(x, baseline);
            x += font.h_advance(glyph.id);
            let Some(outline) = font.outline_glyph(glyph) else { continue };
            let corner = outline.px_bounds().min;
            let image = &mut self.image;
            outline.draw(|dx, dy, coverage| {
                let (x, y) = (corner.x as i64 + i64::from(dx), corner.y as i64 + i64::from(dy));
                let place = u32::try_from(x).ok().zip(u32::try_from(y).ok());
                if let Some(pixel) = place.and_then(|(x, y)| image.get_pixel_mut_checked(x, y)) {
                    // Thin strokes look pale, so their coverage is increased.
                    blend(pixel, 1.3 * coverage, color);
                }
            });
        }
    }
}

/// Covers a share of a pixel with a color.
pub(super) fn blend(pixel: &mut Rgb<u8>, coverage: f32, color: Rgb<u8>) {
    let share = coverage.clamp(0.0, 1.0);
    for (band, ink) in pixel.0.iter_mut().zip(color.0) {
        *band = (f32::from(*band) + share * (f32::from(ink) - f32::from(*band))).round() as u8;
    }
}
