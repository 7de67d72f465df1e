//! Light without a surface against exact solutions: the power that each surface receives is exact within four standard
//! errors of the number of lines that meet it. Sections are those of CIE 171:2006.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod common;

use std::f64::consts::PI;

use common::{batches, gray, received, shoot};
use glam::DVec3;
use sir_geom::shapes::{Facing, cuboid, quad};
use sir_geom::{Light, LightKind, Rgb, SceneBuilder, Sky, SkyModel, Spread};
use sir_mesh::{PatchSize, Subdivision};
use sir_radiosity::{FirstShot, Model, Shot, ShotSettings, run_stage, sources};

const LINES: u64 = 400_000;

fn point(position: DVec3, intensity: f64, spread: Spread) -> Light {
    let kind = LightKind::Point { position, intensity: Rgb::splat(intensity), spread };
    Light { name: String::new(), kind }
}

fn model(builder: SceneBuilder, subdivision: Subdivision) -> Model {
    Model::new(builder.build().unwrap().scene, subdivision).unwrap()
}

/// Adds a rectangle from `corner`, with a black material of its own. Its front faces the direction of `a × b`.
fn rectangle(builder: &mut SceneBuilder, corner: DVec3, a: DVec3, b: DVec3) {
    let material = builder.add_material(gray(0.0, 0.0));
    quad(builder, [corner, corner + a, corner + a + b, corner + b], material);
}

/// Adds the inside of a box from the origin without its ceiling: the floor, and the walls at x = 0, x, y = 0, y.
fn open_box(builder: &mut SceneBuilder, size: DVec3) {
    let [x, y, z] = [DVec3::X * size.x, DVec3::Y * size.y, DVec3::Z * size.z];
    rectangle(builder, DVec3::ZERO, x, y);
    rectangle(builder, DVec3::ZERO, y, z);
    rectangle(builder, x, z, y);
    rectangle(builder, DVec3::ZERO, z, x);
    rectangle(builder, y, x, z);
}

/// Traces a first shot, compares the power that materials receive with the exact power, and returns the shot.
fn compare(model: &Model, exact: &[f64], what: &str) -> Shot {
    let shot = shoot(model, LINES, 7);
    assert!(shot.balance.closes());
    let emitted = shot.unit.watts(shot.balance.emitted).x;
    let total: f64 = sources(&model.scene, &model.mesh).iter().map(|s| s.power.x).sum();
    assert!((emitted / total - 1.0).abs() < 1e-9, "{what}: {emitted} of {total}");
    for (k, (found, exact)) in received(model, &shot).into_iter().zip(exact).enumerate() {
        let share = exact / total;
        let sigma = total * (share * (1.0 - share) / LINES as f64).sqrt();
        assert!(
            (found - exact).abs() <= 4.0 * sigma + 1e-9,
            "{what}, {k}: {found}, exactly {exact} ± {sigma}"
        );
    }
    shot
}

/// 5.2: patches of a plane under a small Lambertian source receive `∫ I h²/(x² + y² + h²)² dA`. The deviations of all
/// patches are χ²-distributed.
#[test]
fn cie_5_2_a_lambertian_point_over_a_plane() {
    let (intensity, h) = (1000.0, 3.0);
    let mut b = SceneBuilder::new();
    rectangle(&mut b, DVec3::new(-2.0, -2.0, 0.0), DVec3::X * 4.0, DVec3::Y * 4.0);
    b.add_light(point(DVec3::Z * h, intensity, Spread::Lambertian { axis: -DVec3::Z }));
    let model = model(b, Subdivision::Triangles(PatchSize::MaxEdge(0.5)));
    let shot = shoot(&model, LINES, 1);
    let power = PI * intensity;
    assert!((shot.unit.watts(shot.balance.emitted).x / power - 1.0).abs() < 1e-9);
    let (mut chi, mut patches) = (0.0, 0.0);
    model.mesh.for_each_side(|triangle, patch, _, side| {
        let corners = model.mesh.single_triangle(triangle, patch).unwrap();
        let corners = corners.map(|c| c.point(model.scene.corners(triangle)));
        let lines = LINES as f64
            * integral(corners, |p| intensity * h * h / (p.length_squared() + h * h).powi(2))
            / power;
        let found = LINES as f64 * shot.unit.watts(shot.received.power[side.index()]).x / power;
        chi += (found - lines).powi(2) / lines;
        patches += 1.0;
    });
    assert!(patches >= 100.0);
    assert!((chi - patches).abs() < 4.0 * (2.0 * patches).sqrt(), "χ² = {chi} of {patches}");
    // The point directly below: 111.11 lx.
    let solution = shot.solution(&model);
    let mut nearest = (f64::INFINITY, 0.0);
    model.mesh.for_each_side(|triangle, patch, _, side| {
        let distance = model.mesh.center(&model.scene, triangle, patch).length();
        if distance < nearest.0 {
            nearest = (distance, solution.irradiance[side.index()].x);
        }
    });
    assert!((nearest.1 / 111.11 - 1.0).abs() < 0.1, "{nearest:?}");
}

