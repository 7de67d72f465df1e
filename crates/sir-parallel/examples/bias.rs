//! Measures the bias of the transports as a function of the number of workers: the table of docs/parallel.md.
//! `cargo run --release -p sir-parallel --example bias docs/images/bias.svg`
//!
//! The scene is the inside of a sphere, where the view factor to a patch is the same from everywhere. Whatever the
//! outcome of the first shot, the power received afterwards is exactly `U / (1 − ρ)`, where `U` is the reflected power.
#![allow(clippy::print_stdout, reason = "an example prints its results")]

use std::num::NonZeroUsize;

use glam::DVec3;
use plotters::prelude::*;
use sir_geom::shapes::{self, Facing};
use sir_geom::{Material, Rgb, SceneBuilder};
use sir_lines::Domain;
use sir_mesh::Subdivision;
use sir_parallel::{Executor, Start};
use sir_radiosity::{
    BatchSettings, Batches, FirstShot, Model, OneWorker, ReplicaSettings, Replicas, Shot, ShotSettings,
    Transported,
};

/// Expected crossings of a patch by all lines together.
const CROSSINGS: u64 = 2560;

/// Numbers of workers.
const WORKERS: [usize; 7] = [1, 2, 4, 8, 16, 32, 64];

/// Relative errors of the reflected power, and noise of the patches, in the order of [`NAMES`].
struct Row {
    reflectance: f64,
    workers: usize,
    bias: [f64; 3],
    noise: [f64; 3],
}

const NAMES: [&str; 3] = ["replicas, no tail", "replicas, a tenth is tail", "batches"];

impl Row {
    /// Returns the theoretical bias of replicas without a tail: −ρ/(1−ρ) P/n.
    fn expected(&self) -> f64 {
        -self.reflectance / (1.0 - self.reflectance) * self.workers as f64 / CROSSINGS as f64
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut rows = Vec::new();
    println!(
        "| ρ | workers P | −ρ/(1−ρ) P/n | {} | {} | {} | noise of a patch |",
        NAMES[0], NAMES[1], NAMES[2]
    );
    println!("|--:|--:|--:|--:|--:|--:|--:|");
    for reflectance in [0.5, 0.8] {
        let model = sphere(reflectance)?;
        for workers in WORKERS {
            let row = measure(&model, reflectance, workers)?;
            let [published, tail, batches] = row.bias.map(|bias| format!("{:.3} %", 100.0 * bias));
            let noise = row.noise.map(|noise| format!("{:.2} %", 100.0 * noise)).join(", ");
            let expected = 100.0 * row.expected();
            println!(
                "| {reflectance} | {workers} | {expected:.3} % | {published} | {tail} | {batches} | {noise} |"
            );
            rows.push(row);
        }
    }
    match std::env::args().nth(1) {
        Some(path) => plot(&path, &rows),
        None => Ok(()),
    }
}

fn measure(model: &Model, reflectance: f64, workers: usize) -> Result<Row, Box<dyn std::error::Error>> {
    let domain = Domain::Sphere(model.scene.bounding_sphere());
    // Every line crosses two patches.
    let lines = CROSSINGS * model.mesh.side_count() as u64 / 2;
    let executor = &mut Executor::new(NonZeroUsize::new(workers).unwrap_or(NonZeroUsize::MIN));
    let settings = ShotSettings::new(model, 4_000_000, 1);
    let shot = executor.run::<FirstShot<'_>>(settings, Start::Fresh(()))?.outcome;
    let mut replicas = |tail| {
        let settings = ReplicaSettings::new(model, domain.clone(), lines, 1);
        let settings = ReplicaSettings { tail, replicas: workers as u64, ..settings };
        executor.run::<Replicas<'_>>(settings, Start::Fresh(shot.clone()))
    };
    let (published, tail) = (replicas(0)?.outcome, replicas(lines / 10)?.outcome);
    let settings = BatchSettings::new(model, domain, lines, 1);
    let frozen = executor.run::<Batches<'_>>(settings, Start::Fresh(shot.clone()))?.outcome;
    let runs = [&published, &tail, &frozen];
    let bias = runs.map(|run| bias(model, &shot, run, reflectance));
    let noise = runs.map(|run| noise(model, &shot, run));
    Ok(Row { reflectance, workers, bias, noise })
}

/// Plots the bias over the number of workers, with logarithmic scales.
fn plot(path: &str, rows: &[Row]) -> Result<(), Box<dyn std::error::Error>> {
    const LEAST: f64 = 1e-4;
    let root = SVGBackend::new(path, (900, 420)).into_drawing_area();
    root.fill(&WHITE)?;
    for (area, reflectance) in root.split_evenly((1, 2)).iter().zip([0.5, 0.8]) {
        let mut chart = ChartBuilder::on(area)
            .caption(format!("light missing in a sphere, ρ = {reflectance}"), ("sans-serif", 18))
            .margin(12)
            .set_label_area_size(LabelAreaPosition::Left, 60)
            .set_label_area_size(LabelAreaPosition::Bottom, 40)
            .build_cartesian_2d(-0.2..6.2, (LEAST..2000.0).log_scale())?;
        chart
            .configure_mesh()
            .x_desc("workers, P")
            .y_desc("% of the reflected light (less than 0.0001 is drawn as that)")
            .x_labels(7)
            .x_label_formatter(&|x: &f64| format!("{:.0}", x.exp2()))
            .bold_line_style(BLACK.mix(0.1))
            .y_label_formatter(&|y| format!("{y}"))
            .light_line_style(WHITE)
            .draw()?;
        let of = || rows.iter().filter(|row| row.reflectance == reflectance);
        let formula = of().map(|row| ((row.workers as f64).log2(), -100.0 * row.expected()));
        chart
            .draw_series(LineSeries::new(formula, BLACK.mix(0.4).stroke_width(3)))?
            .label("ρ/(1−ρ) P/n")
            .legend(|(x, y)| PathElement::new([(x, y), (x + 18, y)], BLACK.mix(0.4)));
        for (k, color) in [RED, MAGENTA, BLUE].into_iter().enumerate() {
            let points =
                || of().map(move |row| ((row.workers as f64).log2(), (-100.0 * row.bias[k]).max(LEAST)));
            chart
                .draw_series(LineSeries::new(points(), color).point_size(4))?
                .label(NAMES[k])
                .legend(move |(x, y)| Circle::new((x + 9, y), 4, color.filled()));
        }
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::UpperLeft)
            .background_style(WHITE)
            .border_style(BLACK.mix(0.3))
            .draw()?;
    }
    root.present()?;
    Ok(())
}

