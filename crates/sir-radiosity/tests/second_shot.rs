//! The second shot sends what the brightest patches reflect: no power is lost, and the light is the same with less
//! noise.

#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "test helpers may panic and print")]

mod common;

use std::collections::BTreeMap;

use common::{TRANSPORTS, gray, scene, shoot, shoot_again};
use glam::DVec3;
use sir_geom::shapes::{self, Facing};
use sir_geom::{Material, Rgb, SceneBuilder, Side, Sides};
use sir_mesh::{PatchSize, Subdivision};
use sir_radiosity::{Model, OneWorker, Quanta};

/// Returns a room with a lamp close to its ceiling, and a sheet that reflects from both sides.
fn room(subdivision: Subdivision) -> Model {
    let mut b = SceneBuilder::new();
    let walls = b.add_material(Material::diffuse("", Rgb::new(0.8, 0.7, 0.5)));
    let lamp = b.add_material(gray(50.0, 0.3));
    let dark = b.add_material(gray(0.0, 0.1));
    let sheet = b.add_material(Material::diffuse("", Rgb::new(0.2, 0.5, 0.7)).with_sides(Sides::Both));
    shapes::cuboid(&mut b, DVec3::ZERO, DVec3::splat(3.0), [walls; 6], Facing::Inward);
    let (min, max) = (DVec3::new(1.4, 2.8, 1.4), DVec3::new(1.6, 2.9, 1.6));
    shapes::cuboid(&mut b, min, max, [dark, dark, dark, lamp, dark, dark], Facing::Outward);
    let corner = |x, z| DVec3::new(x, 1.0 + 0.3 * x, z);
    shapes::quad(&mut b, [corner(0.5, 0.5), corner(0.5, 2.0), corner(1.2, 2.0), corner(1.2, 0.5)], sheet);
    Model::new(scene(b), subdivision).unwrap()
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

fn variance(values: &[f64]) -> f64 {
    let mean = mean(values);
    values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / (values.len() as f64 - 1.0)
}

fn sum(quanta: &[Quanta]) -> Quanta {
    quanta.iter().fold(Quanta::ZERO, |sum, q| sum + *q)
}

#[test]
fn power_is_kept_to_the_quantum() {
    for subdivision in [Subdivision::Triangles(PatchSize::Count(1000)), Subdivision::PerFace] {
        let model = room(subdivision);
        let first = shoot(&model, 40_000, 1);
        let second = shoot_again(&model, &first, 10_000, 1);
        assert_eq!(sum(&first.unshot(&model, &OneWorker)), first.balance.unshot);
        let left = first.balance.unshot - second.balance.emitted + second.balance.unshot;
        // The power reflected of both shots together is rounded once, not twice.
        let rounding = (sum(&second.unshot(&model, &OneWorker)) - left).0.map(i64::abs);
        assert!(rounding.iter().all(|r| *r <= model.mesh.side_count() as i64), "{rounding:?}");
        // A quarter of the lines for a quarter of the power, except for the last patch.
        let share = second.balance.emitted.0[0] as f64 / first.balance.emitted.0[0] as f64;
        assert!(share > 0.2, "{share}");
        // The power sent is the power held, within one line.
        let lines = 2 * second.balance.emitted.0[0] / 10_000;
        let least = second.unshot(&model, &OneWorker).iter().map(|q| q.0[0]).min().unwrap();
        assert!(least > -lines, "{least} {lines}");
    }
}

/// Means of all triangles over many seeds agree, and errors agree with the stated ones. There is less noise on surfaces
/// that see the bright ceiling.
#[test]
fn light_is_the_same_with_less_noise() {
    const RUNS: u64 = 40;
    let model = room(Subdivision::Triangles(PatchSize::Count(1000)));
    for (way, transport) in TRANSPORTS {
        let run = |twice: bool, seed| {
            let first = shoot(&model, if twice { 40_000 } else { 50_000 }, seed);
            let shot = if twice { shoot_again(&model, &first, 10_000, seed) } else { first };
            transport(&model, shot, 50_000, seed).solution(&model)
        };
        let [once, twice] =
            [false, true].map(|twice| (1..=RUNS).map(|seed| run(twice, seed)).collect::<Vec<_>>());
        let n = RUNS as f64;
        let (mut noise, mut stated) = ([0.0; 2], 0.0);
        // Irradiance of each side of each triangle in each run.
        let mut means = BTreeMap::new();
        model.mesh.for_each_side(|triangle, patch, which, side| {
            let area = model.mesh.patch_area(triangle, patch);
            for (i, runs) in [&once, &twice].into_iter().enumerate() {
                let values: Vec<f64> = runs.iter().map(|run| run.irradiance[side.index()].y).collect();
                noise[i] += area * variance(&values);
                let sums: &mut [Vec<f64>; 2] = means
                    .entry((triangle, which == Side::Front))
                    .or_insert_with(|| [vec![0.0; runs.len()], vec![0.0; runs.len()]]);
                sums[i].iter_mut().zip(values).for_each(|(sum, value)| *sum += value);
            }
            stated += area * twice.iter().map(|run| run.error[side.index()].y.powi(2)).sum::<f64>() / n;
        });
        let [gain, honest] = [noise[1] / noise[0], (noise[1] / stated).sqrt()];
        println!("{way}: variance times {gain:.3}, spread over stated error {honest:.3}");
        for (triangle, [a, b]) in means {
            let z = (mean(&a) - mean(&b)) / ((variance(&a) + variance(&b)) / n).sqrt();
            assert!(z.abs() < 4.0, "{way}, {triangle:?}: the light differs: z {z}");
        }
        assert!(gain < 0.8, "{way}: {gain}");
        assert!((honest - 1.0).abs() < 0.1, "{way}: {honest}");
    }
}
