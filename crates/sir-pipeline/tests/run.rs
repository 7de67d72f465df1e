//! Runs pipelines from file to result through the library.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use glam::DVec3;
use sir_pipeline::NoProgress;
use sir_pipeline::check::estimate;
use sir_pipeline::plan::{CameraChoice, Output, Pipeline};
use sir_pipeline::report::compare;
use sir_pipeline::report::{ErrorsFrom, ErrorsReport, Report, Time};
use sir_pipeline::run::{RunOptions, read_report, run_pipeline as run};
use sir_pipeline::{Error, ErrorKind};

/// Closed room of 2 × 2 × 2 m whose ceiling emits 1 W/m² in red and less in the other bands. The reflectance of the
/// walls is too large in blue.
const ROOM: &str = "mtllib room.mtl
v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 0 0 2\nv 2 0 2\nv 2 2 2\nv 0 2 2
usemtl wall\nf 1 2 3 4\nf 6 5 8 7\nf 5 1 4 8\nf 2 6 7 3\nf 5 6 2 1
usemtl lamp\nf 4 3 7 8\n";
const MATERIALS: &str = "newmtl wall\nKd 0.5 0.5 1\nnewmtl lamp\nKd 0.2 0.2 0.2\nKe 1 0.5 0.25\n";

const PIPELINE: &str = r#"Pipeline(
    seed: 5,
    stages: [
        Load(path: "room.obj"),
        Subdivide(patches: 100),
        FirstShot(lines: 20_000),
        Save([Table(path: "direct.npy")]),
        Multipath(lines: 20_000),
        Save([
            Image(path: "pictures/view.png", width: 32, height: 24, samples: 2),
            Image(path: "pictures/view.exr", width: 32, height: 24, samples: 2),
            Gltf(path: "result.glb"),
            Table(path: "patches.csv"),
        ]),
    ],
)"#;

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("room.obj"), ROOM).unwrap();
    fs::write(folder.path().join("room.mtl"), MATERIALS).unwrap();
    folder
}

fn pipeline(folder: &Path, text: &str) -> Pipeline {
    Pipeline::parse(text, &folder.join("room.ron")).unwrap_or_else(|e| panic!("{e}"))
}

fn options(folder: &Path) -> RunOptions {
    RunOptions { results: folder.join("results"), ..RunOptions::default() }
}

/// Returns all files under a directory except the report.
fn files(directory: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut folders = vec![directory.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if !path.ends_with("result.json") {
                let name = path.strip_prefix(directory).unwrap().to_str().unwrap().to_owned();
                found.insert(name, fs::read(&path).unwrap());
            }
        }
    }
    found
}

/// Returns the report without its times.
fn timeless(mut report: Report) -> Report {
    report.time = Time::of(0.0);
    for stage in &mut report.stages {
        stage.time = Time::of(0.0);
        stage.convergence.iter_mut().for_each(|point| point.time = Time::of(0.0));
    }
    report
}

#[test]
fn the_same_pipeline_gives_the_same_files() {
    let folder = folder();
    let pipeline = pipeline(folder.path(), PIPELINE);
    let first = run(&pipeline, &options(folder.path())).unwrap();
    let second = run(&pipeline, &options(folder.path())).unwrap();
    assert_eq!(first.directory, folder.path().join("results/room"));
    assert_eq!(second.directory, folder.path().join("results/room-2"));

    let (a, b) = (files(&first.directory), files(&second.directory));
    let names: Vec<&str> = a.keys().map(String::as_str).collect();
    assert_eq!(names, ["direct.npy", "patches.csv", "pictures/view.exr", "pictures/view.png", "result.glb"]);
    // The header of the EXR image has the names of the error channels.
    for band in ["R", "G", "B"] {
        let channel = format!("error.{band}\0");
        let picture = &a["pictures/view.exr"];
        assert!(picture.windows(channel.len()).any(|bytes| bytes == channel.as_bytes()), "{channel}");
    }
    assert!(a == b, "two runs of one pipeline differ");
    assert_eq!(read_report(&first.directory).unwrap(), first.report);
    assert_eq!(timeless(first.report.clone()), timeless(second.report));
    for output in &first.report.outputs {
        assert_eq!(Some(a[&output.path].len() as u64), output.bytes);
    }

    let same = compare(&first.directory, &second.directory).unwrap();
    assert_eq!((same.luminance.relative_rms, same.luminance.relative_bias), (0.0, 0.0));
    let other = RunOptions { seed: Some(6), ..options(folder.path()) };
    let other = run(&pipeline, &other).unwrap();
    assert_eq!(other.report.seed, 6);
    let differ = compare(&first.directory, &other.directory.join("patches.csv")).unwrap();
    assert!(differ.luminance.relative_rms > 1e-3 && differ.luminance.relative_rms < 0.3, "{differ:?}");
    let direct = compare(&first.directory.join("direct.npy"), &first.directory).unwrap();
    assert!(direct.luminance.relative_bias > 0.1, "reflected light adds to the direct light: {direct:?}");
}