/// Returns an integral over a triangle, from the centers of 32² congruent parts.
fn integral([a, b, c]: [DVec3; 3], f: impl Fn(DVec3) -> f64) -> f64 {
    let n = 32;
    let at = |i: f64, k: f64| f(a + (b - a) * (i / f64::from(n)) + (c - a) * (k / f64::from(n)));
    let mut sum = 0.0;
    for i in 0..n {
        for k in 0..n - i {
            let (i, k) = (f64::from(i), f64::from(k));
            sum += at(i + 1.0 / 3.0, k + 1.0 / 3.0);
            if i + k < f64::from(n) - 1.5 {
                sum += at(i + 2.0 / 3.0, k + 2.0 / 3.0);
            }
        }
    }
    sum * 0.5 * (b - a).cross(c - a).length() / f64::from(n * n)
}

/// 5.4: solid angles of the walls of a closed room. Ω of a rectangle is the sum of `atan(ab / d√(a² + b² + d²))` over
/// its four parts.
#[test]
fn cie_5_4_an_isotropic_point_in_a_room() {
    let (size, lamp) = (DVec3::new(4.0, 4.0, 3.0), DVec3::new(1.0, 2.5, 1.25));
    let mut b = SceneBuilder::new();
    let faces = [0; 6].map(|_| b.add_material(gray(0.0, 0.0)));
    cuboid(&mut b, DVec3::ZERO, size, faces, Facing::Inward);
    b.add_light(point(lamp, 10_000.0 / (4.0 * PI), Spread::Isotropic));
    let model = model(b, Subdivision::PerTriangle);
    let exact: Vec<f64> = faces
        .iter()
        .map(|face| {
            let triangle = model.scene.triangle_ids().find(|&t| model.scene.triangle(t).material == *face);
            let normal = model.scene.normal(triangle.unwrap());
            let axis = (0..3).find(|&k| normal[k].abs() > 0.5).unwrap();
            let d = if normal[axis] > 0.0 { lamp[axis] } else { size[axis] - lamp[axis] };
            let extents = |k: usize| [lamp[k], size[k] - lamp[k]];
            let mut omega = 0.0;
            for a in extents((axis + 1) % 3) {
                for b in extents((axis + 2) % 3) {
                    omega += (a * b / (d * (a * a + b * b + d * d).sqrt())).atan();
                }
            }
            10_000.0 * omega / (4.0 * PI)
        })
        .collect();
    assert!((exact.iter().sum::<f64>() / 10_000.0 - 1.0).abs() < 1e-12);
    let shot = compare(&model, &exact, "room");
    assert_eq!(shot.counts.empty, 0);
}

