//! Irradiance probes against exact answers, and their errors.
#![allow(clippy::unwrap_used, reason = "test helpers may panic")]

mod common;

use std::f64::consts::PI;

use common::{gray, shoot};
use glam::DVec3;
use sir_geom::shapes::{self, Facing};
use sir_geom::{Light, LightKind, Rgb, SceneBuilder, Sky, SkyModel, Spread};
use sir_mesh::{PatchSize, Subdivision};
use sir_radiosity::{
    COSINE_FACTORS, Gatherer, HARMONICS, Model, ProbeGatherer, ProbeMeasurement, Sensor, SensorSettings,
    Solution, harmonics, share_of_backs, sum_of_harmonics,
};

const AXES: [DVec3; 6] = [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z];

const fn v(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

fn model(builder: SceneBuilder) -> Model {
    Model::new(builder.build().unwrap().scene, Subdivision::PerTriangle).unwrap()
}

fn dark(model: &Model) -> Solution {
    Solution::dark(model.mesh.side_count())
}

/// Returns the coefficients of the irradiance by light from one direction.
fn of_direction(direction: DVec3, irradiance: f64) -> [f64; HARMONICS] {
    let values = harmonics(direction);
    std::array::from_fn(|i| irradiance * COSINE_FACTORS[i] * values[i])
}

/// A black cube at the origin, with edges of 0.2 m.
fn black_cube() -> SceneBuilder {
    let mut builder = SceneBuilder::new();
    let black = builder.add_material(gray(0.0, 0.0));
    shapes::cuboid(&mut builder, DVec3::splat(-0.1), DVec3::splat(0.1), [black; 6], Facing::Outward);
    builder
}

/// A room of 4 by 5 by 3 m with a lamp under its ceiling and walls of different reflectance.
fn room() -> Model {
    let mut builder = SceneBuilder::new();
    let walls = [0.8, 0.3, 0.5, 0.7, 0.2, 0.6].map(|rho| builder.add_material(gray(0.0, rho)));
    shapes::cuboid(&mut builder, DVec3::ZERO, v(4.0, 5.0, 3.0), walls, Facing::Inward);
    let lamp = builder.add_material(gray(100.0, 0.0));
    shapes::quad(&mut builder, [v(1., 1., 2.9), v(1., 2., 2.9), v(2., 2., 2.9), v(2., 1., 2.9)], lamp);
    let size = PatchSize::MaxEdge(1.0);
    Model::new(builder.build().unwrap().scene, Subdivision::Surfaces(size)).unwrap()
}

#[test]
fn in_constant_radiance_only_the_mean_is_left() {
    // Emission 1 and reflectance 1/2 everywhere: the irradiance of all surfaces is 2.
    let mut builder = SceneBuilder::new();
    let walls = builder.add_material(gray(1.0, 0.5));
    shapes::cuboid(&mut builder, DVec3::ZERO, v(2.0, 3.0, 2.0), [walls; 6], Facing::Inward);
    let model = model(builder);
    let sides = model.mesh.side_count();
    let solution = Solution { irradiance: vec![Rgb::splat(2.0); sides], error: vec![Rgb::ZERO; sides] };
    let probes = ProbeGatherer::new(&model, &solution, SensorSettings::new(4096, 0.0), 1);
    let measured = probes.measure(0, v(0.5, 1.0, 1.2));
    for (i, (value, error)) in measured.coefficients().iter().zip(measured.coefficient_errors()).enumerate() {
        let exact = if i == 0 { 2.0 * (4.0 * PI).sqrt() } else { 0.0 };
        assert!((value.x - exact).abs() < 4.0 * error.x && error.x < 0.02, "{i}: {value} ± {error}");
    }
    for (value, error) in measured.axes().iter().zip(measured.axis_errors()) {
        assert!((value.x - 2.0).abs() < 4.0 * error.x && error.x < 0.01, "{value} ± {error}");
    }
    let mean = measured.mean();
    assert!((mean.irradiance.x - 2.0).abs() < 4.0 * mean.error().x);
    // Emission 1 of a radiosity of 2 is direct.
    assert!((mean.direct.x - 1.0).abs() < 0.01, "{}", mean.direct);
}

#[test]
fn lights_without_a_surface_are_exact() {
    let mut builder = black_cube();
    let position = v(2.0, -1.0, 3.0);
    let kind = LightKind::Point { position, intensity: Rgb::new(5.0, 6.0, 7.0), spread: Spread::Isotropic };
    builder.add_light(Light { name: String::new(), kind });
    let model = model(builder);
    let solution = dark(&model);
    let probes = ProbeGatherer::new(&model, &solution, SensorSettings::new(64, 0.0), 1);
    let at = v(1.0, 0.5, 0.8);
    let measured = probes.measure(0, at);
    let to = position - at;
    let exact = of_direction(to.normalize(), 6.0 / to.length_squared());
    for ((value, error), exact) in
        measured.coefficients().iter().zip(measured.coefficient_errors()).zip(exact)
    {
        assert!((value.y - exact).abs() < 1e-14 && error.y == 0.0, "{value} ± {error}, exact {exact}");
    }
    for (value, axis) in measured.axes().iter().zip(AXES) {
        let exact = 7.0 * axis.dot(to).max(0.0) / (to.length_squared() * to.length());
        assert!((value.z - exact).abs() < 1e-14, "{value}, exact {exact}");
    }
    // In the shadow of the cube.
    let dark = probes.measure(1, v(-2.0, 1.0, -3.0));
    assert_eq!(dark.coefficients(), [Rgb::ZERO; HARMONICS]);
}

/// A square of 2 cm, seen from all around it at distances of about 2 m, is almost a point.
#[test]
fn small_lamps_are_like_points() {
    let mut builder = black_cube();
    let lamp = builder.add_material(gray(1e4, 0.0));
    let corners = [v(-0.01, -0.01, 1.0), v(0.01, -0.01, 1.0), v(0.01, 0.01, 1.0), v(-0.01, 0.01, 1.0)];
    shapes::quad(&mut builder, corners, lamp);
    let model = model(builder);
    let solution = dark(&model);
    let probes = ProbeGatherer::new(&model, &solution, SensorSettings::new(2048, 0.0), 1);
    for (number, at) in (0..).zip([v(1.0, 0.3, 2.5), v(-0.7, 1.1, 2.0), v(0.0, 0.0, 3.0), v(-1.0, -1.0, 1.5)])
    {
        let measured = probes.measure(number, at);
        let to = v(0.0, 0.0, 1.0) - at;
        // Exitance 10⁴, area 4 cm².
        let irradiance = 1e4 * 4e-4 / PI * -to.z / (to.length_squared() * to.length());
        let exact = of_direction(to.normalize(), irradiance);
        for ((value, error), exact) in
            measured.coefficients().iter().zip(measured.coefficient_errors()).zip(exact)
        {
            let allowed = 4.0 * error.x + 1e-4 * irradiance;
            assert!((value.x - exact).abs() < allowed, "{at}: {value} ± {error}, exact {exact}");
            assert!(error.x < 0.01 * irradiance, "{at}: {value} ± {error}");
        }
    }
}

/// In a room with a lamp, the irradiances along the axes are those of sensors, and nine coefficients contain most of the
/// irradiance in all directions.
#[test]
fn probes_agree_with_sensors() {
    let model = room();
    let solution = shoot(&model, 100_000, 1).solution(&model);
    let settings = SensorSettings::new(8192, 0.0);
    let (probes, sensors) =
        (ProbeGatherer::new(&model, &solution, settings, 1), Gatherer::new(&model, &solution, settings, 2));
    let at = v(1.2, 2.5, 1.2);
    let measured = probes.measure(0, at);
    let directions = AXES.into_iter().chain([v(1.0, 1.0, 1.0), v(-1.0, 2.0, 0.5), v(1.0, -2.0, -3.0)]);
    let mean = measured.mean().irradiance.x;
    for (number, direction) in (0..).zip(directions) {
        let sensor = sensors.measure(number, &Sensor::new(at, direction).unwrap());
        if let Some(axis) = measured.axes().get(number as usize) {
            let error = measured.axis_errors()[number as usize].x.hypot(sensor.sampling.x);
            assert!((axis.x - sensor.irradiance.x).abs() < 4.0 * error, "{axis} {}", sensor.irradiance);
        }
        let sum = sum_of_harmonics(&measured.coefficients(), direction.normalize()).x;
        assert!((sum - sensor.irradiance.x).abs() < 0.1 * mean, "{direction}: {sum} {}", sensor.irradiance);
    }
}

/// A sky whose radiance is one harmonic plus a constant: an overcast sky has degrees above 2, which must not leak.
#[test]
fn higher_degrees_do_not_leak_into_the_coefficients() {
    let mut builder = black_cube();
    let sky = Sky::new(DVec3::Z, SkyModel::Overcast, Rgb::ONE, Rgb::ZERO).unwrap();
    builder.set_sky(sky);
    let model = model(builder);
    let sky = model.scene.sky().unwrap();
    let solution = dark(&model);
    let probes = ProbeGatherer::new(&model, &solution, SensorSettings::new(1 << 16, 0.0), 1);
    // From 100 m away, the cube covers a millionth of the view.
    let measured = probes.measure(0, v(60.0, 80.0, 0.0));
    let mut exact = [0.0; HARMONICS];
    let (rings, segments) = (4_000u32, 16u32);
    for ring in 0..rings {
        let z = 2.0 * (f64::from(ring) + 0.5) / f64::from(rings) - 1.0;
        for k in 0..segments {
            let (sin, cos) = (2.0 * PI * (f64::from(k) + 0.5) / f64::from(segments)).sin_cos();
            let rho = (1.0 - z * z).sqrt();
            let direction = v(rho * cos, rho * sin, z);
            let part = sky.radiance(direction).x * 4.0 * PI / f64::from(rings * segments);
            let terms = exact.iter_mut().zip(of_direction(direction, part));
            terms.for_each(|(sum, term)| *sum += term);
        }
    }
    for ((value, error), exact) in
        measured.coefficients().iter().zip(measured.coefficient_errors()).zip(exact)
    {
        let allowed = 4.0 * error.x + 1e-5;
        assert!((value.x - exact).abs() < allowed && error.x < 1e-3, "{value} ± {error}, exact {exact}");
    }
}

/// Stated errors of all quantities over many seeds: the mean of ((value − mean)/σ)² is near 1.
#[test]
fn stated_errors_are_those_of_the_spread_over_seeds() {
    let model = room();
    let mut solution = shoot(&model, 100_000, 1).solution(&model);
    // Only the choice of rays varies.
    solution.error.fill(Rgb::ZERO);
    let seeds = 200;
    let at = v(1.2, 2.5, 1.2);
    let of_seed = |seed: u64| {
        ProbeGatherer::new(&model, &solution, SensorSettings::new(512, 0.0), seed).measure(seed, at)
    };
    let measured: Vec<ProbeMeasurement> = (0..seeds).map(of_seed).collect();
    let numbers = |m: &ProbeMeasurement| -> Vec<(f64, f64)> {
        let coefficients = m.coefficients().into_iter().zip(m.coefficient_errors());
        let axes = m.axes().into_iter().zip(m.axis_errors());
        coefficients.chain(axes).map(|(value, error)| (value.x, error.x)).collect()
    };
    let all: Vec<Vec<(f64, f64)>> = measured.iter().map(numbers).collect();
    let n = seeds as f64;
    for quantity in 0..HARMONICS + 6 {
        let mean = all.iter().map(|m| m[quantity].0).sum::<f64>() / n;
        let spread = all.iter().map(|m| (m[quantity].0 - mean).powi(2)).sum::<f64>() / (n - 1.0);
        let stated = all.iter().map(|m| m[quantity].1.powi(2)).sum::<f64>() / n;
        let ratio = (spread / stated).sqrt();
        // The spread of 200 values is known to 5 %.
        assert!((0.8..1.2).contains(&ratio), "{quantity}: {ratio}");
    }
}

#[test]
fn a_target_error_ends_early() {
    let model = room();
    let solution = shoot(&model, 100_000, 1).solution(&model);
    let rays = |error| {
        let settings = SensorSettings::new(1 << 16, error);
        ProbeGatherer::new(&model, &solution, settings, 1).measure(0, v(1.2, 2.5, 1.2)).rays
    };
    assert_eq!(rays(0.0), 6 << 16);
    assert!(rays(0.05) < 6 << 14);
}

#[test]
fn backs_are_seen_inside_solids_and_behind_walls() {
    let model = room();
    let mut tracer = model.accel.tracer();
    let mut share = |position| share_of_backs(position, 1e-3, &model, &mut tracer);
    // In the room only the lamp shows its back, from above.
    assert_eq!(share(v(3.5, 4.0, 1.0)), Some(0.0));
    assert!(share(v(1.5, 1.5, 2.95)).unwrap() > 0.4);
    // Outside of the room there is nothing but backs, and from far away no ray hits them.
    assert_eq!(share(v(-0.1, 2.5, 1.5)), Some(1.0));
    assert_eq!(share(v(-5.0, 8.0, 6.0)), Some(1.0));
    assert_eq!(share(v(-1000.0, 2.5, 1.5)), Some(0.0));
    let corners =
        (0..8).map(|i| v(4.0, 5.0, 3.0) * v(f64::from(i % 2), f64::from(i / 2 % 2), f64::from(i / 4)));
    let others = [v(0.0, 2.5, 1.5), v(2.0, 0.0, 0.0), v(1.5, 1.5, 2.9), v(1.0, 1.0, 2.9), v(4.0, 1.5, 0.0)];
    for on_a_surface in corners.chain(others) {
        assert_eq!(share(on_a_surface), None, "{on_a_surface}");
    }
    let cube = model_of_cube();
    let mut tracer = cube.accel.tracer();
    assert_eq!(share_of_backs(v(0.02, -0.03, 0.01), 1e-3, &cube, &mut tracer), Some(1.0));
}

fn model_of_cube() -> Model {
    model(black_cube())
}

/// Measurements on surfaces, in edges, in corners and on lamps are meaningless, but finite.
#[test]
fn probes_on_surfaces_are_finite() {
    let model = room();
    let solution = shoot(&model, 10_000, 1).solution(&model);
    let probes = ProbeGatherer::new(&model, &solution, SensorSettings::new(256, 0.0), 1);
    for (number, at) in
        (0..).zip([v(0.0, 2.5, 1.5), v(4.0, 5.0, 3.0), v(2.0, 0.0, 0.0), v(1.5, 1.5, 2.9), v(1.0, 1.0, 2.9)])
    {
        let measured = probes.measure(number, at);
        let all = measured.coefficients().into_iter().chain(measured.axes());
        assert!(all.chain(measured.coefficient_errors()).all(Rgb::is_finite), "{at}: {measured:?}");
    }
}
