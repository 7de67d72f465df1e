//! How much light the transports lose, and how that depends on the number of workers: the table of docs/parallel.md.
//! `cargo run --release -p sir-parallel --example bias`
//!
//! The inside of a sphere, where every patch sees all others alike: whatever the first shot has brought, the exact
//! answer is that all reflected power `U` is received `U / (1 − ρ)` times.
#![allow(clippy::print_stdout, reason = "an example talks to its reader")]

use std::num::NonZeroUsize;

use glam::DVec3;
use sir_geom::shapes::{self, Facing};
use sir_geom::{Material, Rgb, SceneBuilder};
use sir_lines::Domain;
use sir_mesh::Subdivision;
use sir_parallel::{Crew, batches, first_shot, multipath};
use sir_radiosity::{Model, MultipathSettings, Shot, Transported};

/// Crossings of a patch by all lines together.
const CROSSINGS: u64 = 2560;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!(
        "   ρ  workers   Replicas, no tail   −ρ/(1−ρ) P/n   Replicas, a tenth of tail   Batches   noise of a patch:"
    );
    for reflectance in [0.5, 0.8] {
        let model = sphere(reflectance)?;
        let domain = Domain::Sphere(model.scene.bounding_sphere());
        // Every line crosses two patches.
        let lines = CROSSINGS * model.mesh.side_count() as u64 / 2;
        for workers in [1, 8, 64] {
            let crew = &mut Crew::of(NonZeroUsize::new(workers).unwrap_or(NonZeroUsize::MIN));
            let shot = first_shot(&model, 4_000_000, 1, crew, None)?.outcome;
            let mut replicas = |tail| {
                let settings = MultipathSettings { lines, tail, replicas: workers as u64, domain };
                multipath(&model, shot.clone(), settings, 1, crew, None)
            };
            let published = replicas(0)?.outcome;
            let tail = replicas(lines / 10)?.outcome;
            let frozen = batches(&model, shot.clone(), lines, domain, 1, crew, None)?.outcome;
            let formula = -reflectance / (1.0 - reflectance) * workers as f64 / CROSSINGS as f64;
            let bias = |run| 100.0 * bias(&shot, run, reflectance);
            println!(
                "{reflectance:4.1} {workers:8} {:17.3} % {:12.3} % {:25.3} % {:7.3} %   {:.2} %, {:.2} %, {:.2} %",
                bias(&published),
                100.0 * formula,
                bias(&tail),
                bias(&frozen),
                100.0 * noise(&model, &shot, &published),
                100.0 * noise(&model, &shot, &tail),
                100.0 * noise(&model, &shot, &frozen),
            );
        }
    }
    Ok(())
}

/// A sphere that emits from a cap, one patch per triangle.
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

/// Power that a patch received after the first shot \[quanta\].
fn indirect<'a>(shot: &'a Shot, run: &'a Transported) -> impl Iterator<Item = f64> + 'a {
    let powers = run.received.power.iter().zip(&shot.received.power);
    powers.map(|(all, direct)| (all.0[0] - direct.0[0]) as f64)
}

/// Relative error of all power received after the first shot.
fn bias(shot: &Shot, run: &Transported, reflectance: f64) -> f64 {
    indirect(shot, run).sum::<f64>() / (shot.balance.unshot.0[0] as f64 / (1.0 - reflectance)) - 1.0
}

/// Root mean square of what patches received per area, against its mean.
fn noise(model: &Model, shot: &Shot, run: &Transported) -> f64 {
    let mut areas = Vec::new();
    model.mesh.for_each_side(|triangle, _, _, _| areas.push(model.mesh.patch_area(triangle)));
    let mean = indirect(shot, run).sum::<f64>() / areas.iter().sum::<f64>();
    let square = |(power, area): (f64, &f64)| (power / area / mean - 1.0).powi(2);
    let sum: f64 = indirect(shot, run).zip(&areas).map(square).sum();
    (sum / areas.len() as f64).sqrt()
}
