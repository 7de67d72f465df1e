//! Lines with marks, and their legend.

use plotters::coord::Shift;
use plotters::drawing::DrawingAreaErrorKind;
use plotters::element::DashedPathElement;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use crate::scaling::series::{Kind, Stage};

/// Drawing area.
pub(crate) type Canvas<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// Error of drawing.
pub(crate) type Failure = DrawingAreaErrorKind<std::io::Error>;

/// Position in pixels from the upper left corner of the drawing.
pub(crate) type Pixel = (i32, i32);

/// Color of the ideal lines and of the line at the number of cores.
pub(crate) const GRAY: RGBColor = RGBColor(150, 150, 150);

/// Color of text and axes.
pub(crate) const INK: RGBColor = RGBColor(50, 50, 50);

/// Height of a row of the legend, in pixels.
pub(crate) const ROW: i32 = 24;

/// Width of a column of the legend, in pixels.
const COLUMN: i32 = 110;

/// Half the length of the lines in the legend, in pixels.
const SAMPLE: i32 = 24;

/// Draws the line that joins the points of a series.
pub(crate) fn draw_line(
    canvas: &Canvas<'_>,
    points: &[Pixel],
    kind: &Kind,
    stage: &Stage,
) -> Result<(), Failure> {
    let style = stage.color.stroke_width(stage.width);
    if kind.dashed {
        canvas.draw(&DashedPathElement::new(points.iter().copied(), 7, 4, style))
    } else {
        canvas.draw(&PathElement::new(points.to_vec(), style))
    }
}

/// Draws a mark. Marks of ranks are outlines, so that what is below them stays visible.
pub(crate) fn draw_mark(canvas: &Canvas<'_>, at: Pixel, kind: &Kind, stage: &Stage) -> Result<(), Failure> {
    if kind.mark.is_empty() {
        return canvas.draw(&Circle::new(at, 3 + stage.width as i32 / 2, stage.color.filled()));
    }
    // Repeats the first two corners: the first closes the outline, the second joins its ends.
    let corners = kind.mark.iter().chain(kind.mark.iter().take(2)).map(|(x, y)| (at.0 + x, at.1 + y));
    canvas.draw(&PathElement::new(corners.collect::<Vec<_>>(), stage.color.stroke_width(2)))
}

/// Draws a text whose center or left end is at a position.
pub(crate) fn write(
    canvas: &Canvas<'_>,
    text: &str,
    at: Pixel,
    centered: bool,
    size: i32,
    color: RGBColor,
) -> Result<(), Failure> {
    let style = TextStyle::from(("sans-serif", size).into_font()).color(&color);
    let anchor = if centered { HPos::Center } else { HPos::Left };
    canvas.draw(&Text::new(text.to_owned(), at, style.pos(Pos::new(anchor, VPos::Center))))
}

/// Draws the legend, centered below `top`: a column for each stage, a row for each kind of workers.
pub(crate) fn draw_legend(
    canvas: &Canvas<'_>,
    top: i32,
    stages: &[Stage],
    kinds: &[Kind],
) -> Result<(), Failure> {
    let letters = kinds.iter().map(|kind| kind.label.len() as i32).max().unwrap_or(0);
    // After the names of the kinds, there is a column for each stage and one for the ideal.
    let names = 7 * letters + 20;
    let width = names + COLUMN * (stages.len() as i32 + 1);
    let left = (canvas.dim_in_pixel().0 as i32 - width) / 2;
    let column = |i: usize| left + names + COLUMN * i as i32 + COLUMN / 2;
    let row = |i: usize| top + ROW * i as i32 + ROW / 2;
    for (i, stage) in stages.iter().enumerate() {
        write(canvas, stage.name, (column(i), row(0)), true, 16, stage.color)?;
        for (j, kind) in kinds.iter().enumerate() {
            let (x, y) = (column(i), row(j + 1));
            draw_line(canvas, &[(x - SAMPLE, y), (x + SAMPLE, y)], kind, stage)?;
            draw_mark(canvas, (x, y), kind, stage)?;
        }
    }
    for (j, kind) in kinds.iter().enumerate() {
        write(canvas, &kind.label, (left, row(j + 1)), false, 16, INK)?;
    }
    let (x, y) = (column(stages.len()), row(1));
    write(canvas, "ideal", (x, row(0)), true, 16, GRAY)?;
    canvas.draw(&PathElement::new(vec![(x - SAMPLE, y), (x + SAMPLE, y)], GRAY.stroke_width(1)))
}
