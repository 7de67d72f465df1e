//! Solves a closed box with a progress report: `cargo run --release -p sir-parallel --example furnace`.
#![allow(clippy::print_stdout, reason = "an example talks to its reader")]

use glam::DVec3;
use sir_geom::shapes::{self, Facing};
use sir_geom::{Material, Rgb, SceneBuilder};
use sir_lines::Domain;
use sir_mesh::Subdivision;
use sir_parallel::{Crew, Observer, batches, first_shot};
use sir_radiosity::Model;

/// Prints a line at every tenth of a stage.
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
    let grey = Material::diffuse("grey", Rgb::new(0.5, 0.8, 0.9)).emitting(Rgb::ONE);
    let grey = builder.add_material(grey);
    shapes::cuboid(&mut builder, DVec3::ZERO, DVec3::ONE, [grey; 6], Facing::Inward);
    let model = Model::new(builder.build()?.scene, Subdivision::Patches(600))?;

    let mut crew = Crew::default().watched_by(Tenths(0));
    let (lines, seed) = (1_000_000, 1);
    let shot = first_shot(&model, lines, seed, &mut crew, None)?.outcome;
    let domain = Domain::hull(model.scene.vertices());
    let mut crew = Crew::default().watched_by(Tenths(0));
    let run = batches(&model, shot, lines, domain, seed, &mut crew, None)?;
    let mean = run.outcome.solution.irradiance.iter().sum::<Rgb>() / model.mesh.side_count() as f64;
    println!(
        "mean irradiance {mean:.4}, exact [2, 5, 10], in {:.2} s and {} batches",
        run.time.total.as_secs_f64(),
        run.batches
    );
    Ok(())
}
