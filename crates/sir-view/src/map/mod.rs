//! Maps: grids of values in false colors, with contour lines and a scale.

mod canvas;
mod colors;
mod contours;
mod false_colors;
mod scale;
mod strokes;
mod ticks;

use std::io;
use std::path::Path;

use glam::DVec2;

use crate::error::ViewError;
pub use false_colors::{FalseColors, write_false_colors};

use canvas::{Anchor, Canvas, NO_VALUE, TITLE_SIZE};
use contours::{contours, levels};
use scale::{MIN_HEIGHT, Scale, TEXT_SIZE};
use strokes::{Stroke, draw_strokes};
use ticks::{multiples, number, step};

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
/// Space on both sides of a title that is wider than the map \[pixels\].
const TEXT_MARGIN: u32 = 20;

/// Writes a map as PNG. Cells without a value are gray.
///
/// # Errors
///
/// If the file cannot be written.
pub fn write_map(path: &Path, map: &Map) -> Result<(), ViewError> {
    let canvas = draw(map).map_err(|error| ViewError::writing(path)(io::Error::other(error)))?;
    canvas.save(path)
}

fn draw(map: &Map) -> Result<Canvas, ab_glyph::InvalidFont> {
    let rows = map.values.len().div_ceil(map.columns.max(1)).max(1);
    let columns = map.columns.max(1);
    let [width, height] = extent(map.size);
    let [left, above, right, below] = MARGIN;
    // Text may be wider than the map.
    let measure = Canvas::new(1, 1)?;
    let widest = measure.width(&map.title, TITLE_SIZE).max(measure.width(&map.subtitle, TEXT_SIZE));
    let least_width = MIN_WIDTH.max(widest.ceil() as u32 + 2 * TEXT_MARGIN);
    let left = left + least_width.saturating_sub(left + width + right) / 2;
    let mut canvas = Canvas::new((left + width + right).max(least_width), above + height + below)?;
    let middle = canvas.image.width() as f32 / 2.0;
    canvas.write(&map.title, (middle, 28.0), Anchor::Middle, TITLE_SIZE);
    canvas.write(&map.subtitle, (middle, 56.0), Anchor::Middle, TEXT_SIZE);

    let (low, high) = range(&map.values);
    let scale = Scale { low, high, is_logarithmic: false };
    let place = |i: usize, n: usize, length: u32| (i as f64 / n as f64 * f64::from(length)).round() as u32;
    for (cell, value) in map.values.iter().enumerate() {
        let (column, row) = (cell % columns, rows - 1 - cell / columns);
        let x = left + place(column, columns, width)..left + place(column + 1, columns, width);
        let y = above + place(row, rows, height)..above + place(row + 1, rows, height);
        canvas.fill(x, y, value.map_or(NO_VALUE, |value| scale.color(value)));
    }
    draw_contours(&mut canvas, map, [left, above], [width, height]);
    canvas.frame(left..left + width, above..above + height);
    draw_axes(&mut canvas, map.size, [left, above], [width, height]);

    scale.draw(&mut canvas, [left + width + 28, above], height.max(MIN_HEIGHT), &map.unit);
    Ok(canvas)
}

/// Draws contour lines at round values.
fn draw_contours(canvas: &mut Canvas, map: &Map, [left, above]: [u32; 2], [width, height]: [u32; 2]) {
    let columns = map.columns.max(1);
    let rows = map.values.len().div_ceil(columns);
    let known = || map.values.iter().flatten().copied().filter(|value| value.is_finite());
    let (least, most) = (known().fold(f64::INFINITY, f64::min), known().fold(f64::NEG_INFINITY, f64::max));
    let [corner, size] =
        [[left, above + height], [width, height]].map(|[x, y]| DVec2::new(f64::from(x), f64::from(y)));
    let step = size / DVec2::new(columns as f64, rows as f64) * DVec2::new(1.0, -1.0);
    let mut strokes = Vec::new();
    for (level, label) in levels(least, most) {
        let lines = contours(&map.values, columns, level).into_iter();
        strokes.extend(lines.map(|line| Stroke {
            points: line.into_iter().map(|point| corner + point * step).collect(),
            label: label.clone(),
        }));
    }
    draw_strokes(canvas, left..left + width, above..above + height, &strokes);
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

#[cfg(test)]
mod tests {
    use super::*;
    use colors::viridis;

    fn map(columns: usize, size: [f64; 2], values: Vec<Option<f64>>) -> Map {
        let text = |text: &str| text.to_owned();
        Map { title: text("desk"), subtitle: text("mean 2"), unit: text("lx"), columns, size, values }
    }

    #[test]
    fn cells_have_the_colors_of_their_values_with_the_first_row_below() {
        let drawn = draw(&map(2, [2.0, 2.0], vec![Some(0.0), None, Some(45.0), Some(100.0)])).unwrap();
        let [width, height] = extent([2.0, 2.0]);
        let at = |x: f64, y: f64| {
            let (x, y) = ((x * f64::from(width)) as u32, ((1.0 - y) * f64::from(height)) as u32);
            *drawn.image.get_pixel(MARGIN[0] + x, MARGIN[1] + y)
        };
        assert_eq!(at(0.25, 0.25), viridis(0.0));
        assert_eq!(at(0.75, 0.25), NO_VALUE);
        assert_eq!(at(0.25, 0.75), viridis(0.45));
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
}
