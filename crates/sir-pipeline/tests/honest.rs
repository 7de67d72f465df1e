//! Errors that runs state, against the spread over seeds, in a room that the sun lights through a window. A small sunlit
//! place lights everything else, so that all noise is inherited.

#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a test fails by panicking")]

use std::path::Path;

use sir_pipeline::plan::Pipeline;
use sir_pipeline::run::{RunOptions, run_pipeline};
use sir_view::Table;

const SEEDS: u64 = 48;

/// 99.9 % band of a χ² variable with 47 degrees of freedom, over 47 (Wilson and Hilferty 1931: 22.0 to 84.0).
const BAND: std::ops::Range<f64> = 0.468..1.787;

/// Values of a run, and the errors that it states.
struct Run {
    /// Irradiances at the sensors, and their errors.
    sensors: Vec<[f64; 2]>,
    /// Radiosities of the patches in the room, and their errors.
    patches: Vec<[f64; 2]>,
}

fn run(stages: &str, seed: u64) -> Run {
    let folder = tempfile::tempdir().unwrap();
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/sunlit-room/r.obj");
    let text = format!(
        "(seed: {seed}, stages: [Load(path: {scene:?}),
            Light([Distant(direction: (0, -0.5, 0.866025404), irradiance: 800)]), {stages},
            Save([Table(path: \"patches.npy\")]),
            Sensors(name: \"points\", rays: 2048, at: Points([
                (position: (1, 0.75, 4.5), direction: (0, 1, 0)), (position: (4, 0.75, 5), direction: (0, 1, 0))])),
        ])"
    );
    let out = folder.path().join("out");
    let pipeline = Pipeline::parse(&text, &folder.path().join("x.ron")).unwrap();
    let options = RunOptions { out: Some(out.clone()), ..RunOptions::default() };
    let report = run_pipeline(&pipeline, &options).unwrap().report;
    assert!(report.warnings.iter().all(|w| !w.contains("too few")), "{:?}", report.warnings);
    let table = Table::read(&out.join("patches.npy")).unwrap();
    let inside = |row: &&sir_view::Row| row.center.x.abs() <= 5.0 && (0.0..=6.0).contains(&row.center.z);
    let patches = table.rows.iter().filter(inside).map(|row| [row.radiosity.y, row.error.y]).collect();
    let mut lines = csv(&out.join("points.csv"));
    let names = lines.remove(0);
    let column = |name: &str| names.iter().position(|n| n == name).unwrap();
    let (value, error) = (column("E_g"), column("se_g"));
    let sensors = lines.iter().map(|line| [value, error].map(|k| line[k].parse().unwrap())).collect();
    Run { sensors, patches }
}

/// Returns the cells of a table.
fn csv(path: &Path) -> Vec<Vec<String>> {
    let text = std::fs::read_to_string(path).unwrap();
    text.lines().map(|line| line.split(',').map(str::to_owned).collect()).collect()
}

/// Returns the variance over the runs, and the mean of the variances that they state.
fn variances<'a>(values: impl Iterator<Item = &'a [f64; 2]> + Clone) -> [f64; 2] {
    let n = values.clone().count() as f64;
    let mean = values.clone().map(|v| v[0]).sum::<f64>() / n;
    let spread = values.clone().map(|v| (v[0] - mean) * (v[0] - mean)).sum::<f64>() / (n - 1.0);
    [spread, values.map(|v| v[1] * v[1]).sum::<f64>() / n]
}

/// Asserts that the errors of sensors and patches are those that the runs state.
fn assert_honest(name: &str, stages: &str) {
    let runs: Vec<Run> = (1..=SEEDS).map(|seed| run(stages, seed)).collect();
    for i in 0..runs[0].sensors.len() {
        let [spread, stated] = variances(runs.iter().map(|run| &run.sensors[i]));
        println!("{name}, sensor {i}: spread over stated {:.3}", (spread / stated).sqrt());
        assert!(BAND.contains(&(spread / stated)), "{name}, sensor {i}: {spread} {stated}");
    }
    let mut sums = [0.0; 2];
    for i in 0..runs[0].patches.len() {
        let variances = variances(runs.iter().map(|run| &run.patches[i]));
        sums.iter_mut().zip(variances).for_each(|(sum, variance)| *sum += variance);
    }
    let [spread, stated] = sums;
    println!("{name}, {} patches: spread over stated {:.3}", runs[0].patches.len(), (spread / stated).sqrt());
    assert!(BAND.contains(&(spread / stated)), "{name}, patches: {spread} {stated}");
}

#[test]
fn a_sunlit_room() {
    assert_honest("Solve", "Subdivide(patches: 400), Solve(lines: 400_000)");
}

#[test]
fn a_sunlit_room_in_focus() {
    let focus = "Focus(min: (0, 0, 0), max: (5, 2.8, 6)), Subdivide(patches: 400)";
    assert_honest("Focus", &format!("{focus}, Solve(lines: 200_000)"));
    let stages = "FirstShot(lines: 50_000), Multipath(lines: 150_000)";
    assert_honest("Focus, stages", &format!("{focus}, {stages}"));
}
