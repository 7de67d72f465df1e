//! Tests what a run says about suspicious scenes and results, and the settings that it suggests.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use std::fs;
use std::path::Path;

use glam::DVec3;
use sir_pipeline::NoProgress;
use sir_pipeline::check::estimate;
use sir_pipeline::info::inspect;
use sir_pipeline::plan::Pipeline;
use sir_pipeline::prepare::Prepared;
use sir_pipeline::report::Report;
use sir_pipeline::run::{RunOptions, run_pipeline};

const STAGES: &str = "FirstShot(lines: 2_000)";

/// Writes a gray, closed room of 4 × 3 × 4 m with lengths multiplied by `scale`; with a lamp of 1 m² at the height
/// `lamp` m, if there is one; and with a ground of the given width \[m\] below it, if that is above zero.
fn room(folder: &Path, scale: f64, lamp: Option<f64>, ground: f64) {
    let mut text = String::from("mtllib room.mtl\n");
    let mut quad = |material: &str, corners: [[f64; 3]; 4]| {
        for [x, y, z] in corners {
            text += &format!("v {} {} {}\n", scale * x, scale * y, scale * z);
        }
        text += &format!("usemtl {material}\nf -4 -3 -2 -1\n");
    };
    if let Some(y) = lamp {
        quad("lamp", [[1.5, y, 1.5], [2.5, y, 1.5], [2.5, y, 2.5], [1.5, y, 2.5]]);
    }
    quad("floor", [[0.0, 0.0, 0.0], [0.0, 0.0, 4.0], [4.0, 0.0, 4.0], [4.0, 0.0, 0.0]]);
    quad("ceiling", [[0.0, 3.0, 0.0], [4.0, 3.0, 0.0], [4.0, 3.0, 4.0], [0.0, 3.0, 4.0]]);
    quad("wall", [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [4.0, 3.0, 0.0], [0.0, 3.0, 0.0]]);
    quad("wall", [[0.0, 0.0, 4.0], [0.0, 3.0, 4.0], [4.0, 3.0, 4.0], [4.0, 0.0, 4.0]]);
    quad("wall", [[0.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 3.0, 4.0], [0.0, 0.0, 4.0]]);
    quad("wall", [[4.0, 0.0, 0.0], [4.0, 0.0, 4.0], [4.0, 3.0, 4.0], [4.0, 3.0, 0.0]]);
    if ground > 0.0 {
        let g = 0.5 * ground;
        quad("ground", [[-g, -1.0, -g], [-g, -1.0, g], [g, -1.0, g], [g, -1.0, -g]]);
    }
    let gray = |name| format!("newmtl {name}\nKd .5 .5 .5\n");
    let materials = ["floor", "ceiling", "wall", "ground"].map(gray).concat();
    fs::write(folder.join("room.mtl"), materials + "newmtl lamp\nKd 0 0 0\nKe 10 10 10\n").unwrap();
    fs::write(folder.join("room.obj"), text).unwrap();
}

fn pipeline(folder: &Path, load: &str, stages: &str) -> Pipeline {
    let text = format!("Pipeline(stages: [Load(path: \"room.obj\"{load}), {stages}])");
    Pipeline::parse(&text, &folder.join("room.ron")).unwrap_or_else(|e| panic!("{e}"))
}

/// Returns what `sir check` prepares.
fn prepared(folder: &Path, load: &str, stages: &str) -> Prepared {
    estimate(&pipeline(folder, load, stages), &NoProgress).unwrap().prepared
}

fn run(folder: &Path, load: &str, stages: &str) -> Report {
    let options = RunOptions { results: folder.join("results"), ..RunOptions::default() };
    run_pipeline(&pipeline(folder, load, stages), &options).unwrap().report
}

