//! Benchmark of stated errors: many runs with independent seeds, whose deviations from the truth are compared with the
//! errors that the runs state.
//!
//! ```text
//! cargo bench --bench honesty                                  # all rooms, 400 seeds each
//! cargo bench --bench honesty -- furnace hole --seeds 48       # rooms whose names contain one of these words
//! ```
//!
//! The truth is an exact answer, or the light of the same patches with up to 400 times the lines. The table has, per sensor and
//! for all patches:
//!
//! * the stated relative error, root mean square;
//! * the bias, in per cent and in standard errors of the mean of all runs;
//! * the ratio of the root mean square deviation to the root mean square of the stated errors: 1 ± 1/√(2 seeds);
//! * the share of the intervals of 95 % (Student's t) that contain the truth.

#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a benchmark that fails, fails like a test")]

mod rooms;

use std::path::Path;
use std::time::Instant;

use rooms::{Room, rooms};
use sir::pipeline::plan::Pipeline;
use sir::pipeline::report::Report;
use sir::pipeline::run::{RunOptions, run_pipeline};
use sir::view::Table;

/// Lines of the reference over those of a run, and the largest number of its lines. Its error adds to the deviations.
const REFERENCE: (u64, u64) = (400, 150_000_000);

/// Patches count if their light is more than this share of the mean. Most of the others are covered by other surfaces.
const DARK: f64 = 1e-3;

/// Quantiles .975 of Student's t with 7 to 15 degrees of freedom, for 8 to 16 repeats.
const T: [f64; 9] = [2.365, 2.306, 2.262, 2.228, 2.201, 2.179, 2.160, 2.145, 2.131];

/// Quantile .975 of the normal distribution.
const NORMAL: f64 = 1.960;

/// A value with its stated standard error.
type Value = [f64; 2];

/// Values of a run.
struct Values {
    /// Irradiance at each sensor.
    sensors: Vec<Value>,
    /// Radiosity of each patch.
    patches: Vec<Value>,
    /// Stated errors times this are half an interval of 95 %.
    quantile: f64,
}

/// Runs a room.
fn run(room: &Room, lines: u64, seed: u64, folder: &Path) -> Values {
    let pipeline = Pipeline::parse(&room.pipeline(lines, seed, folder), &folder.join("room.ron")).unwrap();
    let out = folder.join("out");
    let options = RunOptions { out: Some(out.clone()), force: true, ..RunOptions::default() };
    let Report { stages, .. } = run_pipeline(&pipeline, &options).unwrap().report;
    let sensors = stages.iter().filter_map(|stage| stage.sensors.as_ref()).map(|s| [s.mean, s.mean_error]);
    let repeats = stages.iter().find_map(|stage| stage.repeats).unwrap_or(1);
    let table = Table::read(&out.join("patches.npy")).unwrap();
    let patches = table.rows.iter().filter(|row| room.contains(row.center));
    Values {
        sensors: sensors.collect(),
        patches: patches.map(|row| [row.radiosity.y, row.error.y]).collect(),
        quantile: if repeats < 8 { NORMAL } else { T[(repeats as usize).min(16) - 8] },
    }
}

/// Sums over runs of the deviations of one quantity, or of several.
#[derive(Default)]
struct Sums {
    count: f64,
    truth: f64,
    deviation: f64,
    square: f64,
    stated: f64,
    within: f64,
}

impl Sums {
    fn add(&mut self, [value, error]: Value, truth: f64, quantile: f64) {
        let deviation = value - truth;
        self.count += 1.0;
        self.truth += truth;
        self.deviation += deviation;
        self.square += deviation * deviation;
        self.stated += error * error;
        self.within += f64::from(u8::from(deviation.abs() <= quantile * error));
    }

    /// Prints a line. The bias of patches has no standard error, because the patches of a run are not independent.
    fn print(&self, room: &str, what: &str, is_single: bool) {
        let n = self.count;
        let (mean, bias) = (self.truth / n, self.deviation / n);
        let z = bias / ((self.square / n - bias * bias) / n).sqrt();
        println!(
            "{room:<16} {what:<10} {:>8.2} {:>8.2} {:>6} {:>7.3} {:>7.1}",
            100.0 * (self.stated / n).sqrt() / mean,
            100.0 * bias / mean,
            if is_single { format!("{z:.1}") } else { String::new() },
            (self.square / self.stated).sqrt(),
            100.0 * self.within / n
        );
    }
}

fn measure(room: &Room, seeds: u64) {
    let folder = tempfile::tempdir().unwrap();
    let start = Instant::now();
    let (factor, most) = REFERENCE;
    let lines = if room.is_exact() { room.lines } else { (factor * room.lines).min(most) };
    let truth = run(room, lines, 1_000_003, folder.path());
    let truth_of = |i: usize| room.sensors[i].exact.unwrap_or(truth.sensors[i][0]);
    let of_patch: Vec<f64> = truth.patches.iter().map(|[truth, _]| room.exact.unwrap_or(*truth)).collect();
    let least = DARK * of_patch.iter().sum::<f64>() / of_patch.len() as f64;
    let (mut sensors, mut patches) = (Vec::new(), Sums::default());
    sensors.resize_with(room.sensors.len(), Sums::default);
    for seed in 1..=seeds {
        let Values { sensors: values, patches: of_patches, quantile } =
            run(room, room.lines, seed, folder.path());
        for (i, (sums, value)) in sensors.iter_mut().zip(values).enumerate() {
            sums.add(value, truth_of(i), quantile);
        }
        for (value, truth) in of_patches.into_iter().zip(&of_patch).filter(|(_, truth)| **truth > least) {
            patches.add(value, *truth, quantile);
        }
    }
    for (sums, sensor) in sensors.iter().zip(&room.sensors) {
        sums.print(room.name, sensor.name, true);
    }
    patches.print(room.name, "patches", false);
    println!("{:<16} {seeds} seeds in {:.0} s", room.name, start.elapsed().as_secs_f64());
}

fn main() {
    let (mut words, mut seeds) = (Vec::new(), 400);
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            // Cargo passes this option to every benchmark.
            "--bench" => {}
            "--seeds" => {
                seeds = arguments.next().and_then(|n| n.parse().ok()).expect("`--seeds` needs a number");
            }
            _ => words.push(argument),
        }
    }
    println!(
        "{:<16} {:<10} {:>8} {:>8} {:>6} {:>7} {:>7}",
        "room", "quantity", "error, %", "bias, %", "z", "ratio", "in 95 %"
    );
    for room in rooms() {
        if words.is_empty() || words.iter().any(|word| room.name.contains(word.as_str())) {
            measure(&room, seeds);
        }
    }
}