/// Returns a sphere that emits from a cap, with one patch per triangle.
fn sphere(reflectance: f64) -> Result<Model, Box<dyn std::error::Error>> {
    let mut builder = SceneBuilder::new();
    let wall = Material::diffuse("wall", Rgb::splat(reflectance));
    let lamp = builder.add_material(wall.clone().emitting(Rgb::ONE));
    let wall = builder.add_material(wall);
    shapes::sphere(&mut builder, DVec3::ZERO, 1.0, 4, Facing::Inward, |middle| {
        if middle.y > 0.8 { lamp } else { wall }
    });
    Ok(Model::new(builder.build()?.scene, Subdivision::PerTriangle)?)
}

/// Returns the power that each patch received after the first shot, in quanta.
fn indirect(model: &Model, shot: &Shot, run: &Transported) -> Vec<f64> {
    let all = run.received(model, &OneWorker);
    let powers = all.power.iter().zip(&shot.received.power);
    powers.map(|(all, direct)| (all.0[0] - direct.0[0]) as f64).collect()
}

/// Returns the relative error of the total power received after the first shot.
fn bias(model: &Model, shot: &Shot, run: &Transported, reflectance: f64) -> f64 {
    indirect(model, shot, run).iter().sum::<f64>() / (shot.balance.unshot.0[0] as f64 / (1.0 - reflectance))
        - 1.0
}

/// Returns the root mean square deviation of the power received per area, relative to its mean.
fn noise(model: &Model, shot: &Shot, run: &Transported) -> f64 {
    let mut areas = Vec::new();
    model.mesh.for_each_side(|triangle, patch, _, _| areas.push(model.mesh.patch_area(triangle, patch)));
    let powers = indirect(model, shot, run);
    let mean = powers.iter().sum::<f64>() / areas.iter().sum::<f64>();
    let square = |(power, area): (&f64, &f64)| (power / area / mean - 1.0).powi(2);
    let sum: f64 = powers.iter().zip(&areas).map(square).sum();
    (sum / areas.len() as f64).sqrt()
}
