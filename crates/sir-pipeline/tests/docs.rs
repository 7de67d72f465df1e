//! Checks that the reference of the pipeline file agrees with the program.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use std::fs;
use std::path::{Path, PathBuf};

use sir_pipeline::plan::{Action, Pipeline, schema};

fn path() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/pipeline.md")
}

fn page(name: &str) -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs").join(name)).unwrap()
}

fn reference() -> String {
    fs::read_to_string(path()).unwrap()
}

/// Returns the examples of the reference, parsed in a folder that has their scene. All must be valid.
fn examples(page: &str) -> Vec<Pipeline> {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("room.gltf"), "").unwrap();
    let blocks = page.split("```ron\n").skip(1).map(|block| block.split("```").next().unwrap());
    blocks
        .map(|block| {
            Pipeline::parse(block, &folder.path().join("pipeline.ron")).unwrap_or_else(|e| panic!("{e}"))
        })
        .collect()
}

#[test]
fn all_examples_are_valid() {
    assert_eq!(examples(&reference()).len(), 5);
    assert_eq!(examples(&page("guide.md")).len(), 2);
}

#[test]
fn the_defaults_are_those_of_the_reference() {
    let all = examples(&reference());
    let actions = |p: &Pipeline| -> Vec<Action> {
        let mut actions: Vec<Action> = p.stages.iter().map(|s| s.action.clone()).collect();
        for action in &mut actions {
            if let Action::Load(load) = action {
                load.path = PathBuf::new();
            }
        }
        actions
    };
    // The last two examples are equal: one is written out, the other is short.
    let [.., long, short] = &all[..] else { panic!("two examples") };
    assert_eq!(long.seed, short.seed);
    assert_eq!(long.units, short.units);
    assert_eq!(actions(long), actions(short));
}

/// Tests the pipelines in the folder `scenes` of the project.
#[test]
fn pipelines_of_the_project_are_valid() {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let folders = fs::read_dir(scenes).unwrap().map(|entry| entry.unwrap().path());
    let pipelines: Vec<PathBuf> = folders.map(|f| f.join("pipeline.ron")).filter(|p| p.is_file()).collect();
    assert!(!pipelines.is_empty());
    for path in pipelines {
        Pipeline::read(&path).unwrap_or_else(|e| panic!("{e}"));
    }
}

/// Compares the tables of fields in the reference, each below a comment `<!-- fields of NAME -->`, with those generated
/// by the program. Run with `UPDATE_DOCS=1` to update them.
#[test]
fn tables_of_fields_are_those_of_the_program() {
    let old = reference();
    let mut new = old.clone();
    for record in schema().records {
        let table = record.to_markdown();
        let mark = format!("<!-- fields of {} -->\n", record.name);
        let start = new.find(&mark).unwrap_or_else(|| panic!("the reference lacks {mark}")) + mark.len();
        let end = start
            + new[start..]
                .split_inclusive('\n')
                .take_while(|line| line.starts_with('|'))
                .map(str::len)
                .sum::<usize>();
        new.replace_range(start..end, &table);
    }
    if std::env::var_os("UPDATE_DOCS").is_some() {
        fs::write(path(), &new).unwrap();
    } else {
        assert!(
            new == old,
            "docs/pipeline.md is not up to date: run `UPDATE_DOCS=1 cargo test -p sir-pipeline --test docs`"
        );
    }
}

