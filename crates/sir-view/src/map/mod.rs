//! Maps: grids of values in false colors, with a scale.

mod canvas;
mod colors;

use std::io;
use std::path::Path;

use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder, Rgb};

use crate::atomic_file::write_atomically;
use crate::error::ViewError;
use canvas::{Anchor, Canvas};
use colors::viridis;

/// Values on a grid of equal cells.
#[derive(Clone, Debug, PartialEq)]
pub struct Map {
    /// Title above the map.
    pub title: String,
    /// Subtitle below the title.
    pub subtitle: String,
    /// Unit of the values.
    pub unit: String,
    /// Number of cells in a row, at least one.
    pub columns: usize,
    /// Width and height of all cells together \[m\].
    pub size: [f64; 2],
    /// Value of each cell, row by row from the bottom, each from the left; `None` for a cell without a value.
    pub values: Vec<Option<f64>>,
}

/// Largest width and height of the grid \[pixels\].
const MAX_SIZE: [f64; 2] = [960.0, 720.0];
/// Smallest width and height of the grid, however narrow it is \[pixels\].
const MIN_SIZE: f64 = 40.0;
/// Margins on the left, above, on the right and below \[pixels\].
const MARGIN: [u32; 4] = [64, 104, 140, 60];
/// Smallest width of the whole picture, for its title \[pixels\].
const MIN_WIDTH: u32 = 620;
/// Width of the scale \[pixels\].
const SCALE_WIDTH: u32 = 22;
/// Size of small text \[pixels\].
const TEXT_SIZE: f32 = 17.0;
/// Color of a cell without a value.
const NO_VALUE: Rgb<u8> = Rgb([225, 225, 225]);

/// Writes a map as PNG. Cells without a value are gray.
///
/// # Errors
///
/// If the file cannot be written.
pub fn write_map(path: &Path, map: &Map) -> Result<(), ViewError> {
    let canvas = draw(map).map_err(|error| ViewError::writing(path)(io::Error::other(error)))?;
    let image = canvas.image;
    write_atomically(path, |file| {
        PngEncoder::new(file)
            .write_image(&image, image.width(), image.height(), ExtendedColorType::Rgb8)
            .map_err(io::Error::other)
    })
}

fn draw(map: &Map) -> Result<Canvas, ab_glyph::InvalidFont> {
    let rows = map.values.len().div_ceil(map.columns.max(1)).max(1);
    let columns = map.columns.max(1);
    let [width, height] = extent(map.size);
    let [left, above, right, below] = MARGIN;
    let left = left + MIN_WIDTH.saturating_sub(left + width + right) / 2;
    let mut canvas = Canvas::new((left + width + right).max(MIN_WIDTH), above + height + below)?;
    let middle = canvas.image.width() as f32 / 2.0;
    canvas.write(&map.title, (middle, 28.0), Anchor::Middle, 25.0);
    canvas.write(&map.subtitle, (middle, 56.0), Anchor::Middle, TEXT_SIZE);

    let (least, most) = range(&map.values);
    let color = |value: f64| viridis((value - least) / (most - least));
    let place = |i: usize, n: usize, length: u32| (i as f64 / n as f64 * f64::from(length)).round() as u32;
    for (cell, value) in map.values.iter().enumerate() {
        let (column, row) = (cell % columns, rows - 1 - cell / columns);
        let x = left + place(column, columns, width)..left + place(column + 1, columns, width);
        let y = above + place(row, rows, height)..above + place(row + 1, rows, height);
        canvas.fill(x, y, value.map_or(NO_VALUE, color));
    }
    canvas.frame(left..left + width, above..above + height);
    draw_axes(&mut canvas, map.size, [left, above], [width, height]);

    let bar = left + width + 28;
    let height = height.max(120);
    for y in 0..height {
        let t = 1.0 - (f64::from(y) + 0.5) / f64::from(height);
        canvas.fill(bar..bar + SCALE_WIDTH, above + y..above + y + 1, viridis(t));
    }
    canvas.frame(bar..bar + SCALE_WIDTH, above..above + height);
    let step = step((most - least) / (f64::from(height) / 50.0).clamp(2.0, 10.0));
    for value in multiples(step, least, most) {
        let y = above as f32 + ((most - value) / (most - least) * f64::from(height)) as f32;
        canvas.fill(bar + SCALE_WIDTH..bar + SCALE_WIDTH + 6, y as u32..y as u32 + 1, canvas::INK);
        canvas.write(&number(value, step), ((bar + SCALE_WIDTH + 11) as f32, y), Anchor::Start, TEXT_SIZE);
    }
    canvas.write(&map.unit, (bar as f32, above as f32 - 18.0), Anchor::Start, TEXT_SIZE);
    Ok(canvas)
}

/// Returns the width and height of the grid in pixels: to scale, unless it is very narrow.
fn extent(size: [f64; 2]) -> [u32; 2] {
    let scale = (MAX_SIZE[0] / size[0]).min(MAX_SIZE[1] / size[1]);
    size.map(|length| (length * scale).round().max(MIN_SIZE) as u32)
}

