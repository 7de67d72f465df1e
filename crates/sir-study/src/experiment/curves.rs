//! Diagrams of a few curves.

use std::io;

use plotters::element::DashedPathElement;
use plotters::prelude::*;

use crate::scaling::axis::{Axis, draw_axes};
use crate::scaling::legend::{Failure, GRAY, INK, Pixel, write};

/// Content of a diagram.
pub(crate) struct Diagram<'a> {
    pub(crate) title: &'a str,
    pub(crate) x_label: &'a str,
    pub(crate) y_label: &'a str,
    /// End of the horizontal axis. Both axes start at 0.
    pub(crate) x_last: f64,
    /// Marked position on the horizontal axis, and its label.
    pub(crate) mark: (f64, &'a str),
    /// Names and points of the curves.
    pub(crate) curves: &'a [(&'a str, Vec<(f64, f64)>)],
}

/// Colors of the curves, distinguishable for color-blind people, too (Okabe and Ito).
const COLORS: [RGBColor; 3] = [RGBColor(0, 114, 178), RGBColor(213, 94, 0), RGBColor(0, 158, 115)];

const SIZE: (u32, u32) = (760, 480);
const TITLE: u32 = 44;
const LEGEND: u32 = 36;

impl Diagram<'_> {
    /// Draws the diagram as SVG.
    pub(crate) fn svg(&self) -> io::Result<String> {
        let mut text = String::new();
        self.draw(&mut text).map_err(io::Error::other)?;
        Ok(text)
    }

    fn draw(&self, text: &mut String) -> Result<(), Failure> {
        let canvas = SVGBackend::with_string(text, SIZE).into_drawing_area();
        canvas.fill(&WHITE)?;
        write(&canvas, self.title, (SIZE.0 as i32 / 2, TITLE as i32 / 2 + 4), true, 22, INK)?;
        let (_, below) = canvas.split_vertically(TITLE);
        let (area, _) = below.split_vertically(SIZE.1 - TITLE - LEGEND);
        let largest = self.curves.iter().flat_map(|c| &c.1).map(|p| p.1).fold(0.0, f64::max);
        let y_last = if largest > 0.0 { 1.06 * largest } else { 1.0 };
        // The smallest step between labels is a tenth of the largest power of ten below `y_last`. The axis increases it
        // as needed.
        let exponent = y_last.log10().floor() as i32 - 1;
        let decimals = usize::try_from(-exponent).unwrap_or(0);
        let mut chart = ChartBuilder::on(&area)
            .margin(14)
            .x_label_area_size(48)
            .y_label_area_size(76)
            .build_cartesian_2d(
                Axis::new(self.x_last, self.x_last / 10.0),
                Axis::new(y_last, 10f64.powi(exponent)),
            )?;
        draw_axes(&mut chart, (self.x_label, self.y_label), decimals)?;
        let at = |x: f64, y: f64| chart.backend_coord(&(x, y));
        let (x, top) = at(self.mark.0, y_last);
        let line = vec![(x, top + 18), at(self.mark.0, 0.0)];
        canvas.draw(&DashedPathElement::new(line, 2, 3, GRAY.stroke_width(1)))?;
        write(&canvas, self.mark.1, (x, top + 8), true, 14, GRAY)?;
        let middle = (SIZE.1 - LEGEND / 2) as i32;
        let width = SIZE.0 as i32 / (self.curves.len() as i32 + 1);
        for (i, ((name, points), color)) in self.curves.iter().zip(COLORS.iter().cycle()).enumerate() {
            let pixels: Vec<Pixel> = points.iter().map(|&(x, y)| at(x, y)).collect();
            canvas.draw(&PathElement::new(pixels.clone(), color.stroke_width(2)))?;
            for pixel in pixels {
                canvas.draw(&Circle::new(pixel, 4, color.filled()))?;
            }
            write(&canvas, name, (width * (i as i32 + 1), middle), true, 16, *color)?;
        }
        canvas.present()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_diagram_has_its_texts_and_a_disc_for_every_point() {
        let curves = [("one", vec![(10.0, 0.012), (90.0, 0.034)]), ("two", vec![(50.0, 0.02)])];
        let svg = Diagram {
            title: "errors",
            x_label: "share",
            y_label: "error",
            x_last: 100.0,
            mark: (50.0, "half"),
            curves: &curves,
        };
        let svg = svg.svg().unwrap();
        for part in ["errors", "share", "error", "half", "one", "two", "0.030"] {
            assert!(svg.contains(part), "{part}: {svg}");
        }
        assert_eq!(svg.matches("<circle").count(), 3);
    }
}
