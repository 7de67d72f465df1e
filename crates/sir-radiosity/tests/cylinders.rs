//! Cylindrical and semi-cylindrical sensors against exact irradiances, with a confidence of four standard errors.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "test helpers may panic and print")]

mod common;

use std::f64::consts::PI;

use common::gray;
use glam::DVec3;
use sir_geom::shapes::{self, Facing};
use sir_geom::{Light, LightKind, Rgb, SceneBuilder, Sides, Sky, SkyModel, Spread};
use sir_mesh::Subdivision;
use sir_radiosity::{Gatherer, Measurement, Model, REPLICATIONS, Sensor, SensorSettings, Solution};

const RAYS: SensorSettings = SensorSettings::new(16_384, 0.0);

const fn v(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

fn model(builder: SceneBuilder) -> Model {
    Model::new(builder.build().unwrap().scene, Subdivision::PerTriangle).unwrap()
}

/// Returns a solution with the same irradiance everywhere, without error.
fn uniform(model: &Model, irradiance: f64) -> Solution {
    let sides = model.mesh.side_count();
    Solution { irradiance: vec![Rgb::splat(irradiance); sides], error: vec![Rgb::ZERO; sides] }
}

/// Returns a whole and two half cylinders around z at a position.
fn cylinders(position: DVec3) -> [Sensor; 3] {
    [
        Sensor::cylindrical(position, DVec3::Z).unwrap(),
        Sensor::semi_cylindrical(position, v(0.0, 0.0, 2.0), v(1.0, 2.0, 5.0)).unwrap(),
        Sensor::semi_cylindrical(position, DVec3::Z, -DVec3::X).unwrap(),
    ]
}

#[track_caller]
fn assert_exact(measured: &Measurement, exact: f64, largest: f64) {
    let (value, sigma) = (measured.irradiance.x, measured.error().x);
    println!("{value:.6} ± {sigma:.6}, exact {exact:.6}");
    // A sensor in the same light from everywhere has no noise, only rounding errors.
    assert!((value - exact).abs() <= 4.0 * sigma + 1e-9 * exact, "{value} ± {sigma}, exact {exact}");
    assert!(sigma <= largest * exact, "{sigma}");
}

/// A small black triangle far below, because a scene has at least one surface.
fn open_space() -> SceneBuilder {
    let mut b = SceneBuilder::new();
    let black = b.add_material(gray(0.0, 0.0).with_sides(Sides::Both));
    shapes::quad(&mut b, [v(0., 0., -1e3), v(1e-3, 0., -1e3), v(1e-3, 1e-3, -1e3), v(0., 1e-3, -1e3)], black);
    b
}

/// Light of radiance `L` from everywhere gives `πL` to planes and cylinders. From a hemisphere around the axis it gives half
/// of that to cylinders, and from an overcast sky `L_z (π/6 + 4/9)`: `∫ (1 + 2 cos ε)/3 sin² ε dε dφ/π`.
#[test]
fn skies_are_measured_as_their_integrals() {
    let sky = |model, ground| Sky::new(DVec3::Z, model, Rgb::splat(20.0), Rgb::splat(ground)).unwrap();
    let zenith = 20.0 * 9.0 / (7.0 * PI);
    for (sky, exact) in [
        (Sky::everywhere(Rgb::splat(2.0)).unwrap(), 2.0 * PI),
        (sky(SkyModel::Uniform, 0.0), 10.0),
        (sky(SkyModel::Overcast, 0.0), zenith * (PI / 6.0 + 4.0 / 9.0)),
    ] {
        let mut b = open_space();
        b.set_sky(sky);
        let model = model(b);
        let solution = uniform(&model, 0.0);
        let gatherer = Gatherer::new(&model, &solution, RAYS, 1);
        for (i, sensor) in (0..).zip(cylinders(v(5.0, -3.0, 2.0))) {
            let measured = gatherer.measure(i, &sensor);
            assert_exact(&measured, exact, 1e-3);
            assert_eq!(measured.rays, 4 * 16_384);
        }
    }
}

/// `I sin ε/(π d²)`, and with the factor `1 + cos α` of a half cylinder (EN 13201-3).
#[test]
fn point_lights_are_exact() {
    let mut b = open_space();
    let lamp = v(1.0, 2.0, 4.0);
    let kind = LightKind::Point { position: lamp, intensity: Rgb::splat(1000.0), spread: Spread::Isotropic };
    b.add_light(Light { name: String::new(), kind });
    let model = model(b);
    let solution = uniform(&model, 0.0);
    let gatherer = Gatherer::new(&model, &solution, RAYS, 1);
    for position in [v(3.0, -1.0, 1.5), v(1.0, 2.5, 6.0), v(-4.0, 2.0, 4.0)] {
        let towards = lamp - position;
        let [sine, square] = [towards.truncate().length() / towards.length(), towards.length_squared()];
        let cosine = |x: f64, y: f64| towards.truncate().normalize().dot(glam::DVec2::new(x, y).normalize());
        let factors = [1.0, 1.0 + cosine(1.0, 2.0), 1.0 + cosine(-1.0, 0.0)];
        for (sensor, factor) in cylinders(position).into_iter().zip(factors) {
            let measured = gatherer.measure(0, &sensor);
            let exact = 1000.0 * sine * factor / (PI * square);
            // A lamp exactly behind a half cylinder gives nothing.
            assert!((measured.irradiance.x - exact).abs() <= 1e-9 * exact, "{measured:?}, exact {exact}");
            assert_eq!((measured.error(), measured.direct), (Rgb::ZERO, measured.irradiance));
        }
    }
}

#[test]
fn in_a_furnace_cylinders_measure_the_same_as_planes() {
    let mut b = SceneBuilder::new();
    let m = b.add_material(gray(3.0, 0.5));
    shapes::cuboid(&mut b, DVec3::ZERO, v(4.0, 4.0, 3.0), [m; 6], Facing::Inward);
    let model = model(b);
    let solution = uniform(&model, 6.0);
    let gatherer = Gatherer::new(&model, &solution, RAYS, 1);
    // In the middle, next to walls, and upright on the floor.
    for position in [v(2.0, 2.0, 1.2), v(0.01, 0.02, 1.0), v(1.0, 2.0, 0.0)] {
        cylinders(position).iter().for_each(|sensor| assert_exact(&gatherer.measure(0, sensor), 6.0, 1e-3));
    }
}

/// A room with a lamp above and a wall that reflects more than the others, under an open ceiling.
fn room() -> Model {
    let mut b = SceneBuilder::new();
    let [dark, bright, lamp] =
        [(0.0, 0.2), (0.0, 0.8), (100.0, 0.3)].map(|(m, r)| b.add_material(gray(m, r)));
    shapes::quad(&mut b, [v(0., 0., 0.), v(4., 0., 0.), v(4., 4., 0.), v(0., 4., 0.)], dark);
    shapes::quad(
        &mut b,
        [v(0., 4., 0.), v(0., 4., 3.), v(0., 0., 3.), v(0., 0., 0.)].map(|p| v(p.x, 4.0 - p.y, p.z)),
        bright,
    );
    shapes::quad(&mut b, [v(1.5, 2.5, 2.), v(2.5, 2.5, 2.), v(2.5, 1.5, 2.), v(1.5, 1.5, 2.)], lamp);
    b.set_sky(Sky::new(DVec3::Z, SkyModel::Overcast, Rgb::splat(20.0), Rgb::ZERO).unwrap());
    model(b)
}

#[test]
fn cylinders_are_means_of_vertical_planes() {
    const PLANES: u64 = 64;
    let model = room();
    let solution = uniform(&model, 50.0);
    let gatherer = Gatherer::new(&model, &solution, RAYS, 1);
    let position = v(1.0, 1.3, 0.8);
    let [whole, half] = [
        Sensor::cylindrical(position, DVec3::Z).unwrap(),
        Sensor::semi_cylindrical(position, DVec3::Z, DVec3::X).unwrap(),
    ];
    for (sensor, range) in [(whole, 2.0 * PI), (half, PI)] {
        let (mut sum, mut squares) = (0.0, 0.0);
        for i in 0..PLANES {
            let (sin, cos) = libm::sincos(range * ((i as f64 + 0.5) / PLANES as f64 - 0.5));
            let plane = gatherer.measure(1 + i, &Sensor::new(position, v(cos, sin, 0.0)).unwrap());
            sum += plane.irradiance.x / PLANES as f64;
            squares += plane.error().x * plane.error().x / (PLANES * PLANES) as f64;
        }
        let measured = gatherer.measure(0, &sensor);
        let sigma = libm::sqrt(squares + measured.error().x * measured.error().x);
        println!("{:.4} ± {:.4}, planes {sum:.4}", measured.irradiance.x, measured.error().x);
        assert!((measured.irradiance.x - sum).abs() < 4.0 * sigma, "{measured:?}, planes {sum}");
        assert!(measured.error().x < 0.003 * sum);
    }
}

/// Over 300 seeds, the deviations agree with the standard errors to 10 %, which is 2.4 standard deviations of a root mean
/// square of 300 numbers.
#[test]
fn standard_errors_are_honest() {
    let model = room();
    let solution = uniform(&model, 50.0);
    for sensor in cylinders(v(1.0, 1.3, 0.8)) {
        let settings = SensorSettings::new(1024, 0.0);
        let runs: Vec<Measurement> = (0..300)
            .map(|seed| Gatherer::new(&model, &solution, settings, seed).measure(0, &sensor))
            .collect();
        let n = runs.len() as f64;
        let mean = runs.iter().map(|m| m.irradiance.x).sum::<f64>() / n;
        let z = |m: &Measurement| (m.irradiance.x - mean) / m.error().x;
        // Corrects for the mean of `n` values, and for errors from a few replications (Student's t).
        let freedom = (REPLICATIONS - 1) as f64;
        let expected = (1.0 - 1.0 / n) * freedom / (freedom - 2.0);
        let rms = libm::sqrt(runs.iter().map(|m| z(m) * z(m)).sum::<f64>() / n / expected);
        println!("rms of the deviations: {rms:.3}");
        assert!((0.9..1.1).contains(&rms), "{rms}");
    }
}

/// Errors of patches count with the weights of their rays: those of a single patch that fills the view are passed on
/// entirely.
#[test]
fn errors_of_patches_are_passed_on() {
    let mut b = SceneBuilder::new();
    let m = b.add_material(gray(0.0, 0.5));
    shapes::quad(&mut b, [v(0., -1e6, -1e6), v(0., 1e6, -1e6), v(0., 1e6, 1e6), v(0., -1e6, 1e6)], m);
    let model = Model::new(b.build().unwrap().scene, Subdivision::PerFace).unwrap();
    let mut solution = uniform(&model, 6.0);
    solution.error.fill(Rgb::splat(0.6));
    let gatherer = Gatherer::new(&model, &solution, RAYS, 1);
    // Half of the view of a whole cylinder, all that a half cylinder faces and a part of the rest.
    let sensor = Sensor::cylindrical(v(1.0, 0.0, 0.0), DVec3::Z).unwrap();
    let measured = gatherer.measure(0, &sensor);
    assert!((measured.irradiance.x - 1.5).abs() < 0.01, "{measured:?}");
    assert!((measured.inherited.x - 0.15).abs() < 0.001, "{measured:?}");
}

#[test]
fn impossible_cylinders_are_refused() {
    let z = DVec3::Z;
    assert!(Sensor::semi_cylindrical(DVec3::ZERO, z, v(0.0, 1e-9, 3.0)).is_none());
    assert!(Sensor::semi_cylindrical(DVec3::ZERO, DVec3::ZERO, z).is_none());
    assert!(Sensor::cylindrical(DVec3::ZERO, DVec3::ZERO).is_none());
    assert!(Sensor::cylindrical(v(f64::NAN, 0.0, 0.0), z).is_none());
}