/// Draws axes in meters along the edges, from the lower left corner.
fn draw_axes(canvas: &mut Canvas, size: [f64; 2], [left, above]: [u32; 2], [width, height]: [u32; 2]) {
    let bottom = above + height;
    let steps = [width, height].map(|pixels| f64::from(pixels) / 70.0);
    let step = step((size[0] / steps[0]).max(size[1] / steps[1]));
    for meters in multiples(step, 0.0, size[0]) {
        let x = left + (meters / size[0] * f64::from(width)).round() as u32;
        canvas.fill(x..x + 1, bottom..bottom + 6, canvas::INK);
        canvas.write(&number(meters, step), (x as f32, bottom as f32 + 17.0), Anchor::Middle, TEXT_SIZE);
    }
    for meters in multiples(step, 0.0, size[1]) {
        let y = bottom - (meters / size[1] * f64::from(height)).round() as u32;
        canvas.fill(left - 6..left, y..y + 1, canvas::INK);
        canvas.write(&number(meters, step), (left as f32 - 10.0, y as f32), Anchor::End, TEXT_SIZE);
    }
    canvas.write("m", ((left + width / 2) as f32, bottom as f32 + 40.0), Anchor::Middle, TEXT_SIZE);
}

/// Returns the ends of the scale. It begins at 0, unless values are negative or differ by no more than half of the
/// largest.
fn range(values: &[Option<f64>]) -> (f64, f64) {
    let known = values.iter().flatten().copied().filter(|value| value.is_finite());
    let (least, most) =
        known.fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), x| (least.min(x), most.max(x)));
    match (least, most) {
        _ if least > most => (0.0, 1.0),
        _ if most > 0.0 && least >= 0.0 && least < 0.5 * most => (0.0, most),
        // Equal values: a scale around them.
        _ if most - least <= 1e-9 * most.abs() => {
            (least - 0.5 * least.abs().max(1e-9), most + 0.5 * most.abs().max(1e-9))
        }
        _ => (least, most),
    }
}

/// Returns the smallest of 1, 2 and 5 times a power of ten that is at least `least`.
fn step(least: f64) -> f64 {
    let power = 10f64.powf(least.max(f64::MIN_POSITIVE).log10().floor());
    [1.0, 2.0, 5.0]
        .map(|factor| factor * power)
        .into_iter()
        .find(|step| *step >= least)
        .unwrap_or(10.0 * power)
}

/// Returns the multiples of `step` from `first` to `last`.
fn multiples(step: f64, first: f64, last: f64) -> impl Iterator<Item = f64> {
    let start = (first / step - 1e-9).ceil();
    (0..100).map(move |i| (start + f64::from(i)) * step).take_while(move |x| *x <= last + 1e-9 * step)
}

/// Formats a multiple of `step` with the number of decimals that it needs.
fn number(x: f64, step: f64) -> String {
    let decimals = (-step.log10().floor()).clamp(0.0, 12.0) as usize;
    if x.abs() >= 1e7 || decimals > 6 { format!("{x:.1e}") } else { format!("{x:.decimals$}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map(columns: usize, size: [f64; 2], values: Vec<Option<f64>>) -> Map {
        let text = |text: &str| text.to_owned();
        Map { title: text("desk"), subtitle: text("mean 2"), unit: text("lx"), columns, size, values }
    }

    #[test]
    fn cells_have_the_colors_of_their_values_with_the_first_row_below() {
        let drawn = draw(&map(2, [2.0, 2.0], vec![Some(0.0), None, Some(50.0), Some(100.0)])).unwrap();
        let [width, height] = extent([2.0, 2.0]);
        let at = |x: f64, y: f64| {
            let (x, y) = ((x * f64::from(width)) as u32, ((1.0 - y) * f64::from(height)) as u32);
            *drawn.image.get_pixel(MARGIN[0] + x, MARGIN[1] + y)
        };
        assert_eq!(at(0.25, 0.25), viridis(0.0));
        assert_eq!(at(0.75, 0.25), NO_VALUE);
        assert_eq!(at(0.25, 0.75), viridis(0.5));
        assert_eq!(at(0.75, 0.75), viridis(1.0));
    }

    #[test]
    fn strange_maps_are_drawn_too() {
        for (columns, size, values) in [
            (1, [1e-3, 50.0], vec![Some(3.0); 5]),
            (3, [1e6, 1.0], vec![None, Some(f64::NAN), Some(-1.0)]),
            (0, [1.0, 1.0], Vec::new()),
            (1, [1.0, 1.0], vec![Some(0.0)]),
        ] {
            let drawn = draw(&map(columns, size, values)).unwrap();
            assert!(
                drawn.image.width() >= MIN_WIDTH && drawn.image.width() < 1300,
                "{}",
                drawn.image.width()
            );
        }
    }

    #[test]
    fn labels_are_round_numbers() {
        assert_eq!([0.3, 1.0, 1.1, 47.0, 60.0].map(step), [0.5, 1.0, 2.0, 50.0, 100.0]);
        let labels: Vec<String> = multiples(0.5, 0.7, 2.0).map(|x| number(x, 0.5)).collect();
        assert_eq!(labels, ["1.0", "1.5", "2.0"]);
        assert_eq!(number(1500.0, 500.0), "1500");
    }
}
