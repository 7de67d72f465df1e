//! Pictures in false colors, with a scale.

use std::io;
use std::path::Path;

use sir_geom::luminance;

use crate::error::ViewError;
use crate::map::canvas::{Anchor, Canvas, NO_VALUE, TITLE_SIZE};
use crate::map::scale::{MIN_HEIGHT, Scale};
use crate::picture::Picture;
use crate::tone::rgb;

/// How a picture is shown in false colors.
#[derive(Clone, Debug, PartialEq)]
pub struct FalseColors {
    /// Title above the picture.
    pub title: String,
    /// Unit of the values.
    pub unit: String,
    /// Values with the darkest and with the lightest color; `None` for those of the picture.
    pub limits: Option<[f64; 2]>,
    /// True if equal steps of color are equal factors, false if they are equal differences.
    pub is_logarithmic: bool,
    /// True if the sky has a value, false if it is gray.
    pub shows_sky: bool,
}

/// Margins on the left, above, on the right and below \[pixels\].
const MARGIN: [u32; 4] = [20, 60, 140, 20];

/// Share of the pixels that may be brighter than the scale. Most are lamps.
const ABOVE: f64 = 0.01;

/// Share of the pixels that may be darker than a logarithmic scale.
const BELOW: f64 = 0.005;

/// Largest ratio of the ends of a logarithmic scale.
const MOST_DECADES: f64 = 1e5;

/// Writes the luminance of a picture as PNG in false colors. The picture has a margin with a title and a scale. Values
/// beyond the scale have the color of its end.
///
/// Without limits, a linear scale goes from 0 to the value that a hundredth of the pixels exceed. A logarithmic scale goes
/// to the largest value, over at most five powers of ten.
///
/// # Errors
///
/// If the file cannot be written.
pub fn write_false_colors(path: &Path, picture: &Picture, colors: &FalseColors) -> Result<(), ViewError> {
    let canvas = draw(picture, colors).map_err(|error| ViewError::writing(path)(io::Error::other(error)))?;
    canvas.save(path)
}

fn draw(picture: &Picture, colors: &FalseColors) -> Result<Canvas, ab_glyph::InvalidFont> {
    let values = values(picture, colors.shows_sky);
    let scale = scale(&values, colors);
    let Picture { width, height, .. } = *picture;
    let [left, above, right, below] = MARGIN;
    let title_width = Canvas::new(1, 1)?.width(&colors.title, TITLE_SIZE).ceil() as u32;
    let all = (left + width + right).max(title_width + 2 * left);
    let tall = height.max(MIN_HEIGHT);
    let mut canvas = Canvas::new(all, above + tall + below)?;
    canvas.write(&colors.title, (left as f32, 24.0), Anchor::Start, TITLE_SIZE);
    for (place, value) in (0..).zip(&values) {
        let (x, y) = (left + place % width, above + place / width);
        canvas.fill(x..x + 1, y..y + 1, value.map_or(NO_VALUE, |value| scale.color(value)));
    }
    canvas.frame(left..left + width, above..above + height);
    scale.draw(&mut canvas, [left + width + 28, above], tall, &colors.unit);
    Ok(canvas)
}

/// Returns the luminance of each pixel: the mean over its rays. If the sky has no value, it is that over the rays that met a
/// surface, at least half of them.
fn values(picture: &Picture, shows_sky: bool) -> Vec<Option<f64>> {
    let pixels = picture.radiance.iter().zip(&picture.surface);
    let value = |(pixel, &surface): (&[f32; 3], &f32)| match (shows_sky, surface >= 0.5) {
        (true, _) => Some(luminance(rgb(pixel))),
        (false, true) => Some(luminance(rgb(pixel)) / f64::from(surface)),
        (false, false) => None,
    };
    pixels.map(value).map(|value| value.filter(|value| value.is_finite())).collect()
}

fn scale(values: &[Option<f64>], colors: &FalseColors) -> Scale {
    let is_logarithmic = colors.is_logarithmic;
    if let Some([low, high]) = colors.limits {
        return Scale { low, high, is_logarithmic };
    }
    let mut sorted: Vec<f64> = values.iter().flatten().copied().filter(|value| *value > 0.0).collect();
    sorted.sort_by(f64::total_cmp);
    let at = |share: f64| {
        let place = (share * sorted.len() as f64) as usize;
        sorted.get(place.min(sorted.len().saturating_sub(1))).copied().unwrap_or(1.0)
    };
    if !is_logarithmic {
        return Scale { low: 0.0, high: at(1.0 - ABOVE), is_logarithmic };
    }
    let high = at(1.0);
    // A scale has at least a factor of two.
    let low = at(BELOW).max(high / MOST_DECADES).min(0.5 * high);
    Scale { low, high, is_logarithmic }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::colors::viridis;

    fn picture(values: &[f32], surface: Vec<f32>) -> Picture {
        let radiance: Vec<[f32; 3]> = values.iter().map(|&value| [value; 3]).collect();
        Picture { width: values.len() as u32, height: 1, shown: radiance.clone(), radiance, surface }
    }

    fn colors(limits: Option<[f64; 2]>, is_logarithmic: bool, shows_sky: bool) -> FalseColors {
        FalseColors { title: "view".into(), unit: "cd/m²".into(), limits, is_logarithmic, shows_sky }
    }

    #[test]
    fn pixels_have_the_colors_of_their_values() {
        let picture = picture(&[0.0, 1.0, 10.0, 100.0, 2000.0], vec![1.0; 5]);
        let drawn = draw(&picture, &colors(Some([1.0, 100.0]), true, true)).unwrap();
        let found = [0, 1, 2, 3, 4].map(|x| *drawn.image.get_pixel(MARGIN[0] + x, MARGIN[1]));
        assert_eq!(found, [0.0, 0.0, 0.5, 1.0, 1.0].map(viridis));
    }

    #[test]
    fn scales_cover_the_values_except_for_lamps() {
        let mut values = vec![Some(5.0); 1000];
        values[0] = Some(1000.0);
        values[1] = Some(0.0);
        values[2] = None;
        let linear = scale(&values, &colors(None, false, true));
        assert_eq!((linear.low, linear.high), (0.0, 5.0));
        let logarithmic = scale(&values, &colors(None, true, true));
        assert_eq!((logarithmic.low, logarithmic.high), (5.0, 1000.0));
        let none = scale(&[None], &colors(None, true, true));
        assert!(none.low < none.high);
    }

    #[test]
    fn surfaces_without_the_sky_behind_them_have_their_own_mean() {
        let picture = picture(&[0.0, 2.0, 4.0], vec![0.0, 0.5, 1.0]);
        assert_eq!(values(&picture, false), [None, Some(4.0), Some(4.0)]);
        assert_eq!(values(&picture, true)[1], Some(2.0));
    }
}
