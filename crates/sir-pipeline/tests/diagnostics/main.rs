//! Diagnostics of invalid pipeline files.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod fields;
mod names;
mod order;
mod syntax;

use std::fs;

use sir_pipeline::Units;
use sir_pipeline::plan::{Action, DomainKind, Pipeline, Replicas, Transport};
use sir_pipeline::text::Diagnostics;

const VALID: &str = r#"// A comment with ( and "
Pipeline(
    seed: 7, /* and [ another */
    stages: [
        Load(path: "room.obj", sides: Both),
        Light([
            Point(position: (1, 2, 3), power: 60, spread: Spot(axis: (0, -1, 0), inner: 5, outer: 30)),
            Distant(direction: (1, -2, 0), irradiance: (3, 2, 1)),
            Panel(corner: (0, 1, 0), edges: ((1, 0, 0), (0, 0, 1)), exitance: 5),
        ]),
        Subdivide(patches: 20_000),
        FirstShot(lines: 1e6),
        Multipath(lines: 1_300_000, domain: Sphere, transport: Replicas(count: 1, tail: 0)),
        Save([
            Image(path: "view.png", width: 640, height: 480, samples: 2, exposure: Auto, camera: 0),
            Image(path: "own.exr", exposure: Some(1.5), camera: Camera(eye: (1, 2, 3), target: (0, 0, 0.5), up: (0, 0, 1), fov: 60)),
            Gltf(path: r"result.glb"),
            Table(path: "tables/patches.csv"),
        ]),
    ],
) // the end"#;

/// Parses a pipeline in a folder with the scene `room.obj`.
fn parse(text: &str) -> Result<Pipeline, Diagnostics> {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("room.obj"), "").unwrap();
    Pipeline::parse(text, &folder.path().join("x.ron"))
}

/// Returns the problems as displayed, without the folder.
fn problems(text: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("room.obj"), "").unwrap();
    let shown = Pipeline::parse(text, &folder.path().join("x.ron")).unwrap_err().to_string();
    shown.replace(&format!("{}/", folder.path().display()), "")
}

/// Returns the problems of a pipeline with the given stages, one per line.
fn stages(lines: &[&str]) -> String {
    problems(&format!("(stages: [\n{}\n])", lines.join("\n")))
}

#[test]
fn a_valid_pipeline_is_understood() {
    let pipeline = parse(VALID).unwrap();
    assert_eq!(pipeline.seed, 7);
    let names: Vec<_> = pipeline.stages.iter().map(|s| s.action.name()).collect();
    assert_eq!(names, ["Load", "Light", "Subdivide", "FirstShot", "Multipath", "Save"]);
    for stage in &pipeline.stages {
        assert_eq!(&VALID[stage.span.0.clone()], stage.action.name());
    }
    let multipath = |fields: &str| {
        let text = format!(
            r#"(stages: [Load(path: "room.obj"), FirstShot(lines: 9), Multipath(lines: 100{fields})])"#
        );
        match &parse(&text).unwrap().stages[2].action {
            Action::Multipath(multipath) => (multipath.transport.clone(), multipath.domain),
            _ => unreachable!("the third stage is Multipath"),
        }
    };
    let transport = |fields: &str| multipath(fields).0;
    let replicas = |count, tail| Transport::Replicas(Replicas { count, tail });
    assert_eq!(transport(""), Transport::Batches);
    assert_eq!(transport(", transport: Batches"), Transport::Batches);
    assert_eq!(transport(", transport: Replicas"), replicas(1, None));
    assert_eq!(transport(", transport: Replicas(count: 8)"), replicas(8, None));
    assert_eq!(transport(", transport: Replicas(tail: 0)"), replicas(1, Some(0)));
    for (fields, body) in [
        ("", DomainKind::Hull),
        (", domain: Hull", DomainKind::Hull),
        (", domain: Box", DomainKind::Box),
        (", domain: Sphere", DomainKind::Sphere),
    ] {
        assert_eq!(multipath(fields).1, body);
    }
    let outputs: Vec<_> = pipeline.outputs().map(|o| o.path().to_str().unwrap()).collect();
    assert_eq!(outputs, ["view.png", "own.exr", "result.glb", "tables/patches.csv"]);
    assert!(pipeline.scene_path().is_file() || pipeline.scene_path().ends_with("room.obj"));
}

#[test]
fn what_is_left_out_has_a_default() {
    let short =
        r#"(stages: [Load(path: "room.obj"), FirstShot(lines: 10), Save([Image(path: "view.png")])])"#;
    let long = r#"Pipeline(seed: 1, stages: [Load(path: "room.obj", sides: AsAuthored), FirstShot(lines: 10),
        Save(Image(path: "view.png", width: 800, height: None, samples: 4, exposure: Auto))])"#;
    let (short, long) = (parse(short).unwrap(), parse(long).unwrap());
    assert_eq!(short.seed, long.seed);
    let actions = |p: &Pipeline| format!("{:?}", p.outputs().collect::<Vec<_>>());
    assert_eq!(actions(&short), actions(&long));
}

#[test]
fn units_are_radiometric_unless_the_file_says_otherwise() {
    let text = |fields: &str| format!(r#"({fields}stages: [Load(path: "room.obj"), FirstShot(lines: 1)])"#);
    let units = |fields: &str| parse(&text(fields)).unwrap().units;
    assert_eq!(units(""), Units::Radiometric);
    assert_eq!(units("units: Photometric, "), Units::Photometric);
    insta::assert_snapshot!(problems(&text("units: Photometrik, ")), @"
    error: `units` must be `Radiometric` or `Photometric`, but it is `Photometrik`
     --> x.ron:1:9
      |
    1 | (units: Photometrik, stages: [Load(path: \"room.obj\"), FirstShot(lines: 1)])
      |         ^^^^^^^^^^^
      |
      = help: did you mean `Photometric`?
    ");
}

#[test]
fn a_comment_may_end_the_file() {
    assert!(parse(r#"(stages: [Load(path: "room.obj"), FirstShot(lines: 10)]) // end"#).is_ok());
}
