//! The diagrams of speed-up and efficiency over the number of workers.

use std::io;

use plotters::element::DashedPathElement;
use plotters::prelude::*;

use crate::scaling::axis::{Axis, draw_axes};
use crate::scaling::legend::{
    Canvas, Failure, GRAY, INK, Pixel, ROW, draw_legend, draw_line, draw_mark, write,
};
use crate::scaling::series::{Kind, Stage, kinds, stages};
use crate::scaling::statistics::Part;
use crate::scaling::study::{Row, Study};
use crate::scaling::workers::counted;

const WIDTH: u32 = 1000;
const TITLE: u32 = 44;
const PANELS: u32 = 400;

/// Length of axes relative to the largest value.
const MARGIN: f64 = 1.06;

/// Draws the speed-ups and, next to them, the efficiencies as SVG.
///
/// # Errors
///
/// No errors are known, because drawing happens in memory.
pub fn svg(study: &Study) -> io::Result<String> {
    svg_beside(study, &[], "")
}

/// Does the same as [`svg`], with additional points `others` that are labeled `name`.
///
/// # Errors
///
/// The same as [`svg`].
pub fn svg_beside(study: &Study, others: &[Row], name: &str) -> io::Result<String> {
    let mut text = String::new();
    draw(study, others, name, &mut text).map_err(io::Error::other)?;
    Ok(text)
}

fn draw(study: &Study, others: &[Row], name: &str, text: &mut String) -> Result<(), Failure> {
    let (stages, mut kinds) = (stages(study), kinds(study));
    let rows = [&study.rows, others].concat();
    if !others.is_empty() {
        kinds.push(Kind::published(name, study.rows.len()..rows.len()));
    }
    let legend = ROW as u32 * (kinds.len() as u32 + 1) + 20;
    let canvas = SVGBackend::with_string(text, (WIDTH, TITLE + PANELS + legend)).into_drawing_area();
    canvas.fill(&WHITE)?;
    let title = match study.repeats {
        1 => format!("{}, one run each", study.name),
        n => format!("{}, medians of {n} runs", study.name),
    };
    write(&canvas, &title, (WIDTH as i32 / 2, TITLE as i32 / 2 + 4), true, 24, INK)?;
    let (_, below) = canvas.split_vertically(TITLE);
    let (panels, _) = below.split_vertically(PANELS);
    let (left, right) = panels.split_horizontally(WIDTH / 2);
    let most = rows.iter().map(|row| row.p).max().unwrap_or(1) as f64;
    let speed_ups = Panel {
        label: "speed-up S(p) = T(1) / T(p)",
        value: |part| part.speed_up,
        ideal: [(0.0, 0.0), (most, most)],
        last: MARGIN * most,
        least_step: 1.0,
    };
    let efficiencies = Panel {
        label: "efficiency E(p) = S(p) / p",
        value: |part| part.efficiency,
        ideal: [(0.0, 1.0), (MARGIN * most, 1.0)],
        last: 1.1,
        least_step: 0.2,
    };
    speed_ups.draw((study.cores, &rows), &stages, &kinds, &canvas, &left)?;
    efficiencies.draw((study.cores, &rows), &stages, &kinds, &canvas, &right)?;
    draw_legend(&canvas, (TITLE + PANELS) as i32, &stages, &kinds)?;
    canvas.present()
}

/// One of the two diagrams.
struct Panel {
    /// Title of the vertical axis.
    label: &'static str,
    value: fn(Part) -> f64,
    ideal: [(f64, f64); 2],
    /// End of the vertical axis, unless there are larger values.
    last: f64,
    /// Smallest distance of the labels on the vertical axis.
    least_step: f64,
}

impl Panel {
    /// Draws the diagram into `area`, which is a part of `canvas`.
    fn draw(
        &self,
        (cores, rows): (usize, &[Row]),
        stages: &[Stage],
        kinds: &[Kind],
        canvas: &Canvas<'_>,
        area: &Canvas<'_>,
    ) -> Result<(), Failure> {
        let value = |stage: &Stage, row: usize| (stage.part)(&rows[row]).map(self.value);
        let all = (0..rows.len()).flat_map(|row| stages.iter().filter_map(move |stage| value(stage, row)));
        let y_last = all.fold(self.last, |last, y| last.max(MARGIN * y));
        let x_last = MARGIN * rows.iter().map(|row| row.p).max().unwrap_or(1) as f64;
        let mut chart = ChartBuilder::on(area)
            .margin(14)
            .x_label_area_size(48)
            .y_label_area_size(58)
            .build_cartesian_2d(Axis::new(x_last, 1.0), Axis::new(y_last, self.least_step))?;
        let decimals = usize::from(self.least_step < 1.0);
        draw_axes(&mut chart, ("workers p", self.label), decimals)?;
        let at = |x: f64, y: f64| chart.backend_coord(&(x, y));
        let ideal = self.ideal.map(|(x, y)| at(x, y));
        canvas.draw(&PathElement::new(ideal.to_vec(), GRAY.stroke_width(1)))?;
        let place = cores as f64;
        if place < x_last / MARGIN {
            let (x, top) = at(place, y_last);
            let line = vec![(x, top + 18), at(place, 0.0)];
            canvas.draw(&DashedPathElement::new(line, 2, 3, GRAY.stroke_width(1)))?;
            write(canvas, &counted(cores, "core"), (x, top + 8), true, 14, GRAY)?;
        }
        let series = || stages.iter().rev().flat_map(|stage| kinds.iter().map(move |kind| (stage, kind)));
        let points = |stage: &Stage, shown: &[usize]| -> Vec<Pixel> {
            let point = |&row: &usize| Some(at(rows[row].p as f64, value(stage, row)?));
            shown.iter().filter_map(point).collect()
        };
        for (stage, kind) in series() {
            draw_line(canvas, &points(stage, &kind.rows), kind, stage)?;
        }
        // Marks are drawn after all lines, on top of them.
        for (stage, kind) in series() {
            for point in points(stage, &kind.marked) {
                draw_mark(canvas, point, kind, stage)?;
            }
        }
        Ok(())
    }
}
