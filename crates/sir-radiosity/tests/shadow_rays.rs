//! Shadow rays know the direct light that a first shot knows.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "test helpers may panic and print")]

use glam::DVec3;
use sir_geom::shapes::{self, Facing};
use sir_geom::{Light, LightKind, Material, Rgb, Scene, SceneBuilder, Sides, Sky, Spread};
use sir_lines::{Focus, LocalLines};
use sir_mesh::{PatchSize, SideId, Subdivision};
use sir_radiosity::{
    FirstShot, Model, OneWorker, Points, ShadowRaySettings, ShadowRays, Shot, ShotSettings, run_stage,
};

mod common;

use common::gray;

fn shot(model: &Model, lines: u64, seed: u64) -> Shot {
    run_stage::<FirstShot<'_>>(ShotSettings::new(model, lines, seed), ()).unwrap()
}

fn settings(model: &Model, points: u64, seed: u64) -> ShadowRaySettings<'_> {
    let rays = LocalLines { count: points * model.mesh.side_count() as u64, focus: None };
    ShadowRaySettings { model, rays, seed, points: Points::Random, every: 1 }
}

fn gather(settings: ShadowRaySettings<'_>, shot: &Shot) -> Shot {
    run_stage::<ShadowRays<'_>>(settings, shot.clone()).unwrap().0
}

/// A room with a ball in it. Lamps of all kinds are added by the caller.
fn room(lamps: impl FnOnce(&mut SceneBuilder), open: bool) -> Scene {
    let mut builder = SceneBuilder::new();
    let wall = builder.add_material(gray(0.0, 0.5));
    let ball = builder.add_material(gray(0.0, 0.5).with_sides(Sides::Both));
    let size = DVec3::new(3.0, 2.0, 2.5);
    if open {
        // Without a ceiling.
        let corners =
            [DVec3::ZERO, DVec3::new(3.0, 0.0, 0.0), DVec3::new(3.0, 2.0, 0.0), DVec3::new(0.0, 2.0, 0.0)];
        let corners = corners.map(|corner| builder.add_vertex(corner));
        builder.add_polygon(&corners, wall);
    } else {
        shapes::cuboid(&mut builder, DVec3::ZERO, size, [wall; 6], Facing::Inward);
    }
    shapes::sphere(&mut builder, DVec3::new(1.2, 0.9, 0.8), 0.4, 2, Facing::Outward, |_| ball);
    lamps(&mut builder);
    builder.build().unwrap().scene
}

fn add_lamp(builder: &mut SceneBuilder, corners: [DVec3; 4], material: Material) {
    let material = builder.add_material(material);
    let corners = corners.map(|corner| builder.add_vertex(corner));
    builder.add_polygon(&corners, material);
}

/// A lamp under the ceiling that touches a wall.
fn cove(builder: &mut SceneBuilder) {
    let corners = [[0.0, 0.2], [0.0, 1.8], [0.5, 1.8], [0.5, 0.2]].map(|[x, y]| DVec3::new(x, y, 2.45));
    add_lamp(builder, corners, gray(3.0, 0.2));
}

fn rooms() -> Vec<(&'static str, Scene)> {
    let color = Rgb::new(5.0, 3.0, 1.0);
    let light = |kind| Light { name: String::new(), kind };
    let at =
        |x, y, z, spread| light(LightKind::Point { position: DVec3::new(x, y, z), intensity: color, spread });
    let sun = light(LightKind::Distant {
        direction: DVec3::new(0.36, 0.48, -0.8),
        irradiance: Rgb::new(2.0, 2.0, 1.5),
    });
    vec![
        ("cove", room(cove, false)),
        (
            "lamps and lights",
            room(
                |builder| {
                    cove(builder);
                    let corners = [[1.0, 0.5], [1.0, 0.6], [1.1, 0.6], [1.1, 0.5]];
                    let corners = corners.map(|[x, y]| DVec3::new(x, y, 1.5));
                    add_lamp(builder, corners, gray(40.0, 0.0).with_sides(Sides::Both));
                    builder.add_light(at(2.5, 1.0, 2.0, Spread::Isotropic));
                    builder.add_light(at(0.5, 1.0, 2.0, Spread::Lambertian { axis: -DVec3::Z }));
                    let spot = Spread::spot(DVec3::new(0.0, 0.6, -0.8), 0.3, 0.6).unwrap();
                    builder.add_light(at(2.0, 0.5, 2.0, spot));
                },
                false,
            ),
        ),
        (
            "sun and sky",
            room(
                |builder| {
                    builder.add_light(sun);
                    builder.set_sky(Sky::everywhere(Rgb::new(0.2, 0.3, 0.4)).unwrap());
                },
                true,
            ),
        ),
    ]
}