#[test]
fn a_file_in_millimeters_is_pointed_out_and_scaled() {
    let stages = "Light([Point(position: (2, 2.5, 2), power: 800)]), FirstShot(lines: 20_000), Multipath(lines: 20_000),
        Sensors(name: \"s\", at: Points([(position: (2, 0.75, 2), direction: (0, 1, 0))]))";
    let folder = tempfile::tempdir().unwrap();
    let mean = |report: &Report| report.stages.last().unwrap().sensors.as_ref().unwrap().mean;
    room(folder.path(), 1.0, None, 0.0);
    let meters = run(folder.path(), "", stages);
    assert_eq!(meters.warnings, [""; 0]);
    room(folder.path(), 1000.0, None, 0.0);
    let scaled = run(folder.path(), ", scale: 0.001", stages);
    assert_eq!((mean(&scaled), scaled.warnings), (mean(&meters), Vec::new()));

    // The lamp is far outside the room, which is far from it in meters.
    let unscaled = run(folder.path(), "", stages);
    assert!(unscaled.warnings[0].contains("looks like millimeters"), "{:?}", unscaled.warnings);
    assert!(unscaled.warnings[0].ends_with("set `Load(scale: 0.001)`"), "{:?}", unscaled.warnings);
    let info = inspect(&folder.path().join("room.obj")).unwrap();
    assert_eq!(info.findings, unscaled.warnings[..1]);
    assert!(info.settings.iter().any(|setting| setting.set.contains("scale: 0.001")), "{:?}", info.settings);
}

#[test]
fn a_lamp_that_something_covers_is_pointed_out() {
    let folder = tempfile::tempdir().unwrap();
    for (height, gap) in
        [(3.001, Some("1 mm in front of it")), (3.01, Some("10 mm in front of it")), (2.99, None)]
    {
        room(folder.path(), 1.0, Some(height), 0.0);
        let said = prepared(folder.path(), "", STAGES).suspicions;
        let info = inspect(&folder.path().join("room.obj")).unwrap();
        let Some(gap) = gap else {
            assert_eq!(said, [""; 0]);
            continue;
        };
        let expected =
            format!("the material \"lamp\" is covered by the material \"ceiling\", which lies {gap}");
        assert!(said.len() == 1 && said[0].contains(&expected), "{said:?}");
        assert_eq!(said, info.findings);
        assert!(!info.settings.iter().any(|setting| setting.set.contains("Both")), "{:?}", info.settings);
        let report = run(folder.path(), "", STAGES);
        assert_eq!(report.warnings, said);
    }
}

#[test]
fn a_triangle_that_makes_the_grid_coarse_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let said = |width| {
        room(folder.path(), 1.0, Some(2.99), width);
        prepared(folder.path(), "", STAGES).suspicions.join("\n")
    };
    assert!(!said(1e5).contains("steps of"));
    // A radius of 1414 km in 2³⁰ steps.
    let far = said(2e6);
    let expected = "the material \"ground\" reaches to (";
    assert!(far.contains(expected) && far.contains("in steps of 1.317 mm because of it"), "{far}");
}

#[test]
fn few_lines_in_what_is_lit_are_counted_unless_there_is_a_focus() {
    let folder = tempfile::tempdir().unwrap();
    room(folder.path(), 1.0, Some(2.99), 5000.0);
    let stages = "FirstShot(lines: 10_000), Multipath(lines: 1_000_000)";
    let focus = "Focus(min: (0.000, 0.000, 0.000), max: (4.000, 3.000, 4.000))";
    let plain = run(folder.path(), "", stages).warnings;
    // The room has a surface of 80 m², the hull of the scene one of about 5 × 10⁷ m².
    let expected = format!(
        "only about 2 of 1_000_000 global lines met the part of the scene that gets 90 % of the light, 4 × 3 × 4 m; its light \
         has large errors; set `{focus}`"
    );
    assert!(plain.contains(&expected), "{plain:?}");
    assert!(plain[0].contains(focus), "{plain:?}");
    let focused = run(folder.path(), "", &format!("{focus}, {stages}")).warnings;
    assert!(
        !focused.iter().any(|warning| warning.contains("Focus") || warning.contains("only")),
        "{focused:?}"
    );
}

