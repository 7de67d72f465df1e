//! The stage `Sensors` of a pipeline, from file to files.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use std::fs;
use std::num::NonZeroUsize;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use sir_pipeline::plan::Pipeline;
use sir_pipeline::report::Verdict;
use sir_pipeline::run::{RunOptions, RunResult, run_pipeline as run};
use sir_pipeline::{Error, ErrorKind};

/// Closed room of 2 × 3 × 2 m, y up, with equal emission and reflectance everywhere: the irradiance is 4 W/m² in green.
const ROOM: &str = "mtllib room.mtl\nusemtl m
v 0 0 0\nv 2 0 0\nv 2 3 0\nv 0 3 0\nv 0 0 2\nv 2 0 2\nv 2 3 2\nv 0 3 2
f 1 2 3 4\nf 6 5 8 7\nf 5 1 4 8\nf 2 6 7 3\nf 5 6 2 1\nf 4 3 7 8\n";
const MATERIALS: &str = "newmtl m\nKd 0.5 0.5 0.5\nKe 0 0.6366197723675814 0\n";

/// Runs stages after light has been computed.
fn measure(stages: &str, threads: usize) -> (tempfile::TempDir, Result<RunResult, Error>) {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    write("room.obj", ROOM);
    write("room.mtl", MATERIALS);
    write("points.txt", "# two points\n0.5 0 0.5 0 1 0\n\n1 1.5 1 1 1 0  # in the middle\n");
    write("bad.txt", "0.5 0 0.5 0 1 0\n1 1.5 1 1\n");
    let text = format!(
        "(units: Photometric, stages: [Load(path: \"room.obj\", sides: Front), FirstShot(lines: 100_000), Multipath(lines: 50_000), {stages}])"
    );
    let options = RunOptions {
        out: Some(folder.path().join("out")),
        threads: NonZeroUsize::new(threads),
        ..RunOptions::default()
    };
    let outcome = Pipeline::parse(&text, &folder.path().join("x.ron"))
        .map_err(Error::from)
        .and_then(|pipeline| run(&pipeline, &options));
    (folder, outcome)
}

/// Returns the numbers of a column.
fn column(directory: &Path, file: &str, name: &str) -> Vec<f64> {
    let text = fs::read_to_string(directory.join(file)).unwrap();
    let mut lines = text.lines();
    let place = lines.next().unwrap().split(',').position(|column| column == name).unwrap();
    lines.map(|line| line.split(',').nth(place).unwrap().parse().unwrap()).collect()
}

#[test]
fn sensors_are_measured_and_written() {
    let stages = r#"
        Sensors(name: "points", at: File("points.txt")),
        Sensors(name: "wall/a", at: Points([(position: (0, 1, 1), direction: (2, 0, 0))]), rays: 1000, error: 0.01),
        Sensors(name: "desk", at: Plane(height: 0.75, spacing: 0.5, border: 0.25, up: (0, 1, 0))),
        Sensors(name: "grid", at: Grid(corner: (0, 1, 2), along: (2, 0, 0), across: (0, 0, -2), spacing: 1)),
    "#;
    let (_folder, result) = measure(stages, 2);
    let result = result.unwrap_or_else(|error| panic!("{}", error.chain()));
    let out = &result.directory;
    let paths: Vec<&str> = result.report.outputs.iter().map(|o| o.path.as_str()).collect();
    assert_eq!(paths, ["points.csv", "wall/a.csv", "desk.csv", "desk.png", "grid.csv", "grid.png"]);
    assert!(paths.iter().all(|path| out.join(path).is_file()));
    for (file, count) in [("points.csv", 2), ("wall/a.csv", 1), ("desk.csv", 9), ("grid.csv", 4)] {
        let (green, errors) = (column(out, file, "E_g"), column(out, file, "se_g"));
        assert_eq!(green.len(), count);
        for (value, error) in green.iter().zip(errors) {
            assert!((value - 4.0).abs() < 4.0 * error && error < 0.05, "{file}: {value} ± {error}");
        }
        assert!(column(out, file, "E_r").iter().all(|red| *red == 0.0));
        let ratio = column(out, file, "E")[0] / green[0];
        assert!((ratio - 0.7152).abs() < 1e-9, "{ratio}");
    }
    assert_eq!(column(out, "grid.csv", "z"), [1.5, 1.5, 0.5, 0.5]);
    let reports: Vec<_> = result.report.stages.iter().filter_map(|s| s.sensors.as_ref()).collect();
    assert_eq!(reports.iter().map(|r| r.points).collect::<Vec<_>>(), [2, 1, 9, 4]);
    let desk = reports[2];
    assert!((desk.mean - 4.0 * 0.7152).abs() < 4.0 * desk.mean_error && desk.uniformity > 0.98, "{desk:?}");
    assert!(desk.minimum <= desk.mean && desk.mean <= desk.maximum);
    let shown = desk.in_short(result.report.units);
    assert!(shown.starts_with("mean 2.8") && shown.contains(" lx, minimum 2.8"), "{shown}");
}