#[test]
fn rays_and_lines_agree_within_their_errors() {
    for (name, scene) in rooms() {
        for subdivision in [Subdivision::Triangles(PatchSize::Count(800)), Subdivision::PerFace] {
            let model = Model::new(scene.clone(), subdivision).unwrap();
            let lines = shot(&model, 2_000_000, 1);
            let rays = gather(settings(&model, 256, 2), &lines);
            let (mut sum, mut squares, mut n) = (0.0, 0.0, 0.0);
            for band in 0..3 {
                for side in 0..model.mesh.side_count() {
                    let [a, b] = [&lines, &rays].map(|shot| shot.received.power[side].0[band] as f64);
                    let variance = [&lines, &rays].map(|shot| f64::from(shot.received.variance[side][band]));
                    let sigma = variance.iter().sum::<f64>().sqrt();
                    // Where few lines arrive, the errors that they state are uncertain.
                    let per_line = lines.balance.emitted.0[band] as f64 / lines.counts.lines as f64;
                    if a > 300.0 * per_line {
                        let z = (b - a) / sigma;
                        assert!(z.abs() < 6.0, "{name}, {subdivision:?}: side {side}, {a} and {b} ± {sigma}");
                        sum += z;
                        squares += z * z;
                        n += 1.0;
                    }
                }
            }
            let (mean, rms) = (sum / n, (squares / n).sqrt());
            println!("{name}, {subdivision:?}: {n} values, z {mean:.3}, rms {rms:.3}");
            // Bands have the same rays.
            assert!(mean.abs() < 4.0 * (3.0 / n).sqrt() && (0.85..1.15).contains(&rms), "{mean} {rms}");
        }
    }
}

#[test]
fn what_is_reflected_is_that_of_the_lines() {
    let (_, scene) = rooms().swap_remove(1);
    let model = Model::new(scene, Subdivision::Triangles(PatchSize::Count(500))).unwrap();
    let lines = shot(&model, 20_000, 1);
    let rays = gather(settings(&model, 4, 2), &lines);
    assert_ne!(lines.received.power, rays.received.power);
    assert_eq!(lines.unshot(&model, &OneWorker), rays.unshot(&model, &OneWorker));
    let second = |shot| common::shoot_again(&model, shot, 20_000, 3);
    let (of_lines, of_rays) = (second(&lines), second(&rays));
    assert_eq!(of_lines.unshot(&model, &OneWorker), of_rays.unshot(&model, &OneWorker));
}

#[test]
fn there_are_rays_in_the_focus_only() {
    let (_, scene) = rooms().swap_remove(0);
    let model = Model::new(scene, Subdivision::Triangles(PatchSize::Count(2000))).unwrap();
    let bounds = sir_geom::BoundingBox { min: DVec3::new(1.5, 0.5, -0.1), max: DVec3::new(3.1, 1.5, 1.0) };
    let focus = Focus::new(bounds, 0.5, model.scene.bounding_box()).unwrap();
    let lines = shot(&model, 20_000, 1);
    let of_all = settings(&model, 4, 2);
    let settings = ShadowRaySettings { rays: LocalLines { focus: Some(focus), ..of_all.rays }, ..of_all };
    let rays = gather(settings, &lines);
    let in_focus = sir_radiosity::FocusSides::of(&model, Some(&focus));
    let mut inside = 0;
    for side in 0..model.mesh.side_count() {
        let differs = lines.received.power[side] != rays.received.power[side];
        assert!(!differs || in_focus.contains(SideId::new(side)));
        inside += usize::from(differs);
    }
    assert!(inside > 50, "{inside}");
    let every = gather(ShadowRaySettings { every: 7, ..of_all }, &lines);
    let changed =
        (0..model.mesh.side_count()).filter(|&s| every.received.power[s] != lines.received.power[s]);
    assert!(changed.clone().all(|side| side % 7 == 0) && changed.count() > 200);
}

/// Few points of a large patch would find the spot that a close lamp lights.
#[test]
fn patches_close_to_a_small_lamp_keep_the_light_of_lines() {
    let lamp = DVec3::new(1.9, 1.1, 0.001);
    let spread = Spread::Lambertian { axis: -DVec3::Z };
    let kind = LightKind::Point { position: lamp, intensity: Rgb::ONE, spread };
    let scene = room(|builder| builder.add_light(Light { name: String::new(), kind }), false);
    let model = Model::new(scene, Subdivision::Triangles(PatchSize::Count(800))).unwrap();
    let lines = shot(&model, 20_000, 1);
    let rays = gather(settings(&model, 4, 2), &lines);
    let brightest = (0..model.mesh.side_count()).max_by_key(|&side| lines.received.power[side].0[0]).unwrap();
    assert_eq!(lines.received.power[brightest], rays.received.power[brightest]);
    let same = (0..model.mesh.side_count()).filter(|&side| {
        lines.received.power[side] == rays.received.power[side] && lines.received.power[side].0[0] > 0
    });
    assert!(same.count() < 10);
}

/// The noise of a few rays is far below that of as many lines where there is one lamp, even where it touches a wall.
#[test]
fn one_lamp_is_known_better_by_rays() {
    let (_, scene) = rooms().swap_remove(0);
    let model = Model::new(scene, Subdivision::Triangles(PatchSize::Count(800))).unwrap();
    let exact = gather(settings(&model, 2000, 9), &shot(&model, 1000, 1));
    let square = |shot: &Shot| -> f64 {
        let pairs = shot.received.power.iter().zip(&exact.received.power);
        pairs.map(|(a, b)| (a.0[0] - b.0[0]) as f64).map(|d| d * d).sum()
    };
    let count = 16 * model.mesh.side_count() as u64;
    let (lines, rays) = (shot(&model, count, 5), gather(settings(&model, 16, 6), &shot(&model, 1000, 1)));
    let even = gather(ShadowRaySettings { points: Points::Sobol, ..settings(&model, 16, 6) }, &lines);
    let [of_lines, of_rays, of_even] = [lines, rays, even].map(|shot| square(&shot));
    println!("{:.2} {:.2}", of_lines / of_rays, of_rays / of_even);
    assert!(of_lines > 1.5 * of_rays && of_rays > 1.5 * of_even, "{of_lines} {of_rays} {of_even}");
}
