//! What a pipeline file with mistakes is answered with.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs;
use std::path::Path;

use proptest::prelude::*;
use sir_cli::diagnostic::Diagnostics;
use sir_cli::pipeline::{Action, Body, Pipeline, Transport};
use sir_cli::units::Units;

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
        Multipath(lines: 1_300_000, tail: 0, domain: Sphere, replicas: 1),
        Save([
            Image(path: "view.png", width: 640, height: 480, samples: 2, exposure: Auto, camera: 0),
            Image(path: "own.exr", exposure: Some(1.5), camera: Camera(eye: (1, 2, 3), target: (0, 0, 0.5), up: (0, 0, 1), fov: 60)),
            Gltf(path: r"result.glb"),
            Table(path: "tables/patches.csv"),
        ]),
    ],
) // the end"#;

/// Parses a pipeline that lies in a folder with the scene `room.obj`.
fn parse(text: &str) -> Result<Pipeline, Diagnostics> {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("room.obj"), "").unwrap();
    Pipeline::parse(text, &folder.path().join("x.ron"))
}

/// The problems as shown, without the folder.
fn problems(text: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("room.obj"), "").unwrap();
    let shown = Pipeline::parse(text, &folder.path().join("x.ron")).unwrap_err().to_string();
    shown.replace(&format!("{}/", folder.path().display()), "")
}

