//! The inside of a sphere has the same irradiance everywhere, wherever it emits: ΣΦ / (A (1 − ρ)). This example solves
//! a sphere that emits from its top only: `cargo run --release -p sir-radiosity --example sphere_interior`.
#![allow(clippy::print_stdout, reason = "an example prints its results")]

use glam::DVec3;
use sir_geom::shapes::{self, Facing};
use sir_geom::{Material, Rgb, SceneBuilder};
use sir_lines::Domain;
use sir_mesh::Subdivision;
use sir_radiosity::{FirstShot, Model, ReplicaSettings, Replicas, ShotSettings, run_stage, sources};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let reflectance = 0.7;
    let mut builder = SceneBuilder::new();
    let wall = Material::diffuse("wall", Rgb::splat(reflectance));
    let lamp = builder.add_material(wall.clone().emitting(Rgb::splat(100.0)));
    let wall = builder.add_material(wall);
    shapes::sphere(&mut builder, DVec3::ZERO, 1.0, 3, Facing::Inward, |middle| {
        if middle.y > 0.8 { lamp } else { wall }
    });
    let model = Model::new(builder.build()?.scene, Subdivision::PerTriangle)?;

    let (seed, lines) = (1, 2_000_000);
    let shot = run_stage::<FirstShot<'_>>(ShotSettings::new(&model, lines, seed), ())?;
    let settings = ReplicaSettings::new(&model, Domain::hull(model.scene.vertices()), lines, seed);
    let done = run_stage::<Replicas<'_>>(settings, shot)?;

    let power: f64 = sources(&model.scene, &model.mesh).iter().map(|s| s.power.x).sum();
    let exact = power / (model.scene.total_area() * (1.0 - reflectance));
    let (sides, solution) = (model.mesh.side_count() as f64, done.solution(&model));
    let mean = solution.irradiance.iter().map(|e| e.x).sum::<f64>() / sides;
    let square = solution.irradiance.iter().map(|e| (e.x - exact).powi(2)).sum::<f64>() / sides;
    let error = solution.error.iter().map(|e| e.x * e.x).sum::<f64>() / sides;
    println!("irradiance: mean {mean:.3} W/m², exact {exact:.3} W/m²");
    println!(
        "rms deviation of a patch: {:.2} %, its standard error: {:.2} %",
        100.0 * square.sqrt() / exact,
        100.0 * error.sqrt() / exact
    );
    Ok(())
}