#[test]
fn the_report_tells_what_happened() {
    let folder = folder();
    let result = run(&pipeline(folder.path(), PIPELINE), &options(folder.path())).unwrap();
    let Report { version, seed, scene, stages, outputs, pipeline, .. } = result.report;
    assert_eq!((version, seed, pipeline.text.as_str()), (3, 5, PIPELINE));
    assert_eq!(scene.triangles, 12);
    assert!(scene.patches.abs_diff(100) < 15, "{}", scene.patches);
    assert!((scene.area - 24.0).abs() < 1e-9);
    assert_eq!(scene.warnings.len(), 1, "{:?}", scene.warnings);
    for (power, expected) in scene.power.iter().zip([4.0, 2.0, 1.0]) {
        assert!(
            (power / expected / std::f64::consts::PI - 1.0).abs() < 1e-6
                || (power / expected - 1.0).abs() < 1e-6
        );
    }
    let names: Vec<&str> = stages.iter().map(|s| s.name.as_str()).collect();
    assert_eq!(names, ["Load", "Subdivide", "FirstShot", "Save", "Multipath", "Save"]);
    assert_eq!(outputs.len(), 5);
    for (name, odd) in [("FirstShot", 0), ("Multipath", 0)] {
        let stage = stages.iter().find(|s| s.name == name).unwrap();
        let (lines, light) = (stage.lines.as_ref().unwrap(), stage.light.as_ref().unwrap());
        assert_eq!((lines.lines, lines.odd_lines), (20_000, odd));
        assert!(stage.time.lines_per_second.unwrap() > 0.0);
        let b = &lines.balance;
        for k in 0..3 {
            let sum = b.absorbed[k] + b.blocked[k] + b.escaped[k] + b.unshot[k];
            assert!((sum / b.emitted[k] - 1.0).abs() < 1e-12);
            assert!(b.escaped[k] == 0.0, "the room is closed");
            assert!(light.relative_error[k] > 0.01 && light.relative_error[k] < 0.5);
        }
        assert_eq!(light.tally_hash.len(), 64);
        assert_eq!(light.errors, ErrorsReport { from: ErrorsFrom::Spread, samples: stage.repeats.unwrap() });
    }
}

/// The surface of the cube is 24 m², that of its bounding sphere `4π · 3 m²`.
#[test]
fn the_report_names_the_domain() {
    let folder = folder();
    let mut irradiances = Vec::new();
    for (fields, body, surface) in [
        ("", "Hull", 24.0),
        (", transport: Replicas(count: 2)", "Hull", 24.0),
        (", domain: Box", "Box", 24.0),
        (", domain: Box, transport: Replicas(count: 2)", "Box", 24.0),
        (", domain: Sphere", "Sphere", 12.0 * std::f64::consts::PI),
        (", domain: Sphere, transport: Replicas(count: 2)", "Sphere", 12.0 * std::f64::consts::PI),
    ] {
        let text = PIPELINE.replace("Multipath(lines: 20_000)", &format!("Multipath(lines: 20_000{fields})"));
        let result = run(&pipeline(folder.path(), &text), &options(folder.path())).unwrap();
        let lines = |name: &str| {
            let stage = result.report.stages.iter().find(|s| s.name == name).unwrap();
            stage.lines.clone().unwrap()
        };
        assert_eq!(lines("FirstShot").domain, None);
        let multipath = lines("Multipath");
        let domain = multipath.domain.unwrap();
        assert_eq!(domain.kind, body);
        assert!((domain.surface / surface - 1.0).abs() < 1e-8, "{domain:?}");
        // Every line that enters the cube hits its walls.
        let empty = 1.0 - 24.0 / surface;
        let sigma = (empty * (1.0 - empty) / 20_000.0).sqrt();
        assert!((multipath.empty_share - empty).abs() <= 4.0 * sigma, "{}", multipath.empty_share);
        irradiances.push(multipath.balance.absorbed);
    }
    for absorbed in &irradiances {
        for band in 0..3 {
            let off = absorbed[band] / irradiances[0][band] - 1.0;
            assert!(off.abs() < 0.05, "{irradiances:?}");
        }
    }
}

#[test]
fn nothing_is_written_before_the_scene_is_read() {
    let folder = folder();
    let pipeline = pipeline(folder.path(), PIPELINE);
    fs::write(folder.path().join("room.obj"), "f 1 2 3\n").unwrap();
    assert!(matches!(run(&pipeline, &options(folder.path())), Err(Error::Load(_))));
    fs::write(folder.path().join("room.obj"), ROOM).unwrap();
    fs::write(folder.path().join("room.mtl"), "newmtl wall\nKd 0.5 0.5 0.5\nnewmtl lamp\n").unwrap();
    let dark = run(&pipeline, &options(folder.path())).unwrap_err();
    assert!(dark.chain().contains("nothing in the scene emits light; give"), "{}", dark.chain());
    assert!(!folder.path().join("results").exists());
}

