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
//!
//! The error of the truth is part of the errors, except for the intervals. Patches count if their stated error is below 10 %.

#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a benchmark that fails, fails like a test")]

mod rooms;

use std::ops::AddAssign;
use std::path::Path;
use std::time::Instant;

use rooms::{Room, rooms};
use sir::pipeline::plan::Pipeline;
use sir::pipeline::report::Report;
use sir::pipeline::run::{RunOptions, run_pipeline};
use sir::view::Table;

/// Lines of the reference over those of a run, and the largest number of its lines.
const REFERENCE: (u64, u64) = (400, 150_000_000);

/// Largest relative error of a patch that counts. Larger errors are themselves uncertain.
const LARGEST: f64 = 0.1;

/// Rays of a sensor in a run and in the reference.
const RAYS: [u64; 2] = [1 << 10, 1 << 17];

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
fn run(room: &Room, lines: u64, rays: u64, seed: u64, folder: &Path) -> Values {
    let text = room.pipeline(lines, rays, seed, folder);
    let pipeline = Pipeline::parse(&text, &folder.join("room.ron")).unwrap();
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
#[derive(Clone, Copy, Default)]
struct Sums {
    count: f64,
    truth: f64,
    deviation: f64,
    square: f64,
    stated: f64,
    /// Sum of the squared errors of the truth.
    of_truth: f64,
    within: f64,
}

impl AddAssign for Sums {
    fn add_assign(&mut self, other: Self) {
        self.count += other.count;
        self.truth += other.truth;
        self.deviation += other.deviation;
        self.square += other.square;
        self.stated += other.stated;
        self.of_truth += other.of_truth;
        self.within += other.within;
    }
}

impl Sums {
    fn add(&mut self, [value, error]: Value, [truth, of_truth]: Value, quantile: f64) {
        let deviation = value - truth;
        self.count += 1.0;
        self.truth += truth;
        self.deviation += deviation;
        self.square += deviation * deviation;
        self.stated += error * error;
        self.of_truth += of_truth * of_truth;
        self.within += f64::from(u8::from(deviation.abs() <= quantile * error));
    }

    /// Returns the relative error that is stated.
    fn relative_error(&self) -> f64 {
        (self.stated * self.count).sqrt() / self.truth
    }

    /// Prints a line. The bias of patches has no standard error, because the patches of a run are not independent.
    fn print(&self, room: &str, what: &str, is_single: bool) {
        let n = self.count;
        let (mean, bias) = (self.truth / n, self.deviation / n);
        let z = bias / ((self.square / n - bias * bias + self.of_truth) / n).sqrt();
        println!(
            "{room:<16} {what:<18} {:>8.2} {:>8.2} {:>6} {:>7.3} {:>7.1}",
            100.0 * self.relative_error(),
            100.0 * bias / mean,
            if is_single { format!("{z:.1}") } else { String::new() },
            (self.square / (self.stated + self.of_truth)).sqrt(),
            100.0 * self.within / n
        );
    }
}

fn measure(room: &Room, seeds: u64) {
    let folder = tempfile::tempdir().unwrap();
    let start = Instant::now();
    let (factor, most) = REFERENCE;
    let lines = if room.is_exact() { room.lines } else { (factor * room.lines).min(most) };
    let [rays, most_rays] = RAYS;
    let Values { sensors: truths, patches: of_patches, .. } =
        run(room, lines, most_rays, 1_000_003, folder.path());
    let known = |exact: Option<f64>, truth: Value| exact.map_or(truth, |exact| [exact, 0.0]);
    let mut sensors = vec![Sums::default(); truths.len()];
    let mut patches = vec![Sums::default(); of_patches.len()];
    for seed in 1..=seeds {
        let values = run(room, room.lines, rays, seed, folder.path());
        for (i, value) in values.sensors.into_iter().enumerate() {
            sensors[i].add(value, known(room.sensors[i].exact, truths[i]), values.quantile);
        }
        for (i, value) in values.patches.into_iter().enumerate() {
            patches[i].add(value, known(room.exact, of_patches[i]), values.quantile);
        }
    }
    for (sums, sensor) in sensors.iter().zip(&room.sensors) {
        sums.print(room.name, sensor.name, true);
    }
    let (mut all, mut count) = (Sums::default(), 0);
    for sums in patches.iter().filter(|sums| sums.relative_error() < LARGEST) {
        all += *sums;
        count += 1;
    }
    all.print(room.name, &format!("{count} of {} patches", patches.len()), false);
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
        "{:<16} {:<18} {:>8} {:>8} {:>6} {:>7} {:>7}",
        "room", "quantity", "error, %", "bias, %", "z", "ratio", "in 95 %"
    );
    for room in rooms() {
        if words.is_empty() || words.iter().any(|word| room.name.contains(word.as_str())) {
            measure(&room, seeds);
        }
    }
}
