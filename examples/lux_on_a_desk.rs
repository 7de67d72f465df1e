//! Uses the facade: loads the reading room, solves it, and prints the irradiance on its tables.
//! `cargo run --release --example lux_on_a_desk`
#![allow(clippy::print_stdout, reason = "an example prints its results")]

use std::path::Path;

use sir::geom::{LoadOptions, Rgb, Side, load};
use sir::parallel::Solver;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let path = Path::new("scenes/reading-room/reading-room.glb");
    let scene = load(path, &LoadOptions::default())?.scene;
    let solved =
        Solver::new(scene).patches(100_000).first_shot(2_000_000).multipath(4_000_000).seed(1).solve()?;
    let model = &solved.model;

    // Area and received power of the upward faces of each material at desk height.
    let mut desks = std::collections::BTreeMap::<&str, (f64, Rgb)>::new();
    solved.for_each_side(|light| {
        let [a, b, c] = model.scene.corners(light.triangle);
        let height = (a.y + b.y + c.y) / 3.0;
        let upward = light.side == Side::Front && model.scene.normal(light.triangle).y > 0.99;
        if upward && (0.6..0.9).contains(&height) {
            let area = model.mesh.patch_area(light.triangle, light.patch);
            let sum = desks.entry(&model.scene.material(light.triangle).name).or_default();
            sum.0 += area;
            sum.1 += area * light.irradiance;
        }
    });
    for (material, (area, power)) in desks {
        println!("{material:>20}: {area:6.2} m², mean irradiance {:.2} W/m²", power / area);
    }
    Ok(())
}
