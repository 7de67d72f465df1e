//! Probes of a pipeline, from file to files.

#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout, reason = "a test fails by panicking")]

use std::f64::consts::PI;
use std::fs;
use std::num::NonZeroUsize;
use std::path::Path;

use serde_json::Value;
use sir_pipeline::Error;
use sir_pipeline::NoProgress;
use sir_pipeline::check::estimate;
use sir_pipeline::plan::Pipeline;
use sir_pipeline::run::{RunOptions, RunResult, run_pipeline as run};
use sir_radiosity::{COSINE_FACTORS, HARMONICS, harmonics};

/// Closed room of 2 × 3 × 2 m, y up, with equal emission and reflectance everywhere: the irradiance is 4 W/m² in green.
const FURNACE: &str = "mtllib m.mtl\nusemtl furnace
v 0 0 0\nv 2 0 0\nv 2 3 0\nv 0 3 0\nv 0 0 2\nv 2 0 2\nv 2 3 2\nv 0 3 2
f 1 2 3 4\nf 6 5 8 7\nf 5 1 4 8\nf 2 6 7 3\nf 5 6 2 1\nf 4 3 7 8\n";

/// The same room without emission, with a solid box of 0.8 m on its floor, and a lamp of 0.4 m below its ceiling.
const ROOM: &str = "mtllib m.mtl\nusemtl gray
v 0 0 0\nv 2 0 0\nv 2 3 0\nv 0 3 0\nv 0 0 2\nv 2 0 2\nv 2 3 2\nv 0 3 2
f 1 2 3 4\nf 6 5 8 7\nf 5 1 4 8\nf 2 6 7 3\nf 5 6 2 1\nf 4 3 7 8
v 0.1 0 0.1\nv 0.9 0 0.1\nv 0.9 0.8 0.1\nv 0.1 0.8 0.1\nv 0.1 0 0.9\nv 0.9 0 0.9\nv 0.9 0.8 0.9\nv 0.1 0.8 0.9
f 12 11 10 9\nf 15 16 13 14\nf 16 12 9 13\nf 11 15 14 10\nf 9 10 14 13\nf 16 15 11 12
usemtl lamp
v 1.4 2.8 1.4\nv 1.8 2.8 1.4\nv 1.8 2.8 1.8\nv 1.4 2.8 1.8\nf 17 18 19 20\n";

/// A black cube of 0.2 m at the origin.
const CUBE: &str = "mtllib m.mtl\nusemtl black
v -.1 -.1 -.1\nv .1 -.1 -.1\nv .1 .1 -.1\nv -.1 .1 -.1\nv -.1 -.1 .1\nv .1 -.1 .1\nv .1 .1 .1\nv -.1 .1 .1
f 4 3 2 1\nf 7 8 5 6\nf 8 4 1 5\nf 3 7 6 2\nf 1 2 6 5\nf 8 7 3 4\n";

const MATERIALS: &str = "newmtl furnace\nKd 0.5 0.5 0.5\nKe 0 0.6366197723675814 0
newmtl gray\nKd 0.7 0.5 0.3\nnewmtl black\nKd 0 0 0\nnewmtl lamp\nKd 0 0 0\nKe 100 100 100\n";

struct Case {
    folder: tempfile::TempDir,
    pipeline: Result<Pipeline, Error>,
}

impl Case {
    fn new(scene: &str, seed: u64, stages: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("s.obj"), scene).unwrap();
        fs::write(folder.path().join("m.mtl"), MATERIALS).unwrap();
        let text =
            format!("(seed: {seed}, stages: [Load(path: \"s.obj\", sides: Front, up: (0, 1, 0)), {stages}])");
        let pipeline = Pipeline::parse(&text, &folder.path().join("x.ron")).map_err(Error::from);
        Self { folder, pipeline }
    }

    fn run(&self, threads: usize) -> Result<RunResult, Error> {
        let out = Some(self.folder.path().join(format!("out{threads}")));
        let options = RunOptions { out, threads: NonZeroUsize::new(threads), ..RunOptions::default() };
        run(self.pipeline.as_ref().map_err(|error| panic!("{}", error.chain())).unwrap(), &options)
    }

    /// Runs the pipeline, and returns the result and the content of `p.json`.
    fn measure(&self) -> (RunResult, Value) {
        let result = self.run(2).unwrap_or_else(|error| panic!("{}", error.chain()));
        let content = json(&result.directory);
        (result, content)
    }

    /// Returns the message of the error that the pipeline causes.
    fn error(self) -> String {
        let message = match &self.pipeline {
            Err(error) => error.chain(),
            Ok(_) => self.run(1).map(|_| ()).unwrap_err().chain(),
        };
        assert!(
            !self.folder.path().join("out1").exists(),
            "nothing is written before all checks have passed"
        );
        message
    }
}