/// A spot on the axis of a square that lies in its inner cone, above a plane that receives all of its light.
#[test]
fn a_spot_is_full_in_its_inner_cone_and_has_its_power() {
    let (intensity, h, half) = (500.0, 2.0, 0.2);
    let (inner, outer) = (20f64.to_radians().cos(), 40f64.to_radians().cos());
    let mut b = SceneBuilder::new();
    rectangle(&mut b, DVec3::new(-half, -half, 0.0), DVec3::X * 2.0 * half, DVec3::Y * 2.0 * half);
    rectangle(&mut b, DVec3::new(-5.0, -5.0, -0.01), DVec3::X * 10.0, DVec3::Y * 10.0);
    b.add_light(point(DVec3::Z * h, intensity, Spread::Spot { axis: -DVec3::Z, inner, outer }));
    let model = model(b, Subdivision::PerTriangle);
    let square = 4.0 * (half * half / (h * (2.0 * half * half + h * h).sqrt())).atan();
    let power = 2.0 * PI * ((1.0 - inner) + (inner - outer) / 3.0);
    let exact = [square, power - square].map(|omega| intensity * omega);
    compare(&model, &exact, "spot");
}

/// A tilted square receives the cosine, one in its shadow nothing, and the back of a third absorbs its part.
#[test]
fn parallel_light_falls_by_the_cosine_and_casts_shadows() {
    let (tilt, irradiance) = (0.6f64, 800.0);
    let (across, along) = (DVec3::X, DVec3::new(0.0, tilt.cos(), tilt.sin()));
    let mut b = SceneBuilder::new();
    rectangle(&mut b, DVec3::ZERO, across, along);
    rectangle(&mut b, DVec3::new(0.1, 0.1 * tilt.cos(), -3.0), across * 0.8, DVec3::Y * 0.8 * tilt.cos());
    rectangle(&mut b, DVec3::new(4.0, 0.0, 1.0), DVec3::Y, DVec3::X);
    let direction = -DVec3::Z;
    b.add_light(Light {
        name: String::new(),
        kind: LightKind::Distant { direction, irradiance: Rgb::splat(irradiance) },
    });
    let model = model(b, Subdivision::PerTriangle);
    let shot = compare(&model, &[irradiance * tilt.cos(), 0.0, 0.0], "parallel");
    let blocked = shot.unit.watts(shot.balance.blocked).x;
    assert!((blocked / irradiance - 1.0).abs() < 0.01, "{blocked}");
    // Lines that miss all of them have escaped.
    let outside = shot.unit.watts(shot.balance.escaped).x;
    let box_area = 5.0;
    assert!((outside / (irradiance * (box_area - 1.0 - tilt.cos())) - 1.0).abs() < 0.01, "{outside}");
}

/// One square under a sky: horizontal, tilted and upright. A uniform sky gives `E_h (1 + cos β)/2`, a uniform ground
/// `π L (1 − cos β)/2`, an overcast sky on an upright surface `E_h 3/(7π) (π/2 + 4/3)`.
#[test]
fn open_squares_get_what_the_sky_sends() {
    let (horizontal, ground) = (1000.0, 50.0);
    let sky = |model| Sky::new(DVec3::Z, model, Rgb::splat(horizontal), Rgb::splat(ground)).unwrap();
    let sun = DVec3::new(0.6, 0.0, 0.8);
    let upright = horizontal * 3.0 / (7.0 * PI) * (PI / 2.0 + 4.0 / 3.0);
    for (name, model_of_sky, tilt, from_sky) in [
        ("uniform", SkyModel::Uniform, 0.0, horizontal),
        ("uniform, tilted", SkyModel::Uniform, 0.9, horizontal * (1.0 + 0.9f64.cos()) / 2.0),
        ("overcast", SkyModel::Overcast, 0.0, horizontal),
        ("overcast, upright", SkyModel::Overcast, PI / 2.0, upright),
        ("clear", SkyModel::General { kind: 12, sun }, 0.0, horizontal),
        ("turbid", SkyModel::General { kind: 15, sun }, 0.0, horizontal),
    ] {
        let mut b = SceneBuilder::new();
        rectangle(&mut b, DVec3::ZERO, DVec3::X, DVec3::new(0.0, tilt.cos(), tilt.sin()));
        b.set_sky(sky(model_of_sky));
        let model = model(b, Subdivision::PerTriangle);
        compare(&model, &[from_sky + PI * ground * (1.0 - tilt.cos()) / 2.0], name);
    }
}