/// Reads, writes and reads again pipelines that use all fields: nothing is lost.
#[test]
fn what_is_written_is_what_was_read() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("room \"1\".obj"), "").unwrap();
    fs::write(folder.path().join("points.txt"), "0 1 0 0 0.1 0").unwrap();
    let multipath = [
        "Multipath(lines: 3_000)",
        "Multipath(lines: 3_000, transport: Replicas)",
        "Multipath(lines: 3_000, transport: Replicas(count: 8, tail: 0), domain: Sphere)",
    ];
    let subdivide = ["max_area: 1.5e-7", "max_edge: 0.25", "patches: 20_000", "per_face: true"];
    let repeat = ["times: 3", "until: RelativeError(0.001), at_most: 7", "until: Seconds(1.5)"];
    let sky = [
        "Sky(horizontal: 1)",
        "Environment(radiance: (3, 2, 1))",
        "Sky(model: Cie(type: 3, sun: (0.1, 0.7, 0)), up: (0, 2, 0), horizontal: 1e4, ground: 7)",
    ];
    let some = |of: &[&'static str], i: usize| of[i % of.len()];
    for i in 0..4 {
        let (multipath, subdivide) = (some(&multipath, i), some(&subdivide, i));
        let mut lines = format!(
            "FirstShot(lines: 1e6), Save(Table(path: \"direct.npy\")), SecondShot(lines: 5), {multipath}"
        );
        if i == 3 {
            lines = format!(
                "Focus(min: (0, 0, 0), max: (1, 2, 3), share: 0.5), {}",
                lines.replace(multipath, "Multipath(lines: 1)")
            );
        }
        let repeated = format!("Repeat({}, stages: [FirstShot(lines: 10), {multipath}])", some(&repeat, i));
        for lines in [lines, repeated] {
            let text = format!(
                r#"Pipeline(seed: 18_446_744_073_709_551_615, units: Photometric, stages: [
                Load(path: "room \"1\".obj", sides: Both),
                Light([
                    Point(position: (1, 2, 3), power: 60, spread: Spot(axis: (0, -2, 0.1), inner: 0.1, outer: 33.3)),
                    Point(position: (1, 2, 3), intensity: (0.1, 0.2, 0.3), spread: Lambertian(axis: (1, 1, 1))),
                    Distant(direction: (0.3, -2, 0.1), irradiance: 1, group: "sun \"1\""),
                    Group(name: "ceiling", materials: ["a", "b"], lights: ["c"]), Group(name: "none"),
                    Panel(corner: (0.1, 1, 2), edges: ((1, 0, 0), (0, 0.3, 1)), exitance: 5),
                    Panel(corner: (0.1, 1, 2), edges: ((1, 0, 0), (0, 0.3, 1)), power: 7e-9),
                    {},
                ]),
                Subdivide({subdivide}), {lines},
                Sensors(name: "a/desk", at: Plane(height: 0.75, spacing: 0.1)),
                Sensors(name: "f", at: Probes(spacing: 2)),
                Sensors(name: "g", at: Probes(spacing: 0.3, min: (0, -1, 0), max: (1, 1, 2.5), backs: 0.1), rays: 100),
                Sensors(name: "b", at: Plane(height: -1, spacing: 3, border: 0.5, up: (0, 0, 2)), rays: 7, error: 0.01),
                Sensors(name: "h", at: Plane(height: 0.75, border: Standard, direction: (1, 0, 0)), measure: Cylindrical, require: (mean: 500, uniformity: 0.6)),
                Sensors(name: "i", at: Plane(height: 1), measure: SemiCylindrical(direction: (1, 0, 0))),
                Sensors(name: "j", at: Plane(height: 1, direction: (1, 0, 0)), measure: SemiCylindrical, daylight_factor: true, require: (daylight_factor: 2)),
                Sensors(name: "c", at: Grid(corner: (0, 0, 0), along: (1, 0, 0), across: (0, 1, 1), spacing: 0.3)),
                Sensors(name: "d", at: Points([(position: (1, 2, 3), direction: (0, 3, 0.1))])),
                Sensors(name: "e", at: File("points.txt")),
                Save([
                    Image(path: "a/view.png", width: 320, height: 200, samples: 2, exposure: 1.6, denoise: false, camera: "b\\c"),
                    Image(path: "two.exr", camera: 1),
                    Image(path: "lux.png", show: Illuminance, limits: (0, 500)),
                    Image(path: "nits.png", show: Luminance, scale: Linear),
                    Image(path: "three.png", camera: Camera(eye: (0, 0, 4), target: (0, 0.1, 1), fov: 60)),
                    Gltf(path: "x.glb"), Table(path: "t.csv"),
                ]),
            ])"#,
                some(&sky, i)
            );
            let pipeline =
                Pipeline::parse(&text, &folder.path().join("x.ron")).unwrap_or_else(|e| panic!("{e}"));
            let written = pipeline.to_ron();
            let again =
                Pipeline::parse(&written, Path::new("/elsewhere/x.ron")).unwrap_or_else(|e| panic!("{e}"));
            assert_eq!((again.seed, again.units), (pipeline.seed, pipeline.units));
            assert_eq!(again.stages, pipeline.stages, "{written}");
            assert_eq!(again.to_ron(), written);
        }
    }
}

/// All records are in the reference: those that `plan/reference.rs` lists are those that are declared.
#[test]
fn all_records_have_a_table() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/plan");
    let mut declared = 0;
    for entry in fs::read_dir(folder).unwrap() {
        let text = fs::read_to_string(entry.unwrap().path()).unwrap();
        declared += text.matches("\nrecord! {").count();
    }
    assert_eq!(
        schema().records.len(),
        declared,
        "add the new record to plan/reference.rs, and its mark to docs/pipeline.md"
    );
}