#[test]
fn sensors_are_the_same_by_any_number_of_threads() {
    let stages = r#"Sensors(name: "desk", at: Plane(height: 0.75, spacing: 0.5), rays: 2000)"#;
    let all = [1, 3].map(|threads| {
        let (folder, result) = measure(stages, threads);
        assert!(result.is_ok());
        ["desk.csv", "desk.png"].map(|file| fs::read(folder.path().join("out").join(file)).unwrap())
    });
    assert!(all[0] == all[1]);
}

/// The light of the room is the same from everywhere, so cylinders measure the irradiance of planes.
#[test]
fn cylinders_are_measured_around_the_up_direction() {
    let stages = r#"
        Sensors(name: "faces", at: Plane(height: 1.2, spacing: 1), measure: Cylindrical, rays: 4096),
        Sensors(name: "half", at: Plane(height: 1.2, direction: (0, 0, 1)), measure: SemiCylindrical, rays: 1024),
        Sensors(name: "vertical", at: Plane(height: 1.2, spacing: 1, direction: (0, 0, 1)), rays: 4096),
    "#;
    let (_folder, result) = measure(stages, 2);
    let result = result.unwrap_or_else(|error| panic!("{}", error.chain()));
    let reports: Vec<_> = result.report.stages.iter().filter_map(|s| s.sensors.as_ref()).collect();
    // Without a spacing there are 6 × 6 cells on 2 m by 2 m.
    assert_eq!(reports.iter().map(|r| r.points).collect::<Vec<_>>(), [4, 36, 4]);
    assert_eq!(reports.iter().map(|r| r.rays).collect::<Vec<_>>(), [4 * 4 * 4096, 36 * 4 * 1024, 4 * 4096]);
    for report in &reports {
        assert!((report.mean - 4.0 * 0.7152).abs() < 4.0 * report.mean_error, "{report:?}");
        assert!(report.mean_error < 0.02 && report.minimum_error < 0.05, "{report:?}");
    }
    let kinds: Vec<_> = reports.iter().map(|r| r.quantity(result.report.units)).collect();
    assert_eq!(kinds, ["cylindrical illuminance", "semi-cylindrical illuminance", "illuminance"]);
    for (file, direction) in [("faces.csv", [0.0, 1.0, 0.0]), ("half.csv", [0.0, 0.0, 1.0])] {
        let found = ["dx", "dy", "dz"].map(|name| column(&result.directory, file, name)[0]);
        assert_eq!(found, direction, "{file}");
    }
}

#[test]
fn requirements_are_compared_with_measurements() {
    // The illuminance is 2.861 everywhere.
    let stages = r#"
        Sensors(name: "a", at: Plane(height: 1, spacing: 1), rays: 4096, require: (mean: 2.5, minimum: 4, uniformity: 0.6)),
        Sensors(name: "b", at: Plane(height: 1, spacing: 1), rays: 4096, require: (mean: 2.861, diversity: 0.5)),
    "#;
    let (_folder, result) = measure(stages, 2);
    let result = result.unwrap_or_else(|error| panic!("{}", error.chain()));
    let reports = result.report.stages.iter().filter_map(|s| s.sensors.as_ref());
    let all: Vec<_> = reports.flat_map(|r| &r.requirements).collect();
    let verdicts: Vec<_> = all.iter().map(|r| (r.quantity.as_str(), r.verdict)).collect();
    let (passes, fails) = (Verdict::Passes, Verdict::Fails);
    assert_eq!(verdicts[..3], [("mean", passes), ("minimum", fails), ("uniformity", passes)]);
    assert_eq!(verdicts[4], ("diversity", passes));
    // A required value that is the true one is within two standard errors with a probability of 95 %; this seed is.
    assert_eq!(verdicts[3], ("mean", Verdict::Undecided), "{:?}", all[3]);
    assert!(all[0].margin.unwrap() > 10.0 && all[1].margin.unwrap() < -10.0, "{all:?}");
    let text = fs::read_to_string(result.directory.join("result.json")).unwrap();
    assert!(text.contains("\"verdict\": \"fails\""), "{text}");
}

