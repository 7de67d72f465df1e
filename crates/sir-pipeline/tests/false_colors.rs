//! Images of luminance and illuminance in false colors, and daylight factors, from file to files.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use std::fs;
use std::path::Path;

use sir_pipeline::Error;
use sir_pipeline::plan::Pipeline;
use sir_pipeline::report::Verdict;
use sir_pipeline::run::{RunOptions, RunResult, run_pipeline as run};

/// Black floor of 2 by 2 m at y = 0 and a gray roof of the same size at y = 3.
const SCENE: &str = "mtllib scene.mtl\nv 0 0 0\nv 0 0 2\nv 2 0 2\nv 2 0 0\nv 0 3 0\nv 0 3 2\nv 2 3 2\nv 2 3 0
usemtl black\nf 1 2 3 4\nusemtl gray\nf 5 6 7 8\n";
const MATERIALS: &str = "newmtl black\nKd 0 0 0\nnewmtl gray\nKd 0.5 0.5 0.5\n";

fn run_with(light: &str, stages: &str) -> (tempfile::TempDir, Result<RunResult, Error>) {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.obj"), SCENE).unwrap();
    fs::write(folder.path().join("scene.mtl"), MATERIALS).unwrap();
    let text = format!(
        "(units: Photometric, stages: [Load(path: \"scene.obj\"), Light([{light}]), FirstShot(lines: 100_000), {stages}])"
    );
    let options = RunOptions { out: Some(folder.path().join("out")), ..RunOptions::default() };
    let outcome = Pipeline::parse(&text, &folder.path().join("x.ron"))
        .map_err(Error::from)
        .and_then(|pipeline| run(&pipeline, &options));
    (folder, outcome)
}

const SKY: &str = "Sky(model: Overcast, horizontal: 10_000)";

/// Returns the width and the height of a PNG image, from its header.
fn size(path: &Path) -> [u32; 2] {
    let bytes = fs::read(path).unwrap();
    [16, 20].map(|at| u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap()))
}

#[test]
fn pictures_of_numbers_have_a_scale_beside_them() {
    let camera = "width: 160, height: 120, samples: 1, camera: Camera(eye: (6, 5, 7), target: (1, 1, 1))";
    let stages = format!(
        r#"Save([
            Image(path: "own.png", {camera}),
            Image(path: "nits.png", show: Luminance, {camera}),
            Image(path: "lux.png", show: Illuminance, limits: (0, 12_000), {camera}),
        ])"#
    );
    let (_folder, result) = run_with(SKY, &stages);
    let out = result.unwrap_or_else(|error| panic!("{}", error.chain())).directory;
    let [own, nits, lux] = ["own.png", "nits.png", "lux.png"].map(|name| size(&out.join(name)));
    assert_eq!((own, nits), ([160, 120], lux));
    assert!(nits[0] >= 160 + 100 && nits[1] >= 120 + 40, "{nits:?}");
    assert_ne!(fs::read(out.join("nits.png")).unwrap(), fs::read(out.join("lux.png")).unwrap());
}

#[test]
fn contradictory_images_are_refused() {
    for (image, reason) in [
        (r#"path: "a.exr", show: Luminance"#, "an EXR image has no false colors"),
        (r#"path: "a.png", limits: (1, 2)"#, "`limits` has no effect (it belongs to false colors)"),
        (r#"path: "a.png", scale: Linear"#, "`scale` has no effect (it belongs to false colors)"),
        (r#"path: "a.png", show: Luminance, exposure: 2"#, "`exposure` has no effect"),
        (r#"path: "a.png", show: Luminance, limits: (0, 5)"#, "a logarithmic scale cannot begin at zero"),
        (r#"path: "a.png", show: Luminance, limits: (5, 1)"#, "`limits` must begin with the smaller number"),
        (r#"path: "a.png", show: Luminance, limits: 5"#, "`limits` must be two numbers"),
        (r#"path: "a.png", show: Luminace"#, "did you mean `Luminance`?"),
    ] {
        let message = run_with(SKY, &format!("Save(Image({image}))")).1.map(|_| ()).unwrap_err().chain();
        assert!(message.contains(reason) && message.contains("help: "), "{image}: {message}");
    }
}

/// A point that sees all of the sky has a daylight factor of 100 %. Under the middle of a black roof that is wide and
/// close it is small.
#[test]
fn daylight_factors_refer_to_an_unobstructed_horizontal_surface() {
    let stages = r#"
        Sensors(name: "above", at: Points([(position: (1, 4, 1), direction: (0, 1, 0))]), daylight_factor: true,
            require: (daylight_factor: 90)),
        Sensors(name: "below", at: Grid(corner: (0, 2.9, 2), along: (2, 0, 0), across: (0, 0, -2)),
            daylight_factor: true, require: (daylight_factor: 90)),
    "#;
    let (_folder, result) = run_with(SKY, stages);
    let result = result.unwrap_or_else(|error| panic!("{}", error.chain()));
    let reports: Vec<_> = result.report.stages.iter().filter_map(|s| s.sensors.as_ref()).collect();
    let [above, below] = [0, 1].map(|i| reports[i].daylight.unwrap());
    assert_eq!(above.outdoor, 10_000.0);
    assert!((above.mean - 100.0).abs() < 4.0 * above.mean_error && above.mean_error < 0.5, "{above:?}");
    assert!(below.mean < 50.0 && below.minimum < 10.0 && below.minimum < below.mean, "{below:?}");
    assert!((below.mean / reports[1].mean - 0.01).abs() < 1e-12);
    let verdicts = reports.iter().map(|r| r.requirements[0].verdict);
    assert_eq!(verdicts.collect::<Vec<_>>(), [Verdict::Passes, Verdict::Fails]);
    let table = fs::read_to_string(result.directory.join("above.csv")).unwrap();
    let [head, row] = table.lines().collect::<Vec<_>>()[..] else { panic!("{table}") };
    assert!(
        head.ends_with(",se,DF") && row.split(',').next_back().unwrap().starts_with("99.")
            || row.split(',').next_back().unwrap().starts_with("100."),
        "{table}"
    );
}

#[test]
fn daylight_factors_need_an_overcast_sky_and_nothing_else() {
    let sensors = r#"Sensors(name: "a", at: Points([(position: (1, 4, 1), direction: (0, 1, 0))]), daylight_factor: true)"#;
    for (light, reason) in [
        (
            "Point(position: (1, 2, 1), power: 10)",
            "`daylight_factor` needs a `Sky`, but the pipeline has none",
        ),
        ("Environment(radiance: 3)", "`daylight_factor` needs a `Sky`, but the pipeline has none"),
        (
            "Sky(model: Cie(type: 12, sun: (0, 1, 0)), horizontal: 5)",
            "the sky of CIE type 12 has no daylight factor (it is not overcast)",
        ),
        (
            "Sky(model: Overcast, horizontal: 5), Point(position: (1, 2, 1), power: 10)",
            "`daylight_factor` needs the sky as the only source, but there is more: 1 point",
        ),
        ("Sky(horizontal: 0, ground: 5)", "(the sky is black)"),
    ] {
        let message = run_with(light, sensors).1.map(|_| ()).unwrap_err().chain();
        assert!(message.contains(reason) && message.contains("x.ron:1:"), "{light}: {message}");
    }
    let required = sensors.replace("daylight_factor: true", "require: (daylight_factor: 2)");
    let message = run_with(SKY, &required).1.map(|_| ()).unwrap_err().chain();
    assert!(message.contains("a daylight factor is required, but not measured"), "{message}");
}
