//! The facade in one go: load a scene, solve it, and ask for the light on the tables of the reading room.
//! `cargo run --release --example lux_on_a_desk`
#![allow(clippy::print_stdout, reason = "an example talks to its reader")]

use std::path::Path;

use sir::geom::{LoadOptions, Rgb, Side, load};
use sir::lines::Domain;
use sir::mesh::Subdivision;
use sir::parallel::{Crew, batches, first_shot};
use sir::radiosity::Model;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let path = Path::new("scenes/reading-room/reading-room.glb");
    let scene = load(path, &LoadOptions::default())?.scene;
    let model = Model::new(scene, Subdivision::Patches(100_000))?;

    let (crew, seed) = (&mut Crew::default(), 1);
    let shot = first_shot(&model, 2_000_000, seed, crew, None)?.outcome;
    let domain = Domain::hull(model.scene.vertices());
    let solution = batches(&model, shot, 4_000_000, domain, seed, crew, None)?.outcome.solution;

    // Mean irradiance of the upward faces of each material at desk height.
    let mut desks = std::collections::BTreeMap::<&str, (f64, Rgb)>::new();
    model.mesh.for_each_side(|triangle, _, side, id| {
        let [a, b, c] = model.scene.corners(triangle);
        let height = (a.y + b.y + c.y) / 3.0;
        let upward = side == Side::Front && model.scene.normal(triangle).y > 0.99;
        if upward && (0.6..0.9).contains(&height) {
            let area = model.mesh.patch_area(triangle);
            let sum = desks.entry(&model.scene.material(triangle).name).or_default();
            sum.0 += area;
            sum.1 += area * solution.irradiance[id.index()];
        }
    });
    for (material, (area, power)) in desks {
        println!("{material:>20}: {area:6.2} m², mean irradiance {:.2} W/m²", power / area);
    }
    Ok(())
}
