//! Benchmark of the error against time: the true error of the radiosity of patches, against a reference with many more
//! lines, and the seconds of whole runs. It compares `Solve` with lines that are divided as in Martínez, Forés and Martín
//! (2009), ten local lines to thirteen global ones.
//!
//! ```text
//! cargo bench --bench error                             # all scenes of the project
//! cargo bench --bench error -- cornell-box --steps 4    # one scene, with up to 4³ times the fewest lines
//! ```
//!
//! Prints a table and writes a diagram, `target/error/SCENE.svg`.

#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a benchmark that fails, fails like a test")]

use std::path::{Path, PathBuf};
use std::time::Instant;

use plotters::prelude::*;
use sir::pipeline::plan::Pipeline;
use sir::pipeline::run::{RunOptions, run_pipeline};
use sir::view::Table;

/// Scenes with their numbers of patches, and of lines in the first step.
const SCENES: [(&str, &str, u64, u64); 3] = [
    ("cornell-box", "cornell-box.gltf", 5_504, 1_000_000),
    ("reading-room", "reading-room.glb", 100_000, 4_000_000),
    ("museum-stairs", "museum-stairs.glb", 200_000, 8_000_000),
];

/// Factor of the number of lines from one step to the next.
const FACTOR: u64 = 4;

/// Lines of the reference over those of the last step.
const REFERENCE: u64 = 20;

/// Stages with light for a number of lines.
type Stages = fn(u64) -> String;

/// Ways to divide the lines.
const WAYS: [(&str, Stages, RGBColor); 3] = [
    ("10 : 13", by_ten_to_thirteen, RGBColor(213, 94, 0)),
    ("Solve, random points", solve, RGBColor(0, 158, 115)),
    ("Solve", solve, RGBColor(0, 114, 178)),
];

fn by_ten_to_thirteen(lines: u64) -> String {
    let local = lines * 10 / 23;
    format!("FirstShot(lines: {local}), Multipath(lines: {})", lines - local)
}

fn solve(lines: u64) -> String {
    format!("Solve(lines: {lines})")
}

/// Name, color, and points of a curve: seconds and error.
type Curve = (&'static str, RGBColor, Vec<(f64, f64)>);

/// A scene, and where its runs are written.
struct Subject {
    scene: PathBuf,
    patches: u64,
    folder: tempfile::TempDir,
}

/// A finished run.
struct Outcome {
    table: Table,
    /// Time of the stages with light [s], and of the whole run.
    seconds: [f64; 2],
}

impl Subject {
    fn run(&self, points: &str, stages: &str, seed: u64) -> Outcome {
        let text = format!(
            "(seed: {seed}, points: {points}, stages: [Load(path: {:?}), Subdivide(patches: {}), {stages}, \
             Save([Table(path: \"patches.npy\")])])",
            self.scene, self.patches
        );
        let pipeline = Pipeline::parse(&text, &self.folder.path().join("error.ron")).unwrap();
        let out = self.folder.path().join("out");
        let options = RunOptions { out: Some(out.clone()), force: true, ..RunOptions::default() };
        let start = Instant::now();
        let report = run_pipeline(&pipeline, &options).unwrap().report;
        let whole = start.elapsed().as_secs_f64();
        let light = report.stages.iter().filter(|stage| stage.light.is_some() || stage.lines.is_some());
        // The time of each stage, also of those in a `Solve`, whose pilot counts.
        let seconds = light.map(|stage| stage.time.seconds).sum();
        let table = Table::read(&out.join("patches.npy")).unwrap();
        Outcome { table, seconds: [seconds, whole] }
    }
}

/// Returns the root mean squares of the difference of the radiosity in the green band and of the errors that the first table
/// states, over the mean of the second table, weighted by area.
fn errors(a: &Table, b: &Table) -> [f64; 2] {
    let (mut area, mut sum, mut squares) = (0.0, 0.0, [0.0; 2]);
    for (a, b) in a.rows.iter().zip(&b.rows) {
        let difference = a.radiosity.y - b.radiosity.y;
        area += b.area;
        sum += b.area * b.radiosity.y;
        squares[0] += b.area * difference * difference;
        squares[1] += b.area * a.error.y * a.error.y;
    }
    squares.map(|squares| (squares * area).sqrt() / sum)
}

fn main() {
    let (mut names, mut steps) = (Vec::new(), 2);
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            // Cargo passes this option to every benchmark.
            "--bench" => {}
            "--steps" => {
                steps = arguments.next().and_then(|n| n.parse().ok()).expect("`--steps` needs a number");
            }
            _ => names.push(argument),
        }
    }
    println!(
        "Error of the radiosity in the green band; seconds of the stages with light, and of the whole run."
    );
    println!(
        "{:<14} {:<21} {:>12} {:>8} {:>8} {:>9} {:>9} {:>12}",
        "scene", "lines divided by", "lines", "true, %", "stated,%", "light, s", "whole, s", "error² s, %²"
    );
    for (name, file, patches, fewest) in SCENES {
        if names.is_empty() || names.iter().any(|n| n == name) {
            let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(name).join(file);
            let subject = Subject { scene, patches, folder: tempfile::tempdir().unwrap() };
            measure(name, &subject, fewest, steps);
        }
    }
}

