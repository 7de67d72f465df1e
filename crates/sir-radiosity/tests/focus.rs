//! A focus changes no light and loses none. It only reduces the noise in a part of the scene.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "test helpers may panic and print")]

mod common;

use common::{Estimate, gray, scene};
use glam::DVec3;
use sir_geom::shapes::{self, Facing};
use sir_geom::{BoundingBox, Light, LightKind, Material, Rgb, SceneBuilder, Sky, SkyModel};
use sir_lines::{Domain, Focus, GlobalLines, LocalLines};
use sir_mesh::{PatchSize, Subdivision};
use sir_radiosity::{
    BatchSettings, Batches, FirstShot, Model, Shot, ShotSettings, Transported, run_stage, sources,
};

/// Returns a black square of one square meter 10 cm above the middle of a black ground of 60 × 60 m, under a sky and
/// the sun.
///
/// A speck high above a corner of the ground, which covers almost no sky, makes the box of the scene high. The focus is
/// equally high, so that a considerable share of its lines miss the square.
fn square() -> (Model, Focus, f64) {
    let mut b = SceneBuilder::new();
    let [small, wide, speck] = [0; 3].map(|_| b.add_material(gray(0.0, 0.0)));
    let at = |half: f64, z: f64| {
        [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| DVec3::new(half * x, half * y, z))
    };
    shapes::quad(&mut b, at(0.5, 0.1), small);
    shapes::quad(&mut b, at(30.0, 0.0), wide);
    shapes::quad(&mut b, at(0.05, 3.0).map(|p| p + DVec3::new(25.0, 25.0, 0.0)), speck);
    let sun = DVec3::new(0.6, 0.0, 0.8);
    let sky = Sky::new(DVec3::Z, SkyModel::Uniform, Rgb::splat(100.0), Rgb::splat(5.0)).unwrap();
    b.set_sky(sky);
    b.add_light(Light {
        name: String::new(),
        kind: LightKind::Distant { direction: -sun, irradiance: Rgb::splat(500.0) },
    });
    let model = Model::new(scene(b), Subdivision::PerTriangle).unwrap();
    let bounds = BoundingBox { min: DVec3::new(-0.5, -0.5, 0.05), max: DVec3::new(0.5, 0.5, 3.0) };
    let focus = Focus::new(bounds, 0.75, model.scene.bounding_box()).unwrap();
    (model, focus, 100.0 + 500.0 * 0.8)
}

fn shoot(model: &Model, lines: u64, focus: Option<Focus>, seed: u64) -> Shot {
    let lines = LocalLines { count: lines, focus };
    run_stage::<FirstShot<'_>>(ShotSettings::new(model, lines, seed), ()).unwrap()
}

fn batches(model: &Model, shot: Shot, lines: u64, domain: GlobalLines, seed: u64) -> Transported {
    run_stage::<Batches<'_>>(BatchSettings::new(model, domain, lines, seed), shot).unwrap()
}

/// Returns the mean irradiance of the patches of a material, and its error if the errors of patches are independent.
fn of_material(model: &Model, irradiance: &[Rgb], error: &[Rgb], material: usize) -> (f64, f64) {
    let (mut area, mut sum, mut square) = (0.0, 0.0, 0.0);
    model.mesh.for_each_side(|triangle, _, _, side| {
        if model.scene.triangle(triangle).material.index() == material {
            let a = model.area(triangle, side);
            area += a;
            sum += a * irradiance[side.index()].x;
            square += (a * error[side.index()].x).powi(2);
        }
    });
    (sum / area, square.sqrt() / area)
}

