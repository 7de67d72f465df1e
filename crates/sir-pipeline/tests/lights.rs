//! Lights of a pipeline: valid ones, and error messages.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use glam::DVec3;
use sir_geom::{Light, LightKind, Rgb, Sky, SkyModel, Spread};
use sir_pipeline::NoProgress;
use sir_pipeline::check::estimate;
use sir_pipeline::plan::{Action, Pipeline, SceneLight};

/// Returns the text of a pipeline with these lights.
fn text(lamps: &str) -> String {
    format!("(stages: [Load(path: \"room.obj\"),\nLight([{lamps}]),\nFirstShot(lines: 1000)])")
}

/// Parses a pipeline in a folder with a dark room, and passes the outcome to `f`.
fn with<T>(text: &str, f: impl FnOnce(Result<Pipeline, String>) -> T) -> T {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("room.obj"), "v 0 0 0\nv 0 0 1\nv 1 0 0\nf 1 2 3\n").unwrap();
    let pipeline = Pipeline::parse(text, &folder.path().join("x.ron"));
    f(pipeline.map_err(|e| e.to_string().replace(&format!("{}/", folder.path().display()), "")))
}

fn lamps(lamps: &str) -> Vec<SceneLight> {
    with(&text(lamps), |pipeline| match &pipeline.unwrap().stages[1].action {
        Action::Light(light) => {
            light.lamps.iter().flat_map(|lamp| lamp.to_scene(DVec3::Y).unwrap()).collect()
        }
        other => unreachable!("{other:?}"),
    })
}

fn problems(lamps: &str) -> String {
    with(&text(lamps), |pipeline| pipeline.unwrap_err())
}

#[test]
fn all_kinds_of_lights_are_understood() {
    let (down, gray) = (-DVec3::Y, Rgb::splat);
    let light = |kind| SceneLight::Light(Light { name: String::new(), kind });
    let position = DVec3::new(1.0, 2.0, 3.0);
    let point = |intensity, spread| light(LightKind::Point { position, intensity, spread });
    let found = lamps(
        "Point(position: (1, 2, 3), intensity: (3, 2, 1)),
        Point(position: (1, 2, 3), power: 2, spread: Lambertian(axis: (0, -3, 0))),
        Point(position: (1, 2, 3), intensity: 5, spread: Spot(axis: (0, -1, 0), inner: 60, outer: 90)),
        Distant(direction: (0, -2, 0), irradiance: 7),
        Panel(corner: (0, 1, 0), edges: ((2, 0, 0), (0, 0, 3)), power: 12),
        Sky(model: Cie(type: 12, sun: (0, 5, 0)), horizontal: (1, 2, 3), ground: 1)",
    );
    let sky = SkyModel::General { kind: 12, sun: DVec3::Y };
    let sky = Sky::new(DVec3::Y, sky, Rgb::new(1.0, 2.0, 3.0), Rgb::ONE).unwrap();
    assert_eq!(
        [&found[..2], &found[3..]].concat(),
        [
            point(Rgb::new(3.0, 2.0, 1.0), Spread::Isotropic),
            point(gray(2.0 / std::f64::consts::PI), Spread::Lambertian { axis: down }),
            light(LightKind::Distant { direction: down, irradiance: gray(7.0) }),
            SceneLight::Panel {
                corner: DVec3::Y,
                edges: [DVec3::X * 2.0, DVec3::Z * 3.0],
                exitance: gray(2.0)
            },
            SceneLight::Sky(sky),
        ]
    );
    let SceneLight::Light(Light {
        kind: LightKind::Point { spread: Spread::Spot { inner, outer, .. }, .. },
        ..
    }) = found[2]
    else {
        unreachable!("{:?}", found[2]);
    };
    assert!((inner - 0.5).abs() < 1e-15 && outer.abs() < 1e-15);
    assert_eq!(lamps("Environment(radiance: 3)"), [SceneLight::Sky(Sky::everywhere(gray(3.0)).unwrap())]);
    let uniform = Sky::new(DVec3::Z, SkyModel::Uniform, gray(2.0), Rgb::ZERO).unwrap();
    assert_eq!(lamps("Sky(up: (0, 0, 1), horizontal: 2)"), [SceneLight::Sky(uniform)]);
}

#[test]
fn mistakes_are_reported_with_their_places() {
    insta::assert_snapshot!(problems(
        "Lamp(position: (1, 2, 3)),
        Point(position: (1, 2), intensity: 1),
        Point(position: (1, 2, 3)),
        Point(position: (1, 2, 3), intensity: 1, power: 1),
        Point(position: (1, 2, 3), intensity: -1, spread: Spot(axis: (0, 0, 0), inner: 10, outer: 20)),
        Point(position: (1, 2, 3), intensity: 1, spread: Spot(axis: (0, 0, 1), inner: 30, outer: 20)),
        Point(position: (1, 2, 3), intensity: 1, spread: Wide, color: 1)"
    ));
    insta::assert_snapshot!(problems(
        "Distant(direction: (0, 0, 0), irradiance: (1, 2)),
        Panel(corner: (0, 0, 0), edges: ((1, 0, 0), (2, 0, 0)), power: 1),
        Panel(corner: (0, 0, 0), edges: (1, 0, 0), exitance: 1),
        Panel(corner: (0, 0, 0), edges: ((1, 0, 0), (0, 1, 0)), exitence: 1),
        Sky(model: Cie(type: 16, sun: (0, 1, 0)), horizontal: 1),
        Sky(model: Cie(type: 1, sun: (0, -1, 0)), horizontal: 1),
        Sky(model: Clear),
        Sky(horizontal: 1), Environment(radiance: 1)"
    ));
    let order = "(stages: [Load(path: \"room.obj\"),\nFirstShot(lines: 1),\nLight([Sky(horizontal: 1)]),\nLight([])])";
    insta::assert_snapshot!(with(order, |pipeline| pipeline.unwrap_err()));
}

/// Lights a dark scene. The summary lists the sources.
#[test]
fn a_dark_scene_is_lit_by_a_pipeline() {
    let all = "Point(position: (0.1, 2, 0.2), intensity: 1), Distant(direction: (0, -1, 0), irradiance: 8),
        Panel(corner: (0, 3, 0), edges: ((1, 0, 0), (0, 0, 1)), power: 5), Environment(radiance: 1)";
    with(&text(all), |pipeline| {
        let estimate = estimate(&pipeline.unwrap(), &NoProgress).unwrap();
        let shown = estimate.to_string();
        assert!(shown.contains("2 triangle sides, 1 point, 1 distant light, sky, ground, "), "{shown}");
        assert_eq!(estimate.prepared.model.scene.triangles().len(), 3);
    });
    with(&text("Sky(horizontal: 0)"), |pipeline| {
        let error = estimate(&pipeline.unwrap(), &NoProgress).unwrap_err();
        assert!(error.chain().contains("nothing in the scene emits light"), "{}", error.chain());
    });
}