#[test]
fn the_default_camera_is_recorded_as_a_pipeline_states_it() {
    let folder = tempfile::tempdir().unwrap();
    room(folder.path(), 1.0, Some(2.99), 0.0);
    let stages = |camera: &str| {
        format!("FirstShot(lines: 10_000), Save([Image(path: \"a.png\", width: 40, samples: 1{camera})])")
    };
    let report = run(folder.path(), "", &stages(""));
    let camera = report.outputs[0].camera.as_ref().unwrap();
    assert!(camera.starts_with("Camera(eye: ("), "{camera}");
    let again = run(folder.path(), "", &stages(&format!(", camera: {camera}")));
    assert_eq!(again.outputs[0].camera, None);
    let picture = |name: &str| fs::read(folder.path().join("results").join(name).join("a.png")).unwrap();
    let mut runs: Vec<_> = fs::read_dir(folder.path().join("results"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    runs.sort();
    assert!(runs.len() == 2 && picture(&runs[0]) == picture(&runs[1]));
}

#[test]
fn the_up_direction_is_recorded_and_can_be_stated() {
    let folder = tempfile::tempdir().unwrap();
    room(folder.path(), 1.0, Some(2.99), 0.0);
    let shown = run(folder.path(), "", STAGES).scene;
    assert_eq!((shown.up, shown.up_from.as_str()), ([0.0, 1.0, 0.0], "lamps shine along −y"));
    let stated = prepared(folder.path(), ", up: (0, 0, 2)", STAGES);
    assert_eq!((stated.up, stated.suspicions), (DVec3::Z, Vec::new()));
    // A sky keeps its own zenith.
    let sky =
        |sky| prepared(folder.path(), ", up: (0, 0, 1)", &format!("Light([{sky}]), {STAGES}")).suspicions;
    let doubt = sky("Sky(horizontal: 100)").join("\n");
    assert!(doubt.contains("set `up: (0, 0, 1)` in `Sky`"), "{doubt}");
    assert_eq!(sky("Sky(horizontal: 100, up: (0, 0, 1))"), [""; 0]);
    assert_eq!(sky("Environment(radiance: 100)"), [""; 0]);
}

#[test]
fn light_that_meets_nothing_is_pointed_out() {
    let folder = tempfile::tempdir().unwrap();
    room(folder.path(), 1.0, None, 0.0);
    let light = |lamp: &str| format!("Light([{lamp}]), {STAGES}");
    let outside = run(folder.path(), ", sides: Front", &light("Point(position: (2, 5, 2), power: 10)"));
    assert!(outside.warnings[0].contains("are the lamps outside of the room"), "{:?}", outside.warnings);
    let sun = "Distant(direction: (0.1, -1, 0.2), irradiance: 1000)";
    let sun = run(folder.path(), ", sides: Front", &light(sun));
    assert!(sun.warnings[0].starts_with("next to nothing of the power"), "{:?}", sun.warnings);
    let inside = run(folder.path(), ", sides: Front", &light("Point(position: (2, 3, 2), power: 10)"));
    assert_eq!(inside.warnings, [""; 0], "half of a lamp in the ceiling lights the room");
}

#[test]
fn a_grid_that_is_coarser_than_the_room_is_pointed_out() {
    for width in [1e8, 1e10, 1e12] {
        let folder = tempfile::tempdir().unwrap();
        room(folder.path(), 1.0, Some(2.9), width);
        let warnings = run(folder.path(), "", STAGES).warnings;
        assert!(
            warnings.iter().any(|warning| warning.contains("\"ground\"") && warning.contains("steps of")),
            "{warnings:?}"
        );
    }
}

#[test]
fn a_copy_of_a_lamp_is_pointed_out() {
    let folder = tempfile::tempdir().unwrap();
    room(folder.path(), 1.0, Some(2.9), 0.0);
    let text = fs::read_to_string(folder.path().join("room.obj")).unwrap();
    fs::write(folder.path().join("room.obj"), text + "usemtl lamp\nf 1 2 3 4\n").unwrap();
    let warnings = run(folder.path(), "", STAGES).warnings;
    assert!(warnings[0].starts_with("50.0 % of the light of lamps ends where it begins"), "{warnings:?}");
}

/// A `Grid` keeps points outside of the room, which are dark.
#[test]
fn a_grid_that_leaves_the_room_is_pointed_out() {
    let folder = tempfile::tempdir().unwrap();
    room(folder.path(), 1.0, Some(2.5), 0.0);
    let warnings = |grid: &str| -> Vec<String> {
        let stages = format!("{STAGES}, Sensors(name: \"desk\", at: Grid({grid}))");
        prepared(folder.path(), "", &stages).suspicions
    };
    for inside in [
        "corner: (0, 0.75, 4), along: (4, 0, 0), across: (0, 0, -4), spacing: 1",
        // On the floor, and on a wall.
        "corner: (0, 0, 4), along: (4, 0, 0), across: (0, 0, -4), spacing: 1",
        "corner: (0, 0, 0), along: (4, 0, 0), across: (0, 3, 0), spacing: 0.5",
    ] {
        assert_eq!(warnings(inside), [""; 0], "{inside}");
    }
    let outside = warnings("corner: (2, 0.75, 4), along: (4, 0, 0), across: (0, 0, -4), spacing: 1");
    assert!(
        outside.len() == 1
            && outside[0].starts_with("8 of 16 points of the `Grid` \"desk\" are outside of the scene"),
        "{outside:?}"
    );
}
