//! The cost of thousands of lamps: the times of a first shot and of sensors, relative to those with one lamp of the
//! same power.
//!
//! `cargo run --release -p sir-radiosity --example many_lamps`
#![allow(clippy::print_stdout, reason = "an example prints its results")]

use std::time::Instant;

use glam::DVec3;
use sir_geom::shapes::{Facing, cuboid};
use sir_geom::{Light, LightKind, Material, Rgb, SceneBuilder, Spread};
use sir_mesh::{PatchSize, Subdivision};
use sir_radiosity::{FirstShot, Gatherer, Model, Sensor, SensorSettings, ShotSettings, Solution, run_stage};

const POWER: f64 = 1000.0;
const LINES: u64 = 1_000_000;
const POINTS: u64 = 60;

enum Lamps {
    Triangles(u32),
    Points(u32),
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!("lamps, first shot (ratio), sensor with 64 rays (ratio), with 16,384 rays (ratio)");
    let mut one = None;
    for lamps in [
        Lamps::Triangles(1),
        Lamps::Triangles(100),
        Lamps::Triangles(10_000),
        Lamps::Triangles(100_000),
        Lamps::Points(1),
        Lamps::Points(5_000),
    ] {
        let name = match lamps {
            Lamps::Triangles(n) => format!("{n} triangles"),
            Lamps::Points(n) => format!("{n} points"),
        };
        let model = room(&lamps)?;
        let start = Instant::now();
        let shot = run_stage::<FirstShot<'_>>(ShotSettings::new(&model, LINES, 1), ())?;
        let solution = shot.solution(&model);
        let first = start.elapsed().as_secs_f64();
        let [few, many] = [64, 16_384].map(|rays| measure(&model, &solution, rays));
        let times = [first, few.0, many.0];
        let [a, b, c] = *one.get_or_insert(times);
        println!(
            "{name}: {:.2} s ({:.2}), {:.2} ms ({:.2}), {:.2} ms ({:.2}); relative errors {:.5}, {:.5}",
            first,
            first / a,
            1e3 * few.0,
            few.0 / b,
            1e3 * many.0,
            many.0 / c,
            few.1,
            many.1
        );
    }
    Ok(())
}

/// Returns a room of 10 by 10 by 3 m with boxes, and lamps in a grid close to its ceiling.
fn room(lamps: &Lamps) -> Result<Model, Box<dyn std::error::Error>> {
    let mut b = SceneBuilder::new();
    let white = b.add_material(Material::diffuse("white", Rgb::splat(0.6)));
    cuboid(&mut b, DVec3::ZERO, DVec3::new(10.0, 10.0, 3.0), [white; 6], Facing::Inward);
    for i in 0..25 {
        let corner = DVec3::new(f64::from(i % 5) * 2.0 + 0.5, f64::from(i / 5) * 2.0 + 0.5, 0.0);
        cuboid(&mut b, corner, corner + DVec3::new(1.0, 1.0, 0.8), [white; 6], Facing::Outward);
    }
    let (Lamps::Triangles(n) | Lamps::Points(n)) = *lamps;
    let columns = f64::from(n).sqrt().ceil() as u32;
    let cell = 10.0 / f64::from(columns);
    let edge = 0.5 * cell;
    let exitance = POWER / (f64::from(n) * 0.5 * edge * edge);
    let lamp = b.add_material(Material::diffuse("lamp", Rgb::ZERO).emitting(Rgb::splat(exitance)));
    for i in 0..n {
        let place = DVec3::new(
            (f64::from(i % columns) + 0.25) * cell,
            (f64::from(i / columns) + 0.25) * cell,
            2.9 + 0.05 * f64::from(i % 2),
        );
        match lamps {
            Lamps::Triangles(_) => {
                let corners = [place, place + edge * DVec3::Y, place + edge * DVec3::X];
                let corners = corners.map(|p| b.add_vertex(p));
                b.add_polygon(&corners, lamp);
            }
            Lamps::Points(_) => {
                let intensity = Rgb::splat(POWER / (4.0 * std::f64::consts::PI * f64::from(n)));
                let kind = LightKind::Point { position: place, intensity, spread: Spread::Isotropic };
                b.add_light(Light { name: String::new(), kind });
            }
        }
    }
    Ok(Model::new(b.build()?.scene, Subdivision::Triangles(PatchSize::MaxEdge(0.5)))?)
}

/// Returns the seconds per sensor, and the mean relative error.
fn measure(model: &Model, solution: &Solution, rays: u64) -> (f64, f64) {
    // The preparation for all sensors is not timed.
    let sensors = Gatherer::new(model, solution, SensorSettings::new(rays, 0.0), 1);
    let start = Instant::now();
    let mut error = 0.0;
    for i in 0..POINTS {
        let position = DVec3::new(0.16 * (i as f64 + 0.5), (i as f64 * 3.7) % 10.0, 0.9);
        let Some(sensor) = Sensor::new(position, DVec3::Z) else { continue };
        let measured = sensors.measure(i, &sensor);
        error += measured.sampling_error() / measured.luminance();
    }
    (start.elapsed().as_secs_f64() / POINTS as f64, error / POINTS as f64)
}