fn measure(name: &str, subject: &Subject, fewest: u64, steps: u32) {
    let most = fewest * FACTOR.pow(steps.max(1) - 1);
    let reference = subject.run("Sobol", &solve(REFERENCE * most), 1_000_003).table;
    let mut curves: Vec<Curve> = Vec::new();
    for (way, stages, color) in WAYS {
        let points = if way == "Solve" { "Sobol" } else { "Random" };
        let mut curve = Vec::new();
        for step in 0..steps.max(1) {
            let lines = fewest * FACTOR.pow(step);
            let Outcome { table, seconds: [light, whole] } = subject.run(points, &stages(lines), 1);
            let [error, stated] = errors(&table, &reference).map(|error| 100.0 * error);
            println!(
                "{name:<14} {way:<21} {lines:>12} {error:>8.2} {stated:>8.2} {light:>9.2} {whole:>9.2} {:>12.1}",
                error * error * light
            );
            curve.push((light, error));
        }
        curves.push((way, color, curve));
    }
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("target/error");
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join(format!("{name}.svg"));
    draw(&path, name, &curves);
    println!("{}", path.display());
}

/// Draws the errors over the seconds, both logarithmic.
fn draw(path: &Path, title: &str, curves: &[Curve]) {
    let points = || curves.iter().flat_map(|(_, _, points)| points);
    let range = |of: fn(&(f64, f64)) -> f64| {
        let values = || points().map(of);
        values().fold(f64::INFINITY, f64::min) / 1.3..values().fold(0.0, f64::max) * 1.3
    };
    let canvas = SVGBackend::new(path, (760, 480)).into_drawing_area();
    canvas.fill(&WHITE).unwrap();
    let mut chart = ChartBuilder::on(&canvas)
        .caption(title, ("sans-serif", 22))
        .margin(14)
        .x_label_area_size(44)
        .y_label_area_size(60)
        .build_cartesian_2d(range(|p| p.0).log_scale(), range(|p| p.1).log_scale())
        .unwrap();
    chart.configure_mesh().x_desc("seconds").y_desc("error of the radiosity, %").draw().unwrap();
    for (name, color, points) in curves {
        let line = chart.draw_series(LineSeries::new(points.clone(), color.stroke_width(2))).unwrap();
        let color = *color;
        line.label(*name).legend(move |(x, y)| Rectangle::new([(x, y - 2), (x + 16, y + 2)], color.filled()));
        chart.draw_series(points.iter().map(|&at| Circle::new(at, 4, color.filled()))).unwrap();
    }
    chart.configure_series_labels().background_style(WHITE).border_style(BLACK).draw().unwrap();
    canvas.present().unwrap();
}