#[test]
fn sky_and_sun_on_a_square_in_a_field() {
    const LINES: u64 = 100_000;
    let (model, focus, exact) = square();
    let power: f64 = sources(&model.scene, &model.mesh).iter().map(|source| source.power.x).sum();
    let mut errors = Vec::new();
    for focus in [None, Some(focus)] {
        let (mut squares, mut stated) = (0.0, 0.0);
        for seed in 1..=40 {
            let shot = shoot(&model, LINES, focus, seed);
            assert!(shot.balance.closes());
            let emitted = shot.unit.watts(shot.balance.emitted).x;
            // Each source has an integer number of lines, and those that pass around the focus carry more power.
            let lines = if focus.is_some() { 2e-4 } else { 1e-6 };
            assert!((emitted / power - 1.0).abs() < lines, "{emitted} of {power}");
            let solution = shot.solution(&model);
            for (material, exact) in [(0, exact), (1, exact * (3_600.0 - 1.0) / 3_600.0)] {
                let (value, error) = of_material(&model, &solution.irradiance, &solution.error, material);
                // The ground under the edges of the square still sees some sky from the side.
                let tolerance = if material == 0 { 4.5 * error } else { 4.5 * error + 0.001 * exact };
                assert!((value - exact).abs() <= tolerance, "{material}: {value} ± {error}, exactly {exact}");
                if material == 0 {
                    squares += ((value - exact) / error).powi(2) / 40.0;
                    stated += error / 40.0;
                }
            }
        }
        println!("error {stated}, deviations {squares}");
        // χ² with 40 degrees of freedom. With a focus, a third of the lines of the sun meet the square, so the true
        // error is somewhat smaller than the stated one, which assumes a fixed total number of lines instead of a fixed
        // number per source.
        assert!(squares > 0.3 && squares < 2.0, "{squares}");
        errors.push(stated);
    }
    assert!(errors[0] > 8.0 * errors[1], "{errors:?}");
}

/// Returns a closed furnace on an emitting ground of a hundred times its surface. The irradiance in the furnace is
/// `M/(1 − ρ)`.
fn furnace() -> (Model, Focus) {
    let mut b = SceneBuilder::new();
    let wall = b.add_material(Material::diffuse("", Rgb::splat(0.7)).emitting(Rgb::ONE));
    let ground = b.add_material(Material::diffuse("", Rgb::splat(0.5)).emitting(Rgb::splat(20.0)));
    shapes::cuboid(&mut b, DVec3::ZERO, DVec3::ONE, [wall; 6], Facing::Inward);
    let at = |x: f64, y: f64| DVec3::new(x, y, -0.01);
    shapes::quad(&mut b, [at(-12.0, -12.0), at(13.0, -12.0), at(13.0, 13.0), at(-12.0, 13.0)], ground);
    let model = Model::new(scene(b), Subdivision::Triangles(PatchSize::MaxEdge(0.5))).unwrap();
    let bounds = BoundingBox { min: DVec3::ZERO, max: DVec3::ONE };
    let focus = Focus::new(bounds, 0.75, model.scene.bounding_box()).unwrap();
    (model, focus)
}

#[test]
fn a_furnace_on_a_wide_ground() {
    const LINES: u64 = 60_000;
    const SEEDS: u64 = 24;
    let (model, focus) = furnace();
    let exact = 1.0 / 0.3;
    let mut errors = Vec::new();
    for focus in [None, Some(focus)] {
        let domain = Domain::hull(model.scene.vertices());
        let through = focus.map_or(domain.clone().into(), |focus| GlobalLines::focused(domain, focus));
        let (mut squares, mut count, mut means, mut stated) = (0.0, 0.0, Vec::new(), 0.0);
        for seed in 1..=SEEDS {
            let shot = shoot(&model, LINES, focus, seed);
            let done = batches(&model, shot, LINES, through.clone(), seed);
            assert!(done.balance.closes());
            let solution = done.solution(&model);
            means.push(of_material(&model, &solution.irradiance, &solution.error, 0).0);
            model.mesh.for_each_side(|triangle, _, _, side| {
                if model.scene.triangle(triangle).material.index() == 0 {
                    let [value, error] = [solution.irradiance[side.index()], solution.error[side.index()]];
                    squares += ((value.x - exact) / error.x).powi(2);
                    stated += error.x;
                    count += 1.0;
                }
            });
        }
        let estimate = Estimate::of(means);
        println!("{estimate:?}, deviations {}, error {}", squares / count, stated / count);
        if focus.is_some() {
            estimate.assert_is(exact, "furnace");
            let spread = f64::sqrt(squares / count);
            assert!(spread > 0.85 && spread < 1.15, "{spread}");
        }
        errors.push(stated / count);
    }
    assert!(errors[0] > 3.0 * errors[1], "{errors:?}");
}