fn json(directory: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(directory.join("p.json")).unwrap()).unwrap()
}

/// Returns the numbers of a band of a field of a probe.
fn band(probe: &Value, field: &str, band: usize) -> Vec<f64> {
    let values = probe[field].as_array().unwrap_or_else(|| panic!("{field}: {probe}"));
    values.iter().map(|value| value[band].as_f64().unwrap()).collect()
}

fn position(probe: &Value) -> glam::DVec3 {
    glam::DVec3::from_array([0, 1, 2].map(|k: usize| probe["position"][k].as_f64().unwrap()))
}

#[test]
fn a_furnace_has_the_same_irradiance_in_all_directions() {
    let stages = "FirstShot(lines: 200_000), Multipath(lines: 100_000),
        Sensors(name: \"p\", at: Probes(spacing: 1), rays: 2_000)";
    let case = Case::new(FURNACE, 1, stages);
    let (result, content) = case.measure();
    let outputs = result.report.outputs.iter().map(|o| (o.path.as_str(), o.kind.as_str()));
    assert_eq!(outputs.collect::<Vec<_>>(), [("p.csv", "probes"), ("p.json", "harmonics")]);
    assert_eq!(
        (&content["name"], &content["unit"], &content["valid"]),
        (&"p".into(), &"W/m²".into(), &12.into())
    );
    assert_eq!(content["grid"]["counts"], serde_json::json!([2, 3, 2]));
    assert_eq!(content["grid"]["origin"], serde_json::json!([0.5, 0.5, 0.5]));
    let probes = content["probes"].as_array().unwrap();
    assert_eq!(probes.len(), 12);
    assert_eq!(position(&probes[3]), glam::DVec3::new(1.5, 1.5, 0.5));
    for probe in probes {
        let (values, errors) = (band(probe, "coefficients", 1), band(probe, "errors", 1));
        for (i, (value, error)) in values.iter().zip(errors).enumerate() {
            let exact = if i == 0 { 4.0 * (4.0 * PI).sqrt() } else { 0.0 };
            // Of 108 numbers, with errors from sixteen repeats.
            assert!((value - exact).abs() < 5.0 * error && error < 0.1, "{i}: {value} ± {error}");
        }
        // Radiance is irradiance over π.
        let radiance = band(probe, "radiance", 1)[0] / values[0];
        assert!((radiance * PI - 1.0).abs() < 1e-6, "{radiance}");
        for (value, error) in band(probe, "axes", 1).into_iter().zip(band(probe, "axes_errors", 1)) {
            assert!((value - 4.0).abs() < 5.0 * error && error < 0.05, "{value} ± {error}");
        }
        assert_eq!(band(probe, "coefficients", 0), [0.0; HARMONICS]);
    }
    let summary = result.report.stages.iter().find_map(|stage| stage.sensors.clone()).unwrap();
    assert_eq!((summary.points, summary.invalid), (12, Some(0)));
    assert!((summary.mean - 4.0 * 0.7152).abs() < 4.0 * summary.mean_error, "{summary:?}");
    let table = fs::read_to_string(result.directory.join("p.csv")).unwrap();
    assert!(table.starts_with("x,y,z,valid,backs,E_r,") && table.lines().count() == 13, "{table}");
}

/// A point light next to a black object: the irradiance is `I/r² max(0, n·l)`, and its coefficients are known.
#[test]
fn a_point_light_has_the_coefficients_of_a_clamped_cosine() {
    let stages = "Light([Point(position: (1, 2, 3), intensity: (1, 2, 3))]), FirstShot(lines: 10_000),
        Sensors(name: \"p\", at: Probes(spacing: 1, min: (0.5, -1, 0.5), max: (2.5, 1, 2.5)), rays: 64)";
    let (_, content) = Case::new(CUBE, 1, stages).measure();
    let probes = content["probes"].as_array().unwrap();
    assert_eq!(probes.len(), 8);
    for probe in probes {
        let to = glam::DVec3::new(1.0, 2.0, 3.0) - position(probe);
        for (k, intensity) in [1.0, 2.0, 3.0].into_iter().enumerate() {
            let irradiance = intensity / to.length_squared();
            let exact = harmonics(to.normalize());
            for (i, value) in band(probe, "coefficients", k).into_iter().enumerate() {
                let exact = irradiance * COSINE_FACTORS[i] * exact[i];
                // Numbers in the file have single precision.
                assert!((value - exact).abs() < 1e-6 * irradiance, "{i}: {value}, exact {exact}");
            }
        }
    }
}

const LIT: &str = "FirstShot(lines: 20_000), Multipath(lines: 20_000)";

#[test]
fn probes_in_solids_are_invalid() {
    let stages = format!("{LIT}, Sensors(name: \"p\", at: Probes(spacing: 1), rays: 64)");
    let case = Case::new(ROOM, 1, &stages);
    let (result, content) = case.measure();
    let probes = content["probes"].as_array().unwrap();
    let is_valid: Vec<bool> = probes.iter().map(|probe| probe["valid"].as_bool().unwrap()).collect();
    assert_eq!(is_valid, [false, true, true, true, true, true, true, true, true, true, true, true]);
    // Below is the floor, with which the bottom of the box is in contact.
    assert_eq!((probes[0]["backs"].as_f64(), &content["valid"]), (Some(0.87109375), &11.into()));
    assert!(probes[0].get("coefficients").is_none() && probes[1].get("coefficients").is_some());
    let summary = result.report.stages.iter().find_map(|stage| stage.sensors.clone()).unwrap();
    assert_eq!((summary.points, summary.invalid), (11, Some(1)));
    let table = fs::read_to_string(result.directory.join("p.csv")).unwrap();
    assert!(table.lines().nth(1).unwrap().starts_with("0.5,0.5,0.5,false,0.87109375,,,"), "{table}");
    // Probes on surfaces, in edges and in corners are invalid, and those behind walls.
    let at = "Probes(spacing: 1, min: (-0.5, -0.5, -0.5), max: (2.5, 3.5, 2.5))";
    let stages = format!("{LIT}, Sensors(name: \"p\", at: {at}, rays: 64)");
    let (_, content) = Case::new(ROOM, 1, &stages).measure();
    for probe in content["probes"].as_array().unwrap() {
        let p = position(probe);
        let is_inside = p.x == 1.0 && p.z == 1.0 && (p.y == 1.0 || p.y == 2.0);
        assert_eq!(probe["valid"].as_bool(), Some(is_inside), "{probe}");
        assert_eq!(probe["backs"].is_null(), !is_inside, "{probe}");
    }
}

#[test]
fn probes_are_the_same_by_any_number_of_threads() {
    let stages = format!("{LIT}, Sensors(name: \"p\", at: Probes(spacing: 0.6), rays: 500, error: 0.02)");
    let case = Case::new(ROOM, 1, &stages);
    let files = [1, 2, 3].map(|threads| {
        let directory = case.run(threads).unwrap().directory;
        ["p.csv", "p.json"].map(|file| fs::read(directory.join(file)).unwrap())
    });
    assert!(files[0] == files[1] && files[0] == files[2]);
}

/// Spread over seeds of all coefficients over the errors that runs state, from the spread of their repeats.
#[test]
fn stated_errors_are_those_of_the_spread_over_seeds() {
    const SEEDS: u64 = 32;
    let stages = "Subdivide(max_edge: 1), FirstShot(lines: 8_000), Multipath(lines: 40_000),
        Sensors(name: \"p\", at: Probes(spacing: 1, min: (1, 1, 0), max: (2, 2, 2)), rays: 500)";
    let of_seed = |seed| {
        let (result, content) = Case::new(ROOM, seed, stages).measure();
        assert!(result.report.warnings.is_empty(), "{:?}", result.report.warnings);
        let number = |probe: &Value, fields: [&str; 2]| {
            let [values, errors] = fields.map(|field| band(probe, field, 1));
            values.into_iter().zip(errors).collect::<Vec<_>>()
        };
        let probes = content["probes"].as_array().unwrap().iter();
        probes
            .flat_map(|probe| {
                [number(probe, ["coefficients", "errors"]), number(probe, ["axes", "axes_errors"])]
            })
            .flatten()
            .collect::<Vec<_>>()
    };
    let all: Vec<Vec<(f64, f64)>> = (1..=SEEDS).map(of_seed).collect();
    let (n, mut sum, mut extremes) = (SEEDS as f64, 0.0, [f64::INFINITY, 0.0f64]);
    for i in 0..all[0].len() {
        let values = all.iter().map(|run| run[i]);
        let mean = values.clone().map(|(value, _)| value).sum::<f64>() / n;
        let spread =
            values.clone().map(|(value, _)| (value - mean) * (value - mean)).sum::<f64>() / (n - 1.0);
        let ratio = spread / (values.map(|(_, error)| error * error).sum::<f64>() / n);
        sum += ratio;
        extremes = [extremes[0].min(ratio), extremes[1].max(ratio)];
    }
    let mean = sum / all[0].len() as f64;
    println!("{} quantities: mean {mean:.3} of spread² over stated², {extremes:.3?}", all[0].len());
    // The variance of 32 values is known to 25 %. The 30 quantities of a run are partly correlated.
    assert!((0.8..1.25).contains(&mean), "{mean}");
    assert!(extremes[0] > 0.3 && extremes[1] < 2.5, "{extremes:?}");
}

#[test]
fn impossible_probes_are_refused_with_the_reason() {
    for (at, reason) in [
        ("Probes()", "`Probes` lacks the field `spacing`"),
        ("Probes(spacing: 0)", "`spacing` must be a number above 0"),
        ("Probes(spacing: 1, backs: 2)", "`backs` must be a number from 0 to 1"),
        (
            "Probes(spacing: 1, min: (1, 1, 1), max: (0, 2, 2))",
            "`min` must not exceed `max` in any coordinate",
        ),
        ("Probes(spacing: 1, corner: (1, 1, 1))", "unknown field `corner` in `Probes`"),
        ("Probes(spaceing: 1)", "did you mean `spacing`?"),
        ("Probe(spacing: 1)", "did you mean `Probes`?"),
        ("Probes(spacing: 0.01)", "a grid of 200 by 300 by 200 probes is too fine: there may be 100_000"),
        ("Probes(spacing: 0.01)", "choose a `spacing` of at least 0.05 m"),
        ("Probes(spacing: 1e-300)", "is too fine"),
        ("Probes(spacing: 1, min: (3, 0, 0))", "is empty"),
        ("Probes(spacing: 1, min: (0.2, 0.2, 0.2), max: (0.7, 0.7, 0.7))", "none of these 1 probes is valid"),
    ] {
        let message = Case::new(ROOM, 1, &format!("{LIT}, Sensors(name: \"p\", at: {at})")).error();
        assert!(message.contains(reason), "{at}: {message}");
        assert!(message.contains("x.ron:1:") && message.contains("help: "), "{at}: {message}");
    }
    let twice = "Sensors(name: \"p\", at: Probes(spacing: 1)), Sensors(name: \"P\", at: Points([(position: (1, 1, 1), direction: (0, 1, 0))]))";
    let message = Case::new(ROOM, 1, &format!("{LIT}, {twice}")).error();
    assert!(message.contains("the output path \"P.csv\" is used twice"), "{message}");
}

#[test]
fn the_cost_of_probes_is_estimated() {
    let stages = |sensors: &str| format!("Repeat(times: 4, stages: [{LIT}]){sensors}");
    let case = |sensors: &str| {
        let case = Case::new(ROOM, 1, &stages(sensors));
        estimate(case.pipeline.as_ref().unwrap(), &NoProgress).unwrap()
    };
    let (without, with) = (case(""), case(", Sensors(name: \"p\", at: Probes(spacing: 1), rays: 1_000)"));
    assert!(
        with.peak_memory > without.peak_memory + 11 * 4_000,
        "{} {}",
        with.peak_memory,
        without.peak_memory
    );
    let sensors = with.stages.last().unwrap();
    // A quarter of the rays in each repeat, for each of six sensors of eleven probes.
    assert_eq!((sensors.name, sensors.lines), ("Sensors", 250 * 6 * 11));
    let text = with.to_string();
    assert!(text.contains("probes     12, 11 of them valid\n"), "{text}");
    assert!(text.contains("Sensors: 16_500 lines at "), "{text}");
}