/// 5.4: of the flux of a uniform sky through the open roof, or through a hole of a square meter in it, the floor
/// receives the share given by the view factor, and the walls the rest.
#[test]
fn cie_5_4_sky_through_a_roof_opening() {
    let size = DVec3::new(4.0, 4.0, 3.0);
    for (edge, floor) in [(4.0, 0.282_732_787_397_47), (1.0, 0.352_336_037_100_085)] {
        let mut b = SceneBuilder::new();
        open_box(&mut b, size);
        if edge < 4.0 {
            let rim = 0.5 * (4.0 - edge);
            let (far, top) = (4.0 - rim, DVec3::Z * size.z);
            for (corner, a, c) in [
                (top, DVec3::Y * 4.0, DVec3::X * rim),
                (top + DVec3::X * far, DVec3::Y * 4.0, DVec3::X * rim),
                (top + DVec3::X * rim, DVec3::Y * rim, DVec3::X * edge),
                (top + DVec3::new(rim, far, 0.0), DVec3::Y * rim, DVec3::X * edge),
            ] {
                rectangle(&mut b, corner, a, c);
            }
        }
        b.set_sky(Sky::new(DVec3::Z, SkyModel::Uniform, Rgb::splat(100.0), Rgb::ZERO).unwrap());
        let model = model(b, Subdivision::PerTriangle);
        let flux = 100.0 * edge * edge;
        let wall = 0.25 * (1.0 - floor);
        compare(
            &model,
            &[floor, wall, wall, wall, wall].map(|share| share * flux),
            &format!("opening {edge}"),
        );
    }
}

/// In a closed room no light is lost: the mean irradiance is `Φ/(A (1 − ρ))`, wherever the lamp is.
#[test]
fn a_furnace_with_a_point_light() {
    let (rho, power) = (0.8, 100.0);
    let mut b = SceneBuilder::new();
    let walls = b.add_material(gray(0.0, rho));
    cuboid(&mut b, DVec3::ZERO, DVec3::new(2.0, 1.0, 1.0), [walls; 6], Facing::Inward);
    b.add_light(point(DVec3::new(0.5, 0.5, 0.4), power / (4.0 * PI), Spread::Isotropic));
    let model = model(b, Subdivision::Triangles(PatchSize::Count(200)));
    let shot = shoot(&model, 100_000, 3);
    let solution = batches(&model, shot, 400_000, 3).solution(&model);
    let (mut area, mut sum) = (0.0, 0.0);
    model.mesh.for_each_side(|triangle, patch, _, side| {
        let a = model.mesh.patch_area(triangle, patch);
        area += a;
        sum += a * solution.irradiance[side.index()].x;
    });
    let exact = power / (area * (1.0 - rho));
    assert!((sum / area / exact - 1.0).abs() < 2e-3, "{} of {exact}", sum / area);
}

/// Lights without power are not sources, and a scene with only such lights has no light.
#[test]
fn lights_without_power_are_no_sources() {
    let mut b = SceneBuilder::new();
    rectangle(&mut b, DVec3::ZERO, DVec3::X, DVec3::Y);
    // Parallel to the only surface, so that no light enters the box.
    let kind = LightKind::Distant { direction: DVec3::X, irradiance: Rgb::ONE };
    b.add_light(Light { name: String::new(), kind });
    b.add_light(point(DVec3::Z, 0.0, Spread::Isotropic));
    b.set_sky(Sky::new(DVec3::Z, SkyModel::Uniform, Rgb::ZERO, Rgb::ZERO).unwrap());
    let model = model(b, Subdivision::PerTriangle);
    assert!(sources(&model.scene, &model.mesh).is_empty());
    assert!(run_stage::<FirstShot<'_>>(ShotSettings::new(&model, 10, 1), ()).is_err());
}