#[test]
fn impossible_sensors_are_refused_with_the_reason() {
    for (at, reason) in [
        (r#"File("bad.txt")"#, "bad.txt:2 is not a point: it has 4 numbers, but a point has six"),
        (r#"File("absent.txt")"#, "absent.txt: No such file"),
        ("File(7)", "`File` must have the path of a file in quotes"),
        ("Points([])", "the list of points of `Points` is empty"),
        ("Points(3, 4)", "`Points` must have a list of points"),
        (r#"File(".")"#, "it is not a regular file"),
        (
            "Points([(position: (1, 1, 1), direction: (0, 0, 0))])",
            "must be a direction, but its length is zero",
        ),
        ("Plane(height: 5, spacing: 0.5)", "no point of the plane at the height 5 m lies inside the room"),
        ("Plane(height: 1, spacing: 0.5, border: 1)", "nothing is left of the scene"),
        ("Plane(height: 1, spacing: 1e-5)", "is too fine"),
        ("Plane(height: 1, spacing: -1)", "`spacing` must be a number above 0"),
        ("Plane(height: 1, spacing: 1, border: -1)", "`border` must be a number from 0"),
        ("Plane(height: 1, border: Auto)", "`border` must be `Standard` or a number, but it is `Auto`"),
        ("Plane(height: 1, spacing: 1, up: (0, 0, 0))", "must be a direction, but its length is zero"),
        ("Grid(corner: (0, 0, 0), along: (1, 0, 0), across: (2, 0, 0), spacing: 1)", "this grid has no area"),
        ("Plan(height: 1, spacing: 1)", "did you mean `Plane`?"),
        ("Plane(height: 1, spacings: 1)", "did you mean `spacing`?"),
    ] {
        let (folder, result) = measure(&format!(r#"Sensors(name: "a", at: {at})"#), 1);
        let message = result.map(|_| ()).unwrap_err().chain();
        assert!(message.contains(reason), "{at}: {message}");
        assert!(message.contains("x.ron:1:") && message.contains("help: "), "{at}: {message}");
        assert!(
            !folder.path().join("out").exists(),
            "{at}: nothing is written before all checks have passed"
        );
    }
}

#[test]
fn names_and_order_are_checked() {
    let at = "at: Plane(height: 1, spacing: 1)";
    for (stages, reason) in [
        (
            format!(r#"Sensors(name: "a", {at}), Sensors(name: "A", {at})"#),
            "the output path \"A.csv\" is used twice",
        ),
        (format!(r#"Sensors(name: "../a", {at})"#), "may lead out of the run directory"),
        (format!("Sensors({at})"), "`Sensors` lacks the field `name`"),
        (
            r#"Sensors(name: "a", at: Probes(spacing: 1), measure: Cylindrical)"#.into(),
            "probes measure the irradiance of planes in all directions, and no other kind",
        ),
        (
            format!(r#"Sensors(name: "a", {at}, measure: SemiCylindrical)"#),
            "a half cylinder faces along its axis, the up direction of the scene or plane",
        ),
        (format!(r#"Sensors(name: "a", {at}, measure: Cylindric)"#), "did you mean `Cylindrical`?"),
        (format!(r#"Sensors(name: "a", {at}, require: ())"#), "`require` states no requirement"),
        (
            format!(r#"Sensors(name: "a", {at}, require: (uniformity: 60))"#),
            "must be a number above 0 and up to 1",
        ),
        (
            format!(r#"Sensors(name: "a", {at}, require: (average: 60))"#),
            "unknown field `average` in `Require`",
        ),
        (
            r#"Sensors(name: "a", at: Probes(spacing: 1), require: (mean: 1))"#.into(),
            "probes have no requirements",
        ),
        (r#"Sensors(name: "a")"#.into(), "`Sensors` lacks the field `at`"),
        (format!(r#"Sensors(name: "a", {at}, rays: 0)"#), "`rays` must be a whole number from 1"),
        (format!(r#"Sensors(name: "a", {at}, error: 0)"#), "`error` must be a number above 0"),
        (format!(r#"Sensors(name: "a", {at}, ray: 5)"#), "did you mean `rays`?"),
    ] {
        let message = measure(&stages, 1).1.map(|_| ()).unwrap_err().chain();
        assert!(message.contains(reason), "{stages}: {message}");
        // What is unknown explains that nothing is required.
        assert!(!reason.contains("average") || message.matches("error: ").count() == 1, "{message}");
    }
    let text = r#"(stages: [Load(path: "room.obj"), Sensors(name: "a", at: Plane(height: 1, spacing: 1))])"#;
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("room.obj"), ROOM).unwrap();
    let message = Pipeline::parse(text, &folder.path().join("x.ron")).unwrap_err().to_string();
    assert!(message.contains("`Sensors` before `FirstShot`: there is no result yet"), "{message}");
}

#[test]
fn a_stopped_run_says_how_it_can_go_on() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("room.obj"), ROOM).unwrap();
    fs::write(folder.path().join("room.mtl"), MATERIALS).unwrap();
    let text = r#"(stages: [Load(path: "room.obj", sides: Front), FirstShot(lines: 100),
        Sensors(name: "a", at: Plane(height: 1, spacing: 0.05), rays: 1e6)])"#;
    let pipeline = Pipeline::parse(text, &folder.path().join("x.ron")).unwrap();
    let stop = Arc::new(AtomicBool::new(false));
    let options =
        RunOptions { out: Some(folder.path().join("out")), stop: Arc::clone(&stop), ..RunOptions::default() };
    let outcome = std::thread::scope(|scope| {
        let running = scope.spawn(|| run(&pipeline, &options));
        // The first shot takes almost no time; the sensors take minutes.
        std::thread::sleep(std::time::Duration::from_millis(500));
        stop.store(true, std::sync::atomic::Ordering::Relaxed);
        running.join().unwrap()
    });
    let error = outcome.map(|_| ()).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Interrupted);
    assert!(
        error.chain().starts_with("interrupted while measuring at sensors; resume the run in "),
        "{}",
        error.chain()
    );
}
