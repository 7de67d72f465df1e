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

/// Returns the light groups of a pipeline with these lights on a scene with a lamp and a glTF light, or the errors.
fn groups_of(lamps: &str) -> String {
    const SCENE: &str = r#"{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
        "extensionsUsed": ["KHR_lights_punctual"],
        "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "name": "Spot.001"}]}},
        "nodes": [{"mesh": 0}, {"extensions": {"KHR_lights_punctual": {"light": 0}}, "translation": [0, 1, 0]}],
        "materials": [{"name": "Lamp", "emissiveFactor": [1, 1, 1]}, {"name": "Wall"}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0},
            {"attributes": {"POSITION": 0}, "material": 1}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
            "min": [0, 0, 0], "max": [1, 0, 1]}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "buffers": [{"byteLength": 36,
            "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAAAAAAAAAAAAAIA/AACAPwAAAAAAAAAA"}]}"#;
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("room.gltf"), SCENE).unwrap();
    let text = text(lamps).replace("room.obj", "room.gltf");
    let pipeline = Pipeline::parse(&text, &folder.path().join("x.ron")).unwrap();
    match estimate(&pipeline, &NoProgress) {
        Ok(estimate) => {
            let groups = estimate.prepared.groups.iter();
            groups.map(|group| format!("{} {:.3}", group.name, group.power.x)).collect::<Vec<_>>().join(", ")
        }
        Err(error) => {
            let lines = error.to_string();
            let lines = lines.lines().filter(|line| line.contains("error:") || line.contains("help:"));
            lines.map(str::trim).collect::<Vec<_>>().join("; ")
        }
    }
}

#[test]
fn groups_have_lights_of_the_scene_and_of_the_pipeline() {
    for (lamps, groups) in [
        (r#"Group(name: "a", materials: ["Lamp"])"#, "a 1.571, other 12.566"),
        (r#"Group(name: "a", materials: ["Lamp"], lights: ["Spot.001"])"#, "a 14.137"),
        (
            r#"Panel(corner: (0, 2, 0), edges: ((1, 0, 0), (0, 0, 1)), power: 5, group: "b"),
                Group(name: "a", lights: ["Spot.001"]), Point(position: (0, 3, 0), power: 7, group: "a")"#,
            "b 5.000, a 19.566, other 1.571",
        ),
        (r#"Point(position: (0, 3, 0), power: 7, group: "other")"#, "other 21.137"),
    ] {
        assert_eq!(groups_of(lamps), groups);
    }
}

#[test]
fn groups_of_what_is_not_there_are_refused() {
    for (lamps, problem) in [
        (
            r#"Group(name: "a", materials: ["Lmp"])"#,
            "error: the scene file has no material with the name \"Lmp\"; = help: did you mean `Lamp`?",
        ),
        (
            r#"Group(name: "a", lights: ["Ceiling"])"#,
            "error: the scene file has no light with the name \"Ceiling\"; = help: its lights are `Spot.001`",
        ),
        (
            r#"Group(name: "a", materials: ["Wall"])"#,
            "error: the material \"Wall\" emits nothing; = help: its emitting materials are `Lamp`",
        ),
        (
            r#"Group(name: "a", materials: ["Lamp"]), Group(name: "b", materials: ["Lamp"])"#,
            "error: the material \"Lamp\" is in the groups \"a\" and \"b\"; = help: keep it in one of them",
        ),
        (
            r#"Point(position: (0, 3, 0), power: 0, group: "dark")"#,
            "error: the light group \"dark\" emits nothing; = help: give one of its lights a power above zero, or leave the group out",
        ),
    ] {
        let shown = groups_of(lamps);
        assert!(shown.starts_with(problem), "{lamps}: {shown}");
    }
    let shown = problems(r#"Group(materials: "Lamp"), Point(position: (0, 1, 0), power: 1, group: 3)"#);
    for problem in [
        "`Group` lacks the field `name`",
        "`materials` must be a list of names, but it is a string",
        "`group` must be a string in quotes, but it is the number 3",
    ] {
        assert!(shown.contains(problem), "{shown}");
    }
}