/// The problems of a pipeline with the given stages, each on its line.
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
        assert_eq!(&VALID[stage.span.clone()], stage.action.name());
    }
    let multipath = |fields: &str| {
        let text = format!(
            r#"(stages: [Load(path: "room.obj"), FirstShot(lines: 9), Multipath(lines: 100{fields})])"#
        );
        match parse(&text).unwrap().stages[2].action {
            Action::Multipath { transport, body, .. } => (transport, body),
            _ => unreachable!("the third stage is Multipath"),
        }
    };
    let transport = |fields: &str| multipath(fields).0;
    let replicas = |replicas, tail| Transport::Replicas { replicas, tail };
    assert_eq!(transport(""), Transport::Batches);
    assert_eq!(transport(", transport: Batches"), Transport::Batches);
    assert_eq!(transport(", transport: Replicas"), replicas(1, 10));
    assert_eq!(transport(", replicas: 8"), replicas(8, 10));
    assert_eq!(transport(", tail: 0"), replicas(1, 0));
    for (fields, body) in [
        ("", Body::Hull),
        (", domain: Hull", Body::Hull),
        (", domain: Box", Body::Box),
        (", domain: Sphere", Body::Sphere),
    ] {
        assert_eq!(multipath(fields).1, body);
    }
    let outputs: Vec<_> = pipeline.outputs().map(|o| o.path.to_str().unwrap()).collect();
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
    x.ron:1:9: error: `units` must be `Radiometric` or `Photometric`, but it is `Photometrik`
    1 | (units: Photometrik, stages: [Load(path: \"room.obj\"), FirstShot(lines: 1)])
      |         ^^^^^^^^^^^
      = help: did you mean `Photometric`?
    ");
}

#[test]
fn a_comment_may_end_the_file() {
    assert!(parse(r#"(stages: [Load(path: "room.obj"), FirstShot(lines: 10)]) // end"#).is_ok());
}

#[test]
fn unknown_names_and_fields() {
    insta::assert_snapshot!(stages(&[
        r#"Laod(path: "room.obj"),"#,
        r#"Load(path: "room.obj", side: Front, colour: 1),"#,
        r#"Firstshot(lines: 10),"#,
        r#"FirstShot(line: 10),"#,
        r#"Render,"#,
        r#"Save([Picture(path: "a.png"), Imgae(path: "b.png"), "c.png"]),"#,
    ]), @r#"
    x.ron:2:1: error: unknown stage `Laod`
    2 | Laod(path: "room.obj"),
      | ^^^^
      = help: did you mean `Load`?

    x.ron:3:24: error: unknown field `side` in `Load`
    3 | Load(path: "room.obj", side: Front, colour: 1),
      |                        ^^^^
      = help: did you mean `sides`?

    x.ron:3:37: error: unknown field `colour` in `Load`
    3 | Load(path: "room.obj", side: Front, colour: 1),
      |                                     ^^^^^^
      = help: `Load` has the fields `path` and `sides`

    x.ron:4:1: error: unknown stage `Firstshot`
    4 | Firstshot(lines: 10),
      | ^^^^^^^^^
      = help: did you mean `FirstShot`?

    x.ron:5:11: error: unknown field `line` in `FirstShot`
    5 | FirstShot(line: 10),
      |           ^^^^
      = help: did you mean `lines`?

    x.ron:6:1: error: unknown stage `Render`
    6 | Render,
      | ^^^^^^
      = help: stages are `Load`, `Light`, `Subdivide`, `Focus`, `FirstShot`, `SecondShot`, `Multipath`, `Repeat`, `Sensors` and `Save`

    x.ron:7:7: error: unknown output `Picture`
    7 | Save([Picture(path: "a.png"), Imgae(path: "b.png"), "c.png"]),
      |       ^^^^^^^
      = help: outputs are `Image`, `Gltf` and `Table`

    x.ron:7:31: error: unknown output `Imgae`
    7 | Save([Picture(path: "a.png"), Imgae(path: "b.png"), "c.png"]),
      |                               ^^^^^
      = help: did you mean `Image`?

    x.ron:7:53: error: expected one of the outputs, but this is a text
    7 | Save([Picture(path: "a.png"), Imgae(path: "b.png"), "c.png"]),
      |                                                     ^^^^^^^
      = help: outputs are `Image`, `Gltf` and `Table`
    "#);
    insta::assert_snapshot!(problems("Pipelin(stages: [])"), @r"
    x.ron:1:1: error: the file must hold `Pipeline(…)`, but it holds `Pipelin(…)`
    1 | Pipelin(stages: [])
      | ^^^^^^^^^^^^^^^^^^^
      = help: write `Pipeline(stages: […])`
    ");
    insta::assert_snapshot!(problems("[1]"), @r"
    x.ron:1:1: error: the file must hold `Pipeline(…)`, but it holds a list
    1 | [1]
      | ^^^
      = help: write `Pipeline(stages: […])`
    ");
}

#[test]
fn missing_and_repeated_fields() {
    insta::assert_snapshot!(stages(&[
        r#"Load(sides: Both),"#,
        r#"Subdivide,"#,
        r#"FirstShot(lines: 10, lines: 20),"#,
        r#"Multipath(),"#,
        r#"Save([Image(width: 10), Gltf(), Table(path: "")]),"#,
    ]), @r#"
    x.ron:2:1: error: `Load` lacks the field `path`
    2 | Load(sides: Both),
      | ^^^^
      = help: write `Load(path: "scene.gltf", …)`

    x.ron:3:1: error: `Subdivide` does not say how finely
    3 | Subdivide,
      | ^^^^^^^^^
      = help: write one of `patches: 20_000`, `max_area: 0.01`, `max_edge: 0.1` or `per_face: true`

    x.ron:4:22: error: the field `lines` is given twice
    4 | FirstShot(lines: 10, lines: 20),
      |                      ^^^^^
      = help: remove one of the two; the first is in line 4

    x.ron:5:1: error: `Multipath` lacks the field `lines`
    5 | Multipath(),
      | ^^^^^^^^^
      = help: write `Multipath(lines: 1_000_000, …)`

    x.ron:6:7: error: `Image` lacks the field `path`
    6 | Save([Image(width: 10), Gltf(), Table(path: "")]),
      |       ^^^^^
      = help: write `Image(path: "view.png", …)`

    x.ron:6:25: error: `Gltf` lacks the field `path`
    6 | Save([Image(width: 10), Gltf(), Table(path: "")]),
      |                         ^^^^
      = help: write `Gltf(path: "result.glb", …)`

    x.ron:6:45: error: `path` must be a text in quotes, but it is empty
    6 | Save([Image(width: 10), Gltf(), Table(path: "")]),
      |                                             ^^
      = help: write for instance `path: "result.csv"`
    "#);
    insta::assert_snapshot!(problems("(seed: 1)"), @r#"
    x.ron:1:1: error: `Pipeline` lacks the field `stages`
    1 | (seed: 1)
      | ^
      = help: write `Pipeline(stages: [Load(path: "scene.gltf"), …], …)`
    "#);
    insta::assert_snapshot!(problems("(seed: 1, stages: [])"), @r#"
    x.ron:1:19: error: the pipeline has no stages
    1 | (seed: 1, stages: [])
      |                   ^^
      = help: begin with `Load(path: "scene.gltf")`
    "#);
}

#[test]
fn wrong_types() {
    insta::assert_snapshot!(stages(&[
        r#"Load(path: 3, sides: "Both"),"#,
        r#"Subdivide(per_face: 4),"#,
        r#"FirstShot(10),"#,
        r#"Multipath(lines: "many", domain: Spher, replicas: 1.5),"#,
        r#"Save([Image(path: "a.png", exposure: Automatic, camera: true)]),"#,
        r#"Save(path: "b.png"),"#,
        r#"Save([Image(path: "c.png", camera: Camera(eye: 1, target: (1, 2, up), fov: "wide"))]),"#,
    ]), @r#"
    x.ron:2:12: error: `path` must be a text in quotes, but it is the number 3
    2 | Load(path: 3, sides: "Both"),
      |            ^
      = help: write for instance `path: "scene.gltf"`

    x.ron:2:22: error: `sides` must be `AsAuthored`, `Both` or `Front`, but it is a text
    2 | Load(path: 3, sides: "Both"),
      |                      ^^^^^^
      = help: write `AsAuthored`, `Both` or `Front`

    x.ron:3:21: error: `per_face` can only be `true`, but it is the number 4
    3 | Subdivide(per_face: 4),
      |                     ^
      = help: write `per_face: true`, or leave `Subdivide` out

    x.ron:4:1: error: `FirstShot` takes named fields, but this is `FirstShot(…)`
    4 | FirstShot(10),
      | ^^^^^^^^^^^^^
      = help: write `FirstShot(lines: …)`

    x.ron:5:18: error: `lines` must be a whole number from 1 to 1_000_000_000_000_000, but it is a text
    5 | Multipath(lines: "many", domain: Spher, replicas: 1.5),
      |                  ^^^^^^
      = help: write for instance `lines: 1_000_000`

    x.ron:5:34: error: `domain` must be `Hull`, `Box` or `Sphere`, but it is `Spher`
    5 | Multipath(lines: "many", domain: Spher, replicas: 1.5),
      |                                  ^^^^^
      = help: did you mean `Sphere`?

    x.ron:5:51: error: `replicas` must be a whole number from 1 to 1_000_000, but it is the number 1.5
    5 | Multipath(lines: "many", domain: Spher, replicas: 1.5),
      |                                                   ^^^
      = help: write for instance `replicas: 8`

    x.ron:6:38: error: `exposure` must be `Auto` or a number, but it is `Automatic`
    6 | Save([Image(path: "a.png", exposure: Automatic, camera: true)]),
      |                                      ^^^^^^^^^
      = help: write `exposure: Auto` or for instance `exposure: 1.0`

    x.ron:6:57: error: `camera` must be a `Camera(…)`, or the number or name of one, but it is `true`
    6 | Save([Image(path: "a.png", exposure: Automatic, camera: true)]),
      |                                                         ^^^^
      = help: write for instance `camera: 0` or `camera: Camera(eye: (1, 2, 5), target: (1, 1, 0))`

    x.ron:7:1: error: `Save` must have a list of outputs
    7 | Save(path: "b.png"),
      | ^^^^^^^^^^^^^^^^^^^
      = help: write `Save([Image(path: "view.png")])`

    x.ron:8:48: error: `eye` must be three numbers, but it is the number 1
    8 | Save([Image(path: "c.png", camera: Camera(eye: 1, target: (1, 2, up), fov: "wide"))]),
      |                                                ^
      = help: write for instance `eye: (1, 2, 5)`

    x.ron:8:66: error: `target` must be a finite number, but it is `up`
    8 | Save([Image(path: "c.png", camera: Camera(eye: 1, target: (1, 2, up), fov: "wide"))]),
      |                                                                  ^^
      = help: write for instance `target: (1, 1, 0)`

    x.ron:8:76: error: `fov` must be a finite number, but it is a text
    8 | Save([Image(path: "c.png", camera: Camera(eye: 1, target: (1, 2, up), fov: "wide"))]),
      |                                                                            ^^^^^^
      = help: write for instance `fov: 45`
    "#);
    insta::assert_snapshot!(problems("(seed: -1, stages: Load)"), @r"
    x.ron:1:8: error: `seed` must be a whole number from 0 to 18_446_744_073_709_551_615, but it is the number -1
    1 | (seed: -1, stages: Load)
      |        ^^
      = help: write for instance `seed: 1`

    x.ron:1:20: error: `stages` must be a list, but it is `Load`
    1 | (seed: -1, stages: Load)
      |                    ^^^^
      = help: write `stages: [Load(…), …]`
    ");
}

#[test]
fn numbers_out_of_range() {
    insta::assert_snapshot!(stages(&[
        r#"Load(path: "room.obj"),"#,
        r#"Subdivide(patches: 1e15),"#,
        r#"FirstShot(lines: 0),"#,
        r#"Multipath(lines: -5),"#,
        r#"Save([Image(path: "a.png", width: 0, height: 100_000, samples: 1.5, exposure: -1)]),"#,
        r#"Save([Image(path: "b.png", exposure: NaN, camera: Camera(eye: (0, 0, 0), target: (0, 0, inf), fov: 200))]),"#,
        r#"Save([Image(path: "c.png", camera: Camera(eye: (0, 0, 0), target: (0, 1, 0)))]),"#,
    ]), @r#"
    x.ron:3:20: error: `patches` must be a whole number from 1 to 4_294_967_295, but it is the number 1e15
    3 | Subdivide(patches: 1e15),
      |                    ^^^^
      = help: write for instance `patches: 20_000`

    x.ron:4:18: error: `lines` must be a whole number from 1 to 1_000_000_000_000_000, but it is the number 0
    4 | FirstShot(lines: 0),
      |                  ^
      = help: write for instance `lines: 1_000_000`

    x.ron:5:18: error: `lines` must be a whole number from 1 to 1_000_000_000_000_000, but it is the number -5
    5 | Multipath(lines: -5),
      |                  ^^
      = help: write for instance `lines: 1_000_000`

    x.ron:6:35: error: `width` must be a whole number from 1 to 16_384, but it is the number 0
    6 | Save([Image(path: "a.png", width: 0, height: 100_000, samples: 1.5, exposure: -1)]),
      |                                   ^
      = help: write for instance `width: 800`

    x.ron:6:46: error: `height` must be a whole number from 1 to 16_384, but it is the number 100_000
    6 | Save([Image(path: "a.png", width: 0, height: 100_000, samples: 1.5, exposure: -1)]),
      |                                              ^^^^^^^
      = help: write for instance `height: 600`

    x.ron:6:64: error: `samples` must be a whole number from 1 to 64, but it is the number 1.5
    6 | Save([Image(path: "a.png", width: 0, height: 100_000, samples: 1.5, exposure: -1)]),
      |                                                                ^^^
      = help: write for instance `samples: 4`

    x.ron:6:79: error: `exposure` must be above zero, but it is -1
    6 | Save([Image(path: "a.png", width: 0, height: 100_000, samples: 1.5, exposure: -1)]),
      |                                                                               ^^
      = help: write for instance `exposure: 1.0`

    x.ron:7:38: error: `exposure` must be a finite number, but it is the number NaN
    7 | Save([Image(path: "b.png", exposure: NaN, camera: Camera(eye: (0, 0, 0), target: (0, 0, inf), fov: 200))]),
      |                                      ^^^
      = help: write for instance `exposure: 1.0`

    x.ron:7:89: error: `target` must be a finite number, but it is the number inf
    7 | Save([Image(path: "b.png", exposure: NaN, camera: Camera(eye: (0, 0, 0), target: (0, 0, inf), fov: 200))]),
      |                                                                                         ^^^
      = help: write for instance `target: (1, 1, 0)`

    x.ron:7:100: error: `fov` must be below 180 degrees, but it is 200
    7 | Save([Image(path: "b.png", exposure: NaN, camera: Camera(eye: (0, 0, 0), target: (0, 0, inf), fov: 200))]),
      |                                                                                                    ^^^
      = help: write for instance `fov: 45`

    x.ron:8:36: error: this camera has no direction: `eye` and `target` coincide, or `up` points along the view
    8 | Save([Image(path: "c.png", camera: Camera(eye: (0, 0, 0), target: (0, 1, 0)))]),
      |                                    ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^
      = help: move `target` away from `eye`, and choose an `up` that is not parallel to the view
    "#);
    insta::assert_snapshot!(stages(&[
        r#"Load(path: "room.obj"), Subdivide(max_area: 0), FirstShot(lines: 1e16), Multipath(lines: 9, tail: 9)"#,
    ]), @r#"
    x.ron:2:45: error: `max_area` must be above zero, but it is 0
    2 | Load(path: "room.obj"), Subdivide(max_area: 0), FirstShot(lines: 1e16), Multipath(lines: 9, tail: 9)
      |                                             ^
      = help: write for instance `max_area: 0.01`

    x.ron:2:66: error: `lines` must be a whole number from 1 to 1_000_000_000_000_000, but it is the number 1e16
    2 | Load(path: "room.obj"), Subdivide(max_area: 0), FirstShot(lines: 1e16), Multipath(lines: 9, tail: 9)
      |                                                                  ^^^^
      = help: write for instance `lines: 1_000_000`

    x.ron:2:99: error: `tail` must be a whole number from 0 to 8, but it is the number 9
    2 | Load(path: "room.obj"), Subdivide(max_area: 0), FirstShot(lines: 1e16), Multipath(lines: 9, tail: 9)
      |                                                                                                   ^
      = help: write for instance `tail: 0`
    "#);
    insta::assert_snapshot!(stages(&[
        r#"Load(path: "room.obj"), Subdivide(max_edge: NaN, patches: 10), FirstShot(lines: 10),"#,
    ]), @r#"
    x.ron:2:25: error: `Subdivide` has both `patches` and `max_edge`
    2 | Load(path: "room.obj"), Subdivide(max_edge: NaN, patches: 10), FirstShot(lines: 10),
      |                         ^^^^^^^^^
      = help: keep one of them
    "#);
}

#[test]
fn what_one_transport_has_and_the_other_has_not() {
    insta::assert_snapshot!(stages(&[
        r#"Load(path: "room.obj"), FirstShot(lines: 10),"#,
        r#"Multipath(lines: 10, transport: Batches, replicas: 20, tail: 1)"#,
    ]), @r"
    x.ron:3:52: error: the transport `Batches` has no `replicas`
    3 | Multipath(lines: 10, transport: Batches, replicas: 20, tail: 1)
      |                                                    ^^
      = help: leave `replicas` out, or write `transport: Replicas`

    x.ron:3:52: error: `replicas` must be a whole number from 1 to 10, but it is the number 20
    3 | Multipath(lines: 10, transport: Batches, replicas: 20, tail: 1)
      |                                                    ^^
      = help: write for instance `replicas: 8`

    x.ron:3:62: error: the transport `Batches` has no `tail`
    3 | Multipath(lines: 10, transport: Batches, replicas: 20, tail: 1)
      |                                                              ^
      = help: leave `tail` out, or write `transport: Replicas`
    ");
}

#[test]
fn paths() {
    insta::assert_snapshot!(stages(&[
        r#"Load(path: "Room.obj"), FirstShot(lines: 10),"#,
        r#"Save([Image(path: "a.jpg"), Table(path: "t.txt"), Gltf(path: "x.gltf")]),"#,
        r#"Save([Image(path: "/tmp/a.png"), Image(path: "../a.png"), Image(path: "b.png"), Image(path: "./B.png")]),"#,
    ]), @r#"
    x.ron:2:12: error: the scene file Room.obj does not exist
    2 | Load(path: "Room.obj"), FirstShot(lines: 10),
      |            ^^^^^^^^^^
      = help: did you mean `room.obj`?

    x.ron:3:19: error: the name of the output "a.jpg" does not end in .png or .exr
    3 | Save([Image(path: "a.jpg"), Table(path: "t.txt"), Gltf(path: "x.gltf")]),
      |                   ^^^^^^^
      = help: write for instance `path: "result.png"`

    x.ron:3:41: error: the name of the output "t.txt" does not end in .csv or .npy
    3 | Save([Image(path: "a.jpg"), Table(path: "t.txt"), Gltf(path: "x.gltf")]),
      |                                         ^^^^^^^
      = help: write for instance `path: "result.csv"`

    x.ron:3:62: error: the name of the output "x.gltf" does not end in .glb
    3 | Save([Image(path: "a.jpg"), Table(path: "t.txt"), Gltf(path: "x.gltf")]),
      |                                                              ^^^^^^^^
      = help: write for instance `path: "result.glb"`

    x.ron:4:19: error: the output path "/tmp/a.png" may lead out of the run directory
    4 | Save([Image(path: "/tmp/a.png"), Image(path: "../a.png"), Image(path: "b.png"), Image(path: "./B.png")]),
      |                   ^^^^^^^^^^^^
      = help: write a relative path without `..`; `sir run --out` says where the run directory is

    x.ron:4:46: error: the output path "../a.png" may lead out of the run directory
    4 | Save([Image(path: "/tmp/a.png"), Image(path: "../a.png"), Image(path: "b.png"), Image(path: "./B.png")]),
      |                                              ^^^^^^^^^^
      = help: write a relative path without `..`; `sir run --out` says where the run directory is

    x.ron:4:93: error: the output path "./B.png" is used twice
    4 | Save([Image(path: "/tmp/a.png"), Image(path: "../a.png"), Image(path: "b.png"), Image(path: "./B.png")]),
      |                                                                                             ^^^^^^^^^
      = help: choose another name; "b.png" is in line 4
    "#);
    insta::assert_snapshot!(stages(&[r#"Load(path: "garden/tree.glb"), FirstShot(lines: 10),"#]), @r#"
    x.ron:2:12: error: the scene file garden/tree.glb does not exist
    2 | Load(path: "garden/tree.glb"), FirstShot(lines: 10),
      |            ^^^^^^^^^^^^^^^^^
      = help: paths are relative to the folder of the pipeline file
    "#);
    insta::assert_snapshot!(stages(&[r#"Load(path: "room.blend"), FirstShot(lines: 10),"#]), @r#"
    x.ron:2:12: error: "room.blend" is not a scene file by its name
    2 | Load(path: "room.blend"), FirstShot(lines: 10),
      |            ^^^^^^^^^^^^
      = help: scenes are read from .gltf, .glb and .obj files
    "#);
}

#[test]
fn impossible_orders() {
    insta::assert_snapshot!(stages(&[
        r#"Save([Table(path: "a.csv")]),"#,
        r#"Load(path: "room.obj"),"#,
        r#"Load(path: "room.obj"),"#,
        r#"Multipath(lines: 10),"#,
        r#"FirstShot(lines: 10),"#,
        r#"Subdivide(patches: 10),"#,
        r#"Subdivide(patches: 10),"#,
        r#"FirstShot(lines: 10),"#,
        r#"Multipath(lines: 10),"#,
    ]), @r#"
    x.ron:2:1: error: `Save` before `Load`: there is no scene yet
    2 | Save([Table(path: "a.csv")]),
      | ^^^^
      = help: begin the stages with `Load(path: "scene.gltf")`

    x.ron:4:1: error: a second `Load`; the first is in line 3
    4 | Load(path: "room.obj"),
      | ^^^^
      = help: a pipeline has one scene: keep one `Load`

    x.ron:5:1: error: `Multipath` before `FirstShot`: there is no light to distribute yet
    5 | Multipath(lines: 10),
      | ^^^^^^^^^
      = help: put `FirstShot(lines: 1_000_000)` before `Multipath`

    x.ron:7:1: error: `Subdivide` after `FirstShot`: light has been computed on the patches as they were
    7 | Subdivide(patches: 10),
      | ^^^^^^^^^
      = help: move `Subdivide` to before `FirstShot`

    x.ron:8:1: error: a second `Subdivide`; the first is in line 7
    8 | Subdivide(patches: 10),
      | ^^^^^^^^^
      = help: keep one of the two

    x.ron:9:1: error: a second `FirstShot`; the first is in line 6
    9 | FirstShot(lines: 10),
      | ^^^^^^^^^
      = help: keep one, with all the lines

    x.ron:10:1: error: a second `Multipath`; the first is in line 5
    10 | Multipath(lines: 10),
       | ^^^^^^^^^
       = help: keep one, with all the lines
    "#);
    insta::assert_snapshot!(stages(&[r#"Load(path: "room.obj"),"#]), @r#"
    x.ron:2:1: error: the pipeline ends without computing anything
    2 | Load(path: "room.obj"),
      | ^^^^
      = help: add `FirstShot(lines: 1_000_000)` and `Multipath(lines: 1_000_000)`
    "#);
}

#[test]
fn a_focus_that_cannot_be() {
    insta::assert_snapshot!(stages(&[
        r#"Load(path: "room.obj"),"#,
        r#"Focus(min: (0, 0, 0), max: (1, -1, 1), share: 1),"#,
        r#"FirstShot(lines: 10),"#,
        r#"Focus(min: (0, 0, 0)),"#,
        r#"Multipath(lines: 10, transport: Replicas),"#,
    ]), @r"
    x.ron:3:1: error: `min` must not be larger than `max` in any coordinate
    3 | Focus(min: (0, 0, 0), max: (1, -1, 1), share: 1),
      | ^^^^^
      = help: give the corner with the smallest coordinates as `min`

    x.ron:3:47: error: `share` must be from 0 to 0.95, but it is 1
    3 | Focus(min: (0, 0, 0), max: (1, -1, 1), share: 1),
      |                                               ^
      = help: 0.75 draws three quarters of the lines through the box

    x.ron:5:1: error: `Focus` lacks the field `max`
    5 | Focus(min: (0, 0, 0)),
      | ^^^^^
      = help: write `Focus(max: (5, 3, 4), …)`

    x.ron:5:1: error: a second `Focus`; the first is in line 3
    5 | Focus(min: (0, 0, 0)),
      | ^^^^^
      = help: keep one, with a box around all that matters

    x.ron:6:1: error: the transport `Replicas` cannot have a `Focus`: each line takes along all that a surface holds, so lines must be the same everywhere
    6 | Multipath(lines: 10, transport: Replicas),
      | ^^^^^^^^^
      = help: write `transport: Batches`, or leave `Focus` out
    ");
}

#[test]
fn syntax() {
    insta::assert_snapshot!(problems("Pipeline(\n    seed: 1\n    stages: [],\n)"), @r"
    x.ron:3:5: error: not valid RON: expected comma
    3 |     stages: [],
      |     ^
      = help: put a comma between two values, and close every `(` with `)` and every `[` with `]`
    ");
    insta::assert_snapshot!(problems("Pipeline(\n    stages: [\n        Load(path: \"room.obj),\n    ],\n)"), @r#"
    x.ron:3:20: error: not valid RON: expected end of string
    3 |         Load(path: "room.obj),
      |                    ^
      = help: end the text with `"`
    "#);
    insta::assert_snapshot!(problems("Pipeline(stages: [Load(path: \"room.obj\")]"), @r#"
    x.ron:1:42: error: not valid RON: expected comma
    1 | Pipeline(stages: [Load(path: "room.obj")]
      |                                          ^
      = help: put a comma between two values, and close every `(` with `)` and every `[` with `]`
    "#);
    insta::assert_snapshot!(problems(""), @r#"
    x.ron:1:1: error: not valid RON: unexpected end of RON
    1 | 
      | ^
      = help: the file ends inside a value: close every `(` and `[`, and every `"`
    "#);
}

/// A valid pipeline with a few pieces cut out, doubled, or replaced by others.
fn mutated() -> impl Strategy<Value = String> {
    let pieces = prop::sample::select(vec![
        "(",
        ")",
        "[",
        "]",
        "{",
        "}",
        ",",
        ":",
        "\"",
        "'",
        "r#",
        "//",
        "/*",
        "*/",
        "\n",
        "-1",
        "1e400",
        "NaN",
        "Some(",
        "None",
        "Load",
        "lines",
        "ß",
        "\t",
        "\\",
        "#![enable(implicit_some)]",
        "0x",
        "1..2",
        "true",
        "_",
        "\0",
    ]);
    let mutation = (0..VALID.len(), 0usize..12, pieces);
    prop::collection::vec(mutation, 1..4).prop_map(|mutations| {
        let mut bytes = VALID.as_bytes().to_vec();
        for (at, cut, piece) in mutations {
            let at = at.min(bytes.len());
            let end = (at + cut).min(bytes.len());
            bytes.splice(at..end, piece.bytes());
        }
        String::from_utf8_lossy(&bytes).into_owned()
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    /// Whatever the file says, there is an answer, and every problem lies inside the file.
    #[test]
    fn no_text_is_too_strange(text in mutated()) {
        if let Err(all) = Pipeline::parse(&text, Path::new("no-such-folder/x.ron")) {
            prop_assert!(!all.list().is_empty());
            let lines = text.split('\n').count();
            for problem in all.list() {
                prop_assert!(problem.span.start <= text.len(), "{problem:?} of {}", text.len());
                prop_assert!(problem.span.start <= problem.span.end);
                let at = all.position(problem);
                prop_assert!((1..=lines).contains(&at.line));
                let width = text.split('\n').nth(at.line - 1).unwrap().chars().count();
                prop_assert!((1..=width + 1).contains(&at.column), "{at:?} in a line of {width}");
                prop_assert!(!problem.message.is_empty() && !problem.help.is_empty());
            }
            prop_assert!(all.to_string().contains(": error: "));
        }
    }
}

#[test]
fn second_shots_out_of_place() {
    insta::assert_snapshot!(stages(&[
        r#"Load(path: "room.obj"),"#,
        r#"SecondShot(lines: 10),"#,
        r#"Multipath(lines: 10),"#,
        r#"Save([Table(path: "a.csv")]),"#,
    ]), @"
    x.ron:3:1: error: `SecondShot` before `FirstShot`: there is no light to distribute yet
    3 | SecondShot(lines: 10),
      | ^^^^^^^^^^
      = help: put `FirstShot(lines: 1_000_000)` before `SecondShot`
    ");
    insta::assert_snapshot!(stages(&[
        r#"Load(path: "room.obj"),"#,
        r#"FirstShot(lines: 10),"#,
        r#"Multipath(lines: 10),"#,
        r#"SecondShot(lines: 10),"#,
        r#"Save([Table(path: "a.csv")]),"#,
    ]), @"
    x.ron:5:1: error: `SecondShot` after `Multipath`: all light has been distributed
    5 | SecondShot(lines: 10),
      | ^^^^^^^^^^
      = help: move `SecondShot` to before `Multipath`
    ");
}

/// A `Repeat` with these fields.
fn repeat(fields: &str) -> String {
    stages(&[r#"Load(path: "room.obj"),"#, &format!("Repeat({fields}),"), r#"Save([Table(path: "a.csv")]),"#])
}

#[test]
fn repeats_that_do_not_say_how_often() {
    insta::assert_snapshot!(repeat("stages: [FirstShot(lines: 9)]"), @"
    x.ron:3:1: error: `Repeat` does not say how often
    3 | Repeat(stages: [FirstShot(lines: 9)]),
      | ^^^^^^
      = help: write one of `times: 16`, `until: RelativeError(0.01)` or `until: Seconds(60)`
    ");
    insta::assert_snapshot!(
        repeat("times: 0, until: Seconds(1), at_most: 0, stages: [FirstShot(lines: 9)]"), @"
    x.ron:3:1: error: `Repeat` has both `times` and `until`
    3 | Repeat(times: 0, until: Seconds(1), at_most: 0, stages: [FirstShot(lines: 9)]),
      | ^^^^^^
      = help: write one of `times: 16`, `until: RelativeError(0.01)` or `until: Seconds(60)`

    x.ron:3:46: error: `at_most` must be a whole number from 1 to 1_000_000_000_000_000, but it is the number 0
    3 | Repeat(times: 0, until: Seconds(1), at_most: 0, stages: [FirstShot(lines: 9)]),
      |                                              ^
      = help: write for instance `at_most: 100`
    ");
    insta::assert_snapshot!(repeat("until: Second(1), stages: 5"), @"
    x.ron:3:15: error: unknown target `Second`
    3 | Repeat(until: Second(1), stages: 5),
      |               ^^^^^^
      = help: did you mean `Seconds`?

    x.ron:3:34: error: `stages` must be a list, but it is the number 5
    3 | Repeat(until: Second(1), stages: 5),
      |                                  ^
      = help: write `stages: [FirstShot(…), …]`
    ");
    insta::assert_snapshot!(repeat("until: RelativeError(0), stages: [FirstShot(lines: 9)]"), @"
    x.ron:3:29: error: `until` must be above zero, but it is 0
    3 | Repeat(until: RelativeError(0), stages: [FirstShot(lines: 9)]),
      |                             ^
      = help: write for instance `until: RelativeError(0.01)`
    ");
    insta::assert_snapshot!(repeat("until: Seconds(1, 2), time: 5, stages: [FirstShot(lines: 9)]"), @"
    x.ron:3:15: error: `Seconds` takes one number, but this is `Seconds(…)`
    3 | Repeat(until: Seconds(1, 2), time: 5, stages: [FirstShot(lines: 9)]),
      |               ^^^^^^^^^^^^^
      = help: write `until: Seconds(60)`

    x.ron:3:30: error: unknown field `time` in `Repeat`
    3 | Repeat(until: Seconds(1, 2), time: 5, stages: [FirstShot(lines: 9)]),
      |                              ^^^^
      = help: did you mean `times`?
    ");
}

#[test]
fn what_cannot_be_repeated() {
    insta::assert_snapshot!(repeat("times: 2, stages: []"), @"
    x.ron:3:26: error: `Repeat` has no stages
    3 | Repeat(times: 2, stages: []),
      |                          ^^
      = help: begin the `stages` of `Repeat` with `FirstShot(lines: 1_000_000)`
    ");
    insta::assert_snapshot!(repeat("times: 2, stages: [Multipath(lines: 9), FirstShot(lines: 9)]"), @"
    x.ron:3:27: error: `Multipath` before `FirstShot`: there is no light to distribute yet
    3 | Repeat(times: 2, stages: [Multipath(lines: 9), FirstShot(lines: 9)]),
      |                           ^^^^^^^^^
      = help: begin the `stages` of `Repeat` with `FirstShot(lines: 1_000_000)`

    x.ron:3:48: error: `FirstShot` after `Multipath`
    3 | Repeat(times: 2, stages: [Multipath(lines: 9), FirstShot(lines: 9)]),
      |                                                ^^^^^^^^^
      = help: the order is `FirstShot`, `SecondShot`, `Multipath`, each of them once
    ");
    insta::assert_snapshot!(
        repeat("times: 2, stages: [FirstShot(lines: 9), FirstShot(lines: 9), Save([Table(path: \"b.csv\")])]"), @r#"
    x.ron:3:69: error: unknown repeated stage `Save`
    3 | Repeat(times: 2, stages: [FirstShot(lines: 9), FirstShot(lines: 9), Save([Table(path: "b.csv")])]),
      |                                                                     ^^^^
      = help: repeated stages are `FirstShot`, `SecondShot` and `Multipath`
    "#);
    insta::assert_snapshot!(repeat("times: 2, stages: [Repeat(times: 2, stages: [FirstShot(lines: 9)])]"), @"
    x.ron:3:27: error: unknown repeated stage `Repeat`
    3 | Repeat(times: 2, stages: [Repeat(times: 2, stages: [FirstShot(lines: 9)])]),
      |                           ^^^^^^
      = help: repeated stages are `FirstShot`, `SecondShot` and `Multipath`
    ");
}

#[test]
fn repeats_out_of_place() {
    let repeat = "Repeat(times: 2, stages: [FirstShot(lines: 10)]),";
    let load = r#"Load(path: "room.obj"),"#;
    insta::assert_snapshot!(stages(&[repeat]), @r#"
    x.ron:2:1: error: `Repeat` before `Load`: there is no scene yet
    2 | Repeat(times: 2, stages: [FirstShot(lines: 10)]),
      | ^^^^^^
      = help: begin the stages with `Load(path: "scene.gltf")`

    x.ron:2:1: error: the pipeline ends without computing anything
    2 | Repeat(times: 2, stages: [FirstShot(lines: 10)]),
      | ^^^^^^
      = help: add `FirstShot(lines: 1_000_000)` and `Multipath(lines: 1_000_000)`
    "#);
    insta::assert_snapshot!(stages(&[load, "FirstShot(lines: 10),", repeat, "Multipath(lines: 10),"]), @"
    x.ron:3:1: error: `FirstShot` beside the `Repeat` in line 4
    3 | FirstShot(lines: 10),
      | ^^^^^^^^^
      = help: move `FirstShot` into the `stages` of `Repeat`

    x.ron:5:1: error: `Multipath` beside the `Repeat` in line 4
    5 | Multipath(lines: 10),
      | ^^^^^^^^^
      = help: move `Multipath` into the `stages` of `Repeat`
    ");
    insta::assert_snapshot!(stages(&[load, repeat, repeat, "Subdivide(patches: 9),"]), @"
    x.ron:4:1: error: a second `Repeat`; the first is in line 3
    4 | Repeat(times: 2, stages: [FirstShot(lines: 10)]),
      | ^^^^^^
      = help: keep one, with as many repeats as both together

    x.ron:5:1: error: `Subdivide` after `Repeat`: light has been computed on the patches as they were
    5 | Subdivide(patches: 9),
      | ^^^^^^^^^
      = help: move `Subdivide` to before `Repeat`
    ");
}
