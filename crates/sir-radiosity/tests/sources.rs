//! Powers: those that can be computed, and those that are refused.

#![allow(clippy::unwrap_used, reason = "test helpers may panic")]

mod common;

use common::{batches, gray, scene, shoot};
use glam::DVec3;
use sir_geom::shapes::{self, Facing};
use sir_geom::{Light, LightKind, Rgb, SceneBuilder, Spread};
use sir_mesh::Subdivision;
use sir_radiosity::{
    FirstShot, Gatherer, Model, POWERS, Sensor, SensorSettings, ShotSettings, SolveError, run_stage, sources,
    total_power,
};

/// Returns a room of one cubic meter with a lamp of this exitance as its ceiling.
fn room(exitance: f64) -> Model {
    let mut b = SceneBuilder::new();
    let (walls, lamp) = (b.add_material(gray(0.0, 0.5)), b.add_material(gray(exitance, 0.5)));
    shapes::cuboid(
        &mut b,
        DVec3::ZERO,
        DVec3::ONE,
        [walls, walls, walls, walls, walls, lamp],
        Facing::Inward,
    );
    Model::new(scene(b), Subdivision::PerTriangle).unwrap()
}

/// Powers of two scale all results exactly, up to the ends of the range.
#[test]
fn results_are_in_proportion_to_power() {
    let results = |exitance: f64| {
        let model = room(exitance);
        let solution = batches(&model, shoot(&model, 10_000, 1), 10_000, 2).solution(&model);
        let gatherer = Gatherer::new(&model, &solution, SensorSettings::new(1024, 0.0), 3);
        let sensor = Sensor::new(DVec3::new(0.5, 0.5, 0.1), DVec3::Z).unwrap();
        let measured = gatherer.measure(0, &sensor);
        let all: Vec<Rgb> = solution.irradiance.iter().chain(&solution.error).copied().collect();
        let sensor = [measured.irradiance, measured.error()];
        let all = all.into_iter().chain(sensor).map(|value| value / exitance);
        all.collect::<Vec<_>>()
    };
    let one = results(1.0);
    assert!(one.iter().all(|value| value.is_finite() && value.x > 0.0));
    let (least, most) = (libm::scalbn(1.0, -99), libm::scalbn(1.0, 99));
    assert!(POWERS.contains(&least) && !POWERS.contains(&(0.25 * least)));
    assert!(POWERS.contains(&most) && !POWERS.contains(&(4.0 * most)));
    assert_eq!(results(least), one);
    assert_eq!(results(most), one);
}

#[test]
fn impossible_powers_are_refused() {
    for exitance in [1e-300, 1e-31, 1e31, 1e155, 1e308] {
        let model = room(exitance);
        let error = run_stage::<FirstShot<'_>>(ShotSettings::new(&model, 100, 1), ()).unwrap_err();
        assert!(matches!(error, SolveError::Power { .. }), "{exitance}: {error}");
        assert_eq!(total_power(&sources(&model.scene, &model.mesh)), Err(error));
    }
    let error = SolveError::Power { watts: 1e308 };
    assert_eq!(
        error.to_string(),
        "the light sources of the scene emit 1.000e308 W together, but powers must be between 1e-30 and 1e30 W; \
         correct the emission of materials and lights, or give all of them in another unit"
    );
    assert_eq!(total_power(&[]), Err(SolveError::NoLight));
}

/// The product of finite numbers may be infinite.
#[test]
fn an_infinite_product_is_refused() {
    let mut b = SceneBuilder::new();
    let walls = b.add_material(gray(0.0, 0.5));
    shapes::cuboid(&mut b, DVec3::ZERO, DVec3::ONE, [walls; 6], Facing::Inward);
    let (position, intensity) = (DVec3::splat(0.5), Rgb::splat(1e308));
    let kind = LightKind::Point { position, intensity, spread: Spread::Isotropic };
    b.add_light(Light { name: "lamp".into(), kind });
    let model = Model::new(scene(b), Subdivision::PerTriangle).unwrap();
    let error = total_power(&sources(&model.scene, &model.mesh)).unwrap_err();
    assert_eq!(error, SolveError::Power { watts: f64::INFINITY });
}
