//! Cells of flat surfaces and joined triangles of bent ones have the same light as triangles.

#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "test helpers may panic and print")]

mod common;

use common::{Estimate, TRANSPORTS, add_sphere, gray, runs, scene, shoot, shoot_again};
use glam::DVec3;
use sir_geom::shapes::{self, Facing};
use sir_geom::{Material, Rgb, SceneBuilder, Side, Sides};
use sir_lines::LocalLines;
use sir_mesh::{PatchSize, Subdivision};
use sir_radiosity::{Model, Points, ShadowRaySettings, ShadowRays, Solution, run_stage};

/// Returns the inside of a sphere, each half of which is a material: the exact radiosity of each follows from the view
/// factor 1/2 between any two points of a sphere and a half.
fn sphere(subdivision: Subdivision) -> Model {
    let mut b = SceneBuilder::new();
    let (upper, lower) = (b.add_material(gray(1.0, 0.8)), b.add_material(gray(0.0, 0.5)));
    add_sphere(&mut b, 1.0, 1, Facing::Inward, &[(90, upper), (180, lower)]);
    Model::new(scene(b), subdivision).unwrap()
}

/// A line may cross a joined patch twice, and joined patches see themselves. Both transports stay exact.
#[test]
fn joined_triangles_of_a_sphere_have_the_exact_light() {
    let model = sphere(Subdivision::Surfaces(PatchSize::MaxEdge(0.5)));
    assert!(model.mesh.patch_count() < 150 && model.scene.triangles().len() > 5000);
    // In a sphere, each half sends half of its light to each: B = M + ρ (B₁ + B₂) / 2.
    let sum = |rho: [f64; 2]| 1.0 / (1.0 - 0.5 * (rho[0] + rho[1]));
    let all = sum([0.8, 0.5]);
    let exact = [1.0 + 0.8 * 0.5 * all, 0.5 * 0.5 * all];
    for (way, transport) in TRANSPORTS {
        let runs = runs(&model, transport, 100_000, 16);
        for (half, exact) in exact.into_iter().enumerate() {
            // The polygons of the sphere are a little smaller than it, but see each other likewise.
            Estimate::of(runs.iter().map(|r| r[half].x)).assert_is(exact, &format!("{way}, half {half}"));
        }
    }
}

/// Returns a room with a lamp, slivers as a wall, a two-sided sheet and a sphere.
fn room(subdivision: Subdivision) -> Model {
    let mut b = SceneBuilder::new();
    let walls = b.add_material(Material::diffuse("", Rgb::new(0.8, 0.7, 0.5)));
    let lamp = b.add_material(gray(50.0, 0.3));
    let sheet = b.add_material(Material::diffuse("", Rgb::new(0.2, 0.5, 0.7)).with_sides(Sides::Both));
    shapes::cuboid(&mut b, DVec3::ZERO, DVec3::new(3.0, 3.0, 2.5), [walls; 6], Facing::Inward);
    shapes::quad(
        &mut b,
        [[1.0, 1.0], [1.0, 2.0], [2.0, 2.0], [2.0, 1.0]].map(|[x, y]| DVec3::new(x, y, 2.4)),
        lamp,
    );
    let start = b.add_vertex(DVec3::new(0.2, 0.2, 0.5));
    let at = |i: i32| DVec3::new(0.2, 2.8, 0.5 + 0.04 * f64::from(i));
    for i in 0..50 {
        let ends = [i, i + 1].map(|i| b.add_vertex(at(i)));
        b.add_polygon(&[start, ends[0], ends[1]], sheet);
    }
    shapes::sphere(&mut b, DVec3::new(2.0, 1.5, 0.8), 0.6, 4, Facing::Outward, |_| walls);
    Model::new(scene(b), subdivision).unwrap()
}

/// Returns the power that each material receives per band, from several sums.
fn received(model: &Model, solution: &Solution) -> Vec<Rgb> {
    let mut sums = vec![Rgb::ZERO; 2 * model.scene.materials().len()];
    model.mesh.for_each_side(|triangle, patch, side, id| {
        let material = model.scene.triangle(triangle).material.index();
        let area = model.mesh.patch_area(triangle, patch);
        sums[2 * material + usize::from(side == Side::Back)] += area * solution.irradiance[id.index()];
    });
    sums
}

/// First shot, second shot, shadow rays, batches and random walks.
#[test]
fn all_stages_bring_the_same_light_as_to_triangles() {
    let of = |subdivision| {
        let model = room(subdivision);
        let run = |seed| {
            let shot = shoot(&model, 60_000, seed);
            let rays = ShadowRaySettings {
                model: &model,
                rays: LocalLines { count: 30_000, focus: None },
                seed,
                points: Points::Random,
                every: 1,
            };
            let (shot, _) = run_stage::<ShadowRays<'_>>(rays, shot).unwrap();
            let shot = shoot_again(&model, &shot, 30_000, seed);
            let run = common::batches(&model, shot, 60_000, seed);
            assert!(run.balance.closes());
            received(&model, &run.solution(&model))
        };
        (1..=24).map(run).collect::<Vec<_>>()
    };
    // Small triangles, for which patches are the same light in the limit, and lattices that differ from them.
    let triangles = of(Subdivision::Triangles(PatchSize::MaxEdge(0.12)));
    let surfaces = of(Subdivision::Surfaces(PatchSize::MaxEdge(0.12)));
    let mut checked = 0;
    for k in 0..triangles[0].len() {
        for band in 0..3 {
            let [one, other] = [&triangles, &surfaces].map(|runs| {
                let values: Vec<f64> = runs.iter().map(|run| run[k][band]).collect();
                Estimate::of(values)
            });
            if one.mean == 0.0 {
                assert_eq!(other.mean, 0.0);
                continue;
            }
            let sigma = one.sigma.hypot(other.sigma);
            let z = (one.mean - other.mean) / sigma;
            println!(
                "{k} {band}: {:.4} {:.4}, ± {:.2} %, {z:+.1}",
                one.mean,
                other.mean,
                100.0 * sigma / one.mean
            );
            assert!(sigma < 0.01 * one.mean && z.abs() < 4.5, "{z}");
            checked += 1;
        }
    }
    assert!(checked >= 9);
}
