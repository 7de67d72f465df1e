//! Measures the time to sample and to evaluate the intensity of a photometric file, and lines of a first shot per second:
//! `cargo run --release -p sir-radiosity --example luminaire_speed`.
//!
//! The table has 73 planes and 37 angles in each. The fastest of seven tries counts, which is least disturbed by other load.
#![allow(clippy::print_stdout, clippy::disallowed_methods, reason = "an example prints its results")]

use std::hint::black_box;
use std::time::Instant;

use glam::{DMat3, DVec3};
use sir_geom::shapes::{Facing, cuboid};
use sir_geom::{Light, LightKind, Material, Rgb, SceneBuilder, Spread, Tabulated};
use sir_lines::{cosine_direction, unit_vector};
use sir_mesh::{PatchSize, Subdivision};
use sir_photometry::{Coordinates, IntensityDistribution};
use sir_radiosity::{FirstShot, Model, ShotSettings, run_stage};

const CALLS: u32 = 400_000;
const LINES: u64 = 400_000;
const TRIES: usize = 7;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let azimuths: Vec<f64> = (0..73).map(|i| 5.0 * f64::from(i)).collect();
    let polars: Vec<f64> = (0..37).map(|i| 5.0 * f64::from(i)).collect();
    let value = |azimuth: f64, polar: f64| {
        1.2 + polar.to_radians().cos() + 0.5 * polar.to_radians().sin() * azimuth.to_radians().cos()
    };
    let values: Vec<f64> = azimuths.iter().flat_map(|&a| polars.iter().map(move |&p| value(a, p))).collect();
    let table = IntensityDistribution::new(Coordinates::C, &azimuths, &polars, &values)?;

    // Additive recurrence: uniform points without the time of a random generator.
    let point = |i: u32| [0.754_877_666_2, 0.569_840_290_9].map(|step| (f64::from(i) * step).fract());
    let directions: Vec<DVec3> = (0..CALLS).map(|i| unit_vector(point(i))).collect();
    println!("cosine_direction {:6.1} ns", nanoseconds(|i| cosine_direction(DVec3::Z, point(i)).x));
    println!("unit_vector      {:6.1} ns", nanoseconds(|i| unit_vector(point(i)).x));
    println!("sample           {:6.1} ns", nanoseconds(|i| table.sample(point(i)).x));
    println!("intensity        {:6.1} ns", nanoseconds(|i| table.intensity(directions[i as usize])));

    for (name, spread) in [
        ("isotropic point", Spread::Isotropic),
        ("luminaire", Spread::Tabulated(Tabulated::new(table, DMat3::IDENTITY))),
    ] {
        let mut builder = SceneBuilder::new();
        let wall = builder.add_material(Material::diffuse("wall", Rgb::splat(0.5)));
        cuboid(&mut builder, DVec3::ZERO, DVec3::new(5.0, 4.0, 3.0), [wall; 6], Facing::Inward);
        let kind = LightKind::Point { position: DVec3::new(2.0, 2.5, 2.0), intensity: Rgb::ONE, spread };
        builder.add_light(Light { name: String::new(), kind });
        let patches = Subdivision::Triangles(PatchSize::Count(10_000));
        let model = Model::new(builder.build()?.scene, patches)?;
        let mut fastest = f64::INFINITY;
        for seed in 0..TRIES as u64 {
            let start = Instant::now();
            run_stage::<FirstShot<'_>>(ShotSettings::new(&model, LINES, seed), ())?;
            fastest = fastest.min(start.elapsed().as_secs_f64());
        }
        println!("first shot, {name}: {:.2} million lines/s", LINES as f64 / fastest / 1e6);
    }
    Ok(())
}

/// Returns the time of a call.
fn nanoseconds(call: impl Fn(u32) -> f64) -> f64 {
    let mut fastest = f64::INFINITY;
    for _ in 0..TRIES {
        let start = Instant::now();
        let sum: f64 = (0..CALLS).map(&call).sum();
        black_box(sum);
        fastest = fastest.min(start.elapsed().as_secs_f64());
    }
    1e9 * fastest / f64::from(CALLS)
}
