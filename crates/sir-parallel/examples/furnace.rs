//! Solves a closed box with a progress report: `cargo run --release -p sir-parallel --example furnace`.
#![allow(clippy::print_stdout, reason = "an example prints its results")]

use glam::DVec3;
use sir_geom::shapes::{self, Facing};
use sir_geom::{Material, Rgb, SceneBuilder};
use sir_lines::Domain;
use sir_mesh::{PatchSize, Subdivision};
use sir_parallel::{Executor, Observer, Start};
use sir_radiosity::{BatchSettings, Batches, FirstShot, Model, ShotSettings};

/// Observer that prints a line at every tenth of a stage.
struct Tenths(u64);

impl Observer for Tenths {
    fn progress(&mut self, done: u64, total: u64) {
        if done * 10 / total > self.0 {
            self.0 = done * 10 / total;
            println!("{done} of {total} lines");
        }
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut builder = SceneBuilder::new();
    let gray = Material::diffuse("gray", Rgb::new(0.5, 0.8, 0.9)).emitting(Rgb::ONE);
    let gray = builder.add_material(gray);
    shapes::cuboid(&mut builder, DVec3::ZERO, DVec3::ONE, [gray; 6], Facing::Inward);
    let model = Model::new(builder.build()?.scene, Subdivision::Triangles(PatchSize::Count(600)))?;

    let (lines, seed) = (1_000_000, 1);
    let mut executor = Executor::default().watched_by(Tenths(0));
    let settings = ShotSettings::new(&model, lines, seed);
    let shot = executor.run::<FirstShot<'_>>(settings, Start::Fresh(()))?.outcome;
    let mut executor = Executor::default().watched_by(Tenths(0));
    let settings = BatchSettings::new(&model, Domain::hull(model.scene.vertices()), lines, seed);
    let run = executor.run::<Batches<'_>>(settings, Start::Fresh(shot))?;
    let mean = run.outcome.solution(&model).irradiance.iter().sum::<Rgb>() / model.mesh.side_count() as f64;
    println!(
        "mean irradiance {mean:.4}, exact [2, 5, 10], in {:.2} s and {} batches",
        run.time.total.as_secs_f64(),
        run.batches
    );
    Ok(())
}
