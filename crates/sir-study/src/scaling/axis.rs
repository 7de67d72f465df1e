//! Axes of diagrams with labels at round numbers.

use std::ops::Range;

use plotters::coord::ranged1d::{DefaultFormatting, KeyPointHint};
use plotters::prelude::*;

use crate::scaling::legend::{Failure, INK};

/// Axis that starts at 0.
///
/// The default axis of `plotters` puts labels at fractions of workers, and `plotters` accepts explicit label positions
/// only for integer axes.
pub(crate) struct Axis {
    last: f64,
    ticks: Vec<f64>,
}

impl Axis {
    /// Returns an axis from 0 to `last`; the distance between labels is a whole multiple of `least`.
    pub(crate) fn new(last: f64, least: f64) -> Self {
        Self { last, ticks: ticks(last, least) }
    }
}

/// Chart with two such axes.
type Chart<'c, 't> = ChartContext<'c, SVGBackend<'t>, Cartesian2d<Axis, Axis>>;

/// Draws the axes of a chart with their titles, horizontal lines at the labels, and labels with `decimals` decimals on
/// the vertical axis.
pub(crate) fn draw_axes(
    chart: &mut Chart<'_, '_>,
    (x, y): (&str, &str),
    decimals: usize,
) -> Result<(), Failure> {
    chart
        .configure_mesh()
        .disable_x_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(RGBColor(228, 228, 228))
        .axis_style(INK)
        .label_style(("sans-serif", 16).into_font().color(&INK))
        .axis_desc_style(("sans-serif", 17).into_font().color(&INK))
        .x_label_formatter(&|x| format!("{x:.0}"))
        .y_label_formatter(&|y| format!("{y:.decimals$}"))
        .x_desc(x)
        .y_desc(y)
        .draw()
}

impl Ranged for Axis {
    type FormatOption = DefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, (start, end): (i32, i32)) -> i32 {
        start + (value / self.last * f64::from(end - start)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        // No thin lines between the labels.
        if hint.weight().allow_light_points() { Vec::new() } else { self.ticks.clone() }
    }

    fn range(&self) -> Range<f64> {
        0.0..self.last
    }
}

/// Returns the positions of at most ten labels on an axis from 0 to `last`: multiples of `least` times 1, 2, 5, 10, …
fn ticks(last: f64, least: f64) -> Vec<f64> {
    const MAX_STEPS: f64 = 9.0;
    let mut step = least;
    for factor in [2.0, 2.5, 2.0].into_iter().cycle() {
        if last / step < MAX_STEPS {
            break;
        }
        step *= factor;
    }
    (0..).map(|i| f64::from(i) * step).take_while(|&x| x <= last * (1.0 + 1e-9)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_are_at_round_numbers() {
        assert_eq!(ticks(4.2, 1.0), [0.0, 1.0, 2.0, 3.0, 4.0]);
        assert_eq!(ticks(17.0, 1.0), [0.0, 2.0, 4.0, 6.0, 8.0, 10.0, 12.0, 14.0, 16.0]);
        assert_eq!(ticks(128.0, 1.0), [0.0, 20.0, 40.0, 60.0, 80.0, 100.0, 120.0]);
        assert_eq!(ticks(1.1, 0.2).len(), 6);
    }

    #[test]
    fn values_are_mapped_to_pixels() {
        let axis = Axis::new(8.0, 1.0);
        assert_eq!([0.0, 2.0, 8.0].map(|x| axis.map(&x, (100, 180))), [100, 120, 180]);
        // Pixel rows are counted downward.
        assert_eq!([0.0, 2.0, 8.0].map(|y| axis.map(&y, (180, 100))), [180, 160, 100]);
    }
}