#[test]
fn a_result_is_not_replaced_by_accident() {
    let folder = folder();
    let pipeline = pipeline(folder.path(), r#"(stages: [Load(path: "room.obj"), FirstShot(lines: 10)])"#);
    let out = folder.path().join("mine");
    let mut options = RunOptions { out: Some(out.clone()), ..options(folder.path()) };
    run(&pipeline, &options).unwrap();
    assert!(matches!(run(&pipeline, &options), Err(Error::Exists { .. })));
    options.force = true;
    run(&pipeline, &options).unwrap();
    let error = compare(&out, &out).unwrap_err();
    assert!(matches!(error, Error::NoTable { .. }), "{error}");
    assert!(matches!(compare(folder.path(), &out), Err(Error::NoResult { .. })));
}

#[test]
fn cameras_and_patches_that_the_scene_cannot_have_are_shown_in_the_pipeline() {
    let folder = folder();
    let text = r#"(stages: [
Load(path: "room.obj"),
Subdivide(max_edge: 1e-9),
FirstShot(lines: 10),
Save([Image(path: "a.png", camera: 0), Image(path: "b.png", camera: "door")]),
])"#;
    let error = run(&pipeline(folder.path(), text), &options(folder.path())).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Usage);
    let shown = error.to_string().replace(&format!("{}/", folder.path().display()), "");
    insta::assert_snapshot!(shown, @r#"
    error: the subdivision makes more than 4294967295 patches or sides
     --> room.ron:3:1
      |
    3 | Subdivide(max_edge: 1e-9),
      | ^^^^^^^^^
      |
      = help: use fewer or larger patches

    error: the scene has no camera number 0
     --> room.ron:5:36
      |
    5 | Save([Image(path: "a.png", camera: 0), Image(path: "b.png", camera: "door")]),
      |                                    ^
      |
      = help: the scene has no camera; leave `camera` out, or describe one with `Camera(eye: …, target: …)`

    error: the scene has no camera "door"
     --> room.ron:5:69
      |
    5 | Save([Image(path: "a.png", camera: 0), Image(path: "b.png", camera: "door")]),
      |                                                                     ^^^^^^
      |
      = help: the scene has no camera; leave `camera` out, or describe one with `Camera(eye: …, target: …)`
    "#);
}

#[test]
fn a_check_counts_and_estimates() {
    let folder = folder();
    let estimate = estimate(&pipeline(folder.path(), PIPELINE), &NoProgress).unwrap();
    let stages: Vec<_> = estimate.stages.iter().map(|s| (s.name, s.lines)).collect();
    assert_eq!(stages, [("FirstShot", 20_000), ("Multipath", 20_000)]);
    assert!(estimate.stages.iter().all(|s| s.rate > 0.0));
    assert_eq!(estimate.prepared.sources.len(), 2);
    let text = estimate.to_string();
    for part in
        ["triangles  12", "sources    2 triangle sides", "acceleration structure", "FirstShot: 20_000 lines"]
    {
        assert!(text.contains(part), "{text}");
    }
    assert!(!folder.path().join("results").exists());
}

#[test]
fn outputs_replace_no_file_that_no_run_has_written() {
    let folder = folder();
    let path = folder.path();
    let text = r#"(stages: [Load(path: "room.obj"), FirstShot(lines: 100), Save([Table(path: "table.csv"), Gltf(path: "own.glb")])])"#;
    let pipeline = pipeline(path, text);
    let in_place = |force| RunOptions { out: Some(path.to_owned()), force, ..RunOptions::default() };
    fs::write(path.join("own.glb"), "mine").unwrap();
    let error = run(&pipeline, &in_place(false)).unwrap_err();
    assert!(matches!(error, Error::OutputExists { .. }) && error.kind() == ErrorKind::Usage, "{error}");
    assert_eq!(fs::read(path.join("own.glb")).unwrap(), b"mine");
    run(&pipeline, &in_place(true)).unwrap();
    assert_ne!(fs::read(path.join("own.glb")).unwrap(), b"mine");

    // A scene that a run has written is the input of another.
    let again = Pipeline::parse(&text.replace("room.obj", "own.glb"), &path.join("again.ron")).unwrap();
    let error = run(&again, &in_place(true)).unwrap_err();
    assert!(matches!(error, Error::OutputIsInput { .. }), "{error}");
}

#[test]
fn cameras_have_the_up_direction_of_the_scene() {
    let camera = |text: &str| {
        let text = format!(
            "(stages: [Load(path: \"room.obj\"), FirstShot(lines: 1), Save([Image(path: \"a.png\", camera: Camera({text}))])])"
        );
        let folder = folder();
        let pipeline = pipeline(folder.path(), &text);
        let Some(Output::Image(image)) = pipeline.outputs().next() else { panic!() };
        let Some(CameraChoice::Own(camera)) = image.camera.as_ref().map(|c| c.value.clone()) else {
            panic!()
        };
        camera.to_scene(DVec3::Z).unwrap()
    };
    assert_eq!(camera("eye: (0, -4, 1), target: (0, 0, 1)").up, DVec3::Z);
    assert_eq!(camera("eye: (0, -4, 1), target: (0, 0, 1), up: (1, 0, 0)").up, DVec3::X);
    // Straight down.
    assert_eq!(camera("eye: (0, 0, 4), target: (0, 0, 1)").forward, -DVec3::Z);
}
