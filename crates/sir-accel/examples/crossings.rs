//! Counts what uniform lines meet in a room with a ball: `cargo run --release -p sir-accel --example crossings`.
#![allow(clippy::print_stdout, reason = "an example talks to its reader")]

use glam::DVec3;
use sir_accel::Accel;
use sir_geom::shapes::{self, Facing};
use sir_geom::{Material, Rgb, SceneBuilder, SceneError};
use sir_lines::{Domain, Stage, Streams};

fn main() -> Result<(), SceneError> {
    let mut builder = SceneBuilder::new();
    let grey = builder.add_material(Material::diffuse("grey", Rgb::splat(0.5)));
    shapes::cuboid(&mut builder, DVec3::ZERO, DVec3::new(4.0, 3.0, 5.0), [grey; 6], Facing::Inward);
    shapes::sphere(&mut builder, DVec3::new(2.0, 1.0, 2.0), 0.8, 5, Facing::Outward, |_| grey);
    let scene = builder.build()?.scene;

    let accel = Accel::new(&scene);
    let mut tracer = accel.tracer();
    let domain = Domain::Sphere(scene.bounding_sphere());
    let streams = Streams::new(1, Stage::GLOBAL);
    let lines = 1_000_000;
    let start = std::time::Instant::now();
    let (mut empty, mut odd, mut hits) = (0u64, 0u64, 0u64);
    for i in 0..lines {
        let count = tracer.all_hits(&domain.line(streams.line(i).point())).len() as u64;
        empty += u64::from(count == 0);
        odd += count % 2;
        hits += count;
    }
    let seconds = start.elapsed().as_secs_f64();
    let expected = domain.forecast(lines).crossings(scene.total_area());
    println!("{} triangles, {:.2} M lines/s", scene.triangles().len(), 1e-6 * lines as f64 / seconds);
    println!("hits: {hits} ({expected:.0} by integral geometry)");
    println!("lines that meet nothing: {:.1} %, odd counts: {odd}", 100.0 * empty as f64 / lines as f64);
    Ok(())
}
