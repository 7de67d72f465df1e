//! Repeats: one repeat has the same bits as its stages alone; results do not depend on the number of workers, or on
//! interruptions.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

#[path = "../../sir-parallel/tests/parallel/ranks.rs"]
#[allow(dead_code, reason = "its tests use all of it")]
mod ranks;

use std::collections::BTreeMap;
use std::fs;
use std::num::NonZeroUsize;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering::Relaxed};
use std::time::Duration;

use sir_parallel::{Communicator, SingleProcess};
use sir_pipeline::Error;
use sir_pipeline::NoProgress;
use sir_pipeline::check::estimate;
use sir_pipeline::plan::Pipeline;
use sir_pipeline::report::{ErrorsFrom, ErrorsReport, Report, StageReport, Time};
use sir_pipeline::run::{RunOptions, resume_together, run_pipeline as run, run_together};
use sir_radiosity::MIN_REPEATS;

const SHOTS: &str = "FirstShot(lines: 6_000), SecondShot(lines: 2_000)";
const BATCHES: &str = "Multipath(lines: 8_000)";
const REPLICAS: &str = "Multipath(lines: 8_000, transport: Replicas(count: 3))";

/// Pipeline with given stages that lights a furnace, in its own folder.
struct Case {
    folder: tempfile::TempDir,
    pipeline: Pipeline,
}

impl Case {
    fn new(stages: &str) -> Self {
        Self::with("points: Sobol", stages)
    }

    fn with(points: &str, stages: &str) -> Self {
        let text = format!(
            "(seed: 3, {points}, stages: [Load(path: \"furnace.gltf\"), Subdivide(patches: 200), {stages}, \
             Save([Table(path: \"patches.npy\"), Table(path: \"triangles.npy\", per: Triangle), Table(path: \"materials.csv\", per: Material), Image(path: \"view.exr\", width: 12, samples: 1)])])"
        );
        let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/furnace/furnace.gltf");
        let folder = tempfile::tempdir().unwrap();
        fs::copy(scene, folder.path().join("furnace.gltf")).unwrap();
        fs::write(folder.path().join("x.ron"), &text).unwrap();
        let pipeline = Pipeline::read(&folder.path().join("x.ron")).unwrap_or_else(|e| panic!("{e}"));
        Self { folder, pipeline }
    }

    fn options(&self, out: &str, threads: usize) -> RunOptions {
        RunOptions {
            out: Some(self.folder.path().join(out)),
            threads: NonZeroUsize::new(threads),
            ..RunOptions::default()
        }
    }

    /// Returns the files of a finished run, and its report.
    fn files(&self, out: &str) -> (BTreeMap<String, Vec<u8>>, Report) {
        let directory = self.folder.path().join(out);
        let report = sir_pipeline::run::read_report(&directory).unwrap();
        let files =
            report.outputs.iter().map(|o| (o.path.clone(), fs::read(directory.join(&o.path)).unwrap()));
        (files.collect(), timeless(report.clone()))
    }

    fn run(&self) -> (BTreeMap<String, Vec<u8>>, Report) {
        run(&self.pipeline, &self.options("alone", 2)).unwrap_or_else(|e| panic!("{}", e.chain()));
        self.files("alone")
    }
}

fn timeless(mut report: Report) -> Report {
    report.time = Time::of(0.0);
    for stage in &mut report.stages {
        stage.time = Time::of(0.0);
        stage.convergence.iter_mut().for_each(|point| point.time = Time::of(0.0));
        stage.stages.iter_mut().for_each(|part| part.time = Time::of(0.0));
        if let Some(pilot) = &mut stage.pilot {
            pilot.time = Time::of(0.0);
        }
    }
    report
}

fn repeated(report: &Report) -> &StageReport {
    report.stages.iter().find(|stage| stage.name == "Repeat").unwrap()
}

#[test]
fn once_is_as_often_as_without_a_repeat() {
    for transport in [BATCHES, REPLICAS] {
        let (files, plain) = Case::new(&format!("{SHOTS}, {transport}")).run();
        let (same, report) = Case::new(&format!("Repeat(times: 1, stages: [{SHOTS}, {transport}])")).run();
        assert!(files == same, "{transport}");
        let stage = repeated(&report);
        let last = plain.stages.iter().rfind(|stage| stage.lines.is_some()).unwrap();
        assert_eq!(stage.light, last.light);
        let parts: Vec<_> = plain.stages.iter().filter_map(|stage| stage.lines.as_ref()).collect();
        let same: Vec<_> = stage.stages.iter().filter_map(|stage| stage.lines.as_ref()).collect();
        assert_eq!(parts, same);
        assert_eq!(stage.repeats, Some(1));
    }
}

#[test]
fn any_number_of_workers_gets_the_same_bits() {
    for transport in [BATCHES, REPLICAS] {
        let case = Case::new(&format!("Repeat(times: 9, stages: [{SHOTS}, {transport}])"));
        let (files, report) = case.run();
        let errors = repeated(&report).light.as_ref().unwrap().errors;
        assert_eq!(errors, ErrorsReport { from: ErrorsFrom::Spread, samples: 9 });
        for (ranks, threads) in [(1, 3), (2, 1), (3, 2)] {
            let out = format!("{ranks}-{threads}");
            let options = case.options(&out, threads);
            let reports = ranks::run_ranks(ranks, |comm| {
                run_together(Ok(case.pipeline.clone()), &options, comm).unwrap().report
            });
            assert!(case.files(&out) == (files.clone(), report.clone()), "{ranks} ranks, {threads} threads");
            assert!(reports.into_iter().all(|other| timeless(other).stages == report.stages));
        }
    }
}

/// Pipelines without a `Repeat` share their lines among repeats. Sensors and intermediate results are means, too.
const SHARED: &str =
    "FirstShot(lines: 20_000), Save([Table(path: \"direct.npy\")]), Multipath(lines: 60_000),
    Sensors(name: \"s\", at: Points([(position: (0.5, 0.5, 0.5), direction: (0, 1, 0))]), rays: 2_000),
    Sensors(name: \"p\", at: Probes(spacing: 0.5), rays: 200)";

#[test]
fn lines_are_shared_among_repeats_if_they_suffice() {
    let (_, report) = Case::new(SHARED).run();
    let lit: Vec<&StageReport> = report.stages.iter().filter(|stage| stage.light.is_some()).collect();
    let [direct, all] = lit[..] else { panic!("direct light and all light") };
    for (stage, lines) in [(direct, 20_000), (all, 60_000)] {
        let repeats = stage.repeats.unwrap();
        assert!((MIN_REPEATS..=16).contains(&repeats), "{repeats}");
        let errors = stage.light.as_ref().unwrap().errors;
        assert_eq!(errors, ErrorsReport { from: ErrorsFrom::Spread, samples: repeats });
        assert_eq!(stage.lines.as_ref().unwrap().lines, lines);
    }
    let convergence = &all.convergence;
    assert_eq!(convergence.first().unwrap().repeats, MIN_REPEATS);
    let last = convergence.last().unwrap();
    assert_eq!((Some(last.repeats), last.lines), (all.repeats, 80_000));
    let stated = all.light.as_ref().unwrap().relative_error;
    let off = std::iter::zip(last.relative_error, stated).map(|(a, b)| (a / b - 1.0).abs());
    assert!(off.fold(0.0, f64::max) < 1e-3, "{last:?} {stated:?}");
    let sensors = report.stages.iter().find_map(|stage| stage.sensors.as_ref()).unwrap();
    // The radiosity is 2, 5 and 10 W/m² everywhere.
    let exact = 0.2126 * 2.0 + 0.7152 * 5.0 + 0.0722 * 10.0;
    assert!((sensors.mean - exact).abs() < 5.0 * sensors.mean_error, "{sensors:?}");
    assert!(sensors.mean_error < 0.01 * exact, "{sensors:?}");
    assert_eq!(report.warnings, [""; 0]);

    let (_, few) = Case::new("FirstShot(lines: 20_000), Multipath(lines: 20_000)").run();
    assert!(few.warnings[0].contains("too few to tell its error from the spread"), "{:?}", few.warnings);
    let last = few.stages.iter().rfind(|stage| stage.light.is_some()).unwrap();
    assert_eq!((last.repeats, last.light.as_ref().unwrap().errors.from), (None, ErrorsFrom::Lines));
}

#[test]
fn shared_lines_give_the_same_bits_for_any_number_of_workers() {
    for stages in [SHARED, SOLVE] {
        let case = Case::new(stages);
        let whole = case.run();
        for (ranks, threads) in [(1, 3), (2, 1), (3, 2)] {
            let out = format!("{ranks}-{threads}");
            let options = case.options(&out, threads);
            ranks::run_ranks(ranks, |comm| {
                run_together(Ok(case.pipeline.clone()), &options, comm).unwrap().report
            });
            assert!(case.files(&out) == whole, "{stages}: {ranks} ranks, {threads} threads");
        }
    }
}

const SOLVE: &str = "Solve(lines: 240_000)";

/// Returns the number of lines of a part of a `Solve`, or of its shadow rays as a pipeline states it.
fn lines(solve: &StageReport, part: &StageReport) -> u64 {
    match part.name.as_str() {
        "ShadowRays" => solve.pilot.unwrap().rays,
        _ => part.lines.as_ref().unwrap().lines,
    }
}

/// The lines of a `Solve` are all traced, after a pilot, and give the same as the stages that it reports.
#[test]
fn a_solve_is_a_division_of_its_lines() {
    let (files, report) = Case::new(SOLVE).run();
    let solve = report.stages.iter().find(|stage| stage.name == "Solve").unwrap();
    assert_eq!(solve.stages.iter().map(|stage| lines(solve, stage)).sum::<u64>(), 240_000);
    assert!((1..=30_000).contains(&solve.pilot.unwrap().lines), "{:?}", solve.pilot);
    assert_eq!(solve.light.as_ref().unwrap().errors.from, ErrorsFrom::Spread);
    let share = solve.pilot.unwrap().share;
    let lines = |stage| lines(solve, stage);
    let stages = solve.stages.iter().map(|stage| match stage.name.as_str() {
        "SecondShot" => format!("SecondShot(lines: {}, share: {share})", lines(stage)),
        "ShadowRays" => format!("ShadowRays(rays: {})", lines(stage)),
        name => format!("{name}(lines: {})", lines(stage)),
    });
    let (same, _) = Case::new(&stages.collect::<Vec<_>>().join(", ")).run();
    assert!(same == files, "{solve:?}");
}

/// The pilot of a `Solve` in a `Repeat` runs once.
#[test]
fn a_solve_can_be_repeated_until_its_error_is_small() {
    let stages = "Repeat(until: RelativeError(0.03), stages: [Solve(lines: 30_000)])";
    let (_, report) = Case::new(stages).run();
    let repeat = repeated(&report);
    let names: Vec<_> = repeat.stages.iter().map(|stage| stage.name.as_str()).collect();
    assert!(["FirstShot", "Multipath"].iter().all(|name| names.contains(name)), "{names:?}");
    // Of the shadow rays, the report has those of one repeat.
    let of = |stage: &StageReport| match stage.name.as_str() {
        "ShadowRays" => lines(repeat, stage) * repeat.repeats.unwrap(),
        _ => lines(repeat, stage),
    };
    assert_eq!(repeat.stages.iter().map(of).sum::<u64>(), 30_000 * repeat.repeats.unwrap());
    assert!(repeat.pilot.unwrap().lines < 5_000, "{:?}", repeat.pilot);
    assert!(repeat.light.as_ref().unwrap().relative_error.into_iter().fold(0.0, f64::max) <= 0.03);
}

/// The result of a target equals that of the same number of repeats. The target is met by the mean of all repeats, and
/// not by that of fewer.
#[test]
fn a_target_is_met_and_its_number_of_repeats_gives_the_same_bits() {
    let stages = format!("stages: [{SHOTS}, {BATCHES}]");
    let (files, report) = Case::new(&format!("Repeat(until: RelativeError(0.05), {stages})")).run();
    let worst = |report: &Report| {
        repeated(report).light.as_ref().unwrap().relative_error.into_iter().fold(0.0, f64::max)
    };
    let repeats = repeated(&report).repeats.unwrap();
    assert!(repeats > 2 && worst(&report) <= 0.05, "{repeats} {}", worst(&report));
    let times = |times: u64| Case::new(&format!("Repeat(times: {times}, {stages})")).run();
    let (same, again) = times(repeats);
    assert!(files == same);
    assert_eq!(repeated(&report), repeated(&again));
    assert!(worst(&times(repeats - 1).1) > 0.05);
}

#[test]
fn errors_of_few_repeats_are_those_that_they_state() {
    let text = |times: u64| format!("Repeat(times: {times}, stages: [FirstShot(lines: 5_000)])");
    let light = |times| repeated(&Case::with("points: Random", &text(times)).run().1).light.clone().unwrap();
    let [one, few, many] = [1, MIN_REPEATS - 1, MIN_REPEATS].map(light);
    assert_eq!(few.errors, ErrorsReport { from: ErrorsFrom::Lines, samples: 5_000 * (MIN_REPEATS - 1) });
    assert_eq!(many.errors, ErrorsReport { from: ErrorsFrom::Spread, samples: MIN_REPEATS });
    // Both fall with the square root of the number of repeats. The spread of eight repeats over 200 patches is known to
    // about 2 %.
    for k in 0..3 {
        let of =
            |light: &sir_pipeline::report::LightReport, n: u64| light.relative_error[k] * (n as f64).sqrt();
        let [one, few, many] = [of(&one, 1), of(&few, MIN_REPEATS - 1), of(&many, MIN_REPEATS)];
        assert!((few / one - 1.0).abs() < 0.03 && (many / one - 1.0).abs() < 0.1, "{one} {few} {many}");
    }
}

#[test]
fn there_are_no_more_repeats_than_allowed_or_than_there_is_time_for() {
    for (how, most) in [
        ("times: 9, at_most: 2", 2),
        ("until: RelativeError(1e-9), at_most: 3", 3),
        ("until: Seconds(1e9), at_most: 4", 4),
        ("until: Seconds(1e-9)", 1),
    ] {
        let (_, report) = Case::new(&format!("Repeat({how}, stages: [FirstShot(lines: 100)])")).run();
        assert_eq!(repeated(&report).repeats, Some(most), "{how}");
    }
}

/// The mean conserves energy: the emitted power, and the unshot power that one stage leaves to the next.
#[test]
fn the_mean_balance_closes() {
    let (_, report) = Case::new(&format!("Repeat(times: 5, stages: [{SHOTS}, {BATCHES}])")).run();
    let stages = &repeated(&report).stages;
    let lines: Vec<_> = stages.iter().map(|stage| stage.lines.as_ref().unwrap()).collect();
    let [first, second, global] = [0, 1, 2].map(|i: usize| &lines[i].balance);
    for k in 0..3 {
        for b in [first, second, global] {
            let sum = b.absorbed[k] + b.blocked[k] + b.escaped[k] + b.unshot[k];
            assert!((sum / b.emitted[k] - 1.0).abs() < 1e-12, "{b:?}");
        }
        assert!((first.emitted[k] / report.scene.power[k] - 1.0).abs() < 1e-9);
        let left = first.unshot[k] - second.emitted[k] + second.unshot[k];
        assert!((global.emitted[k] / left - 1.0).abs() < 1e-9);
    }
    assert_eq!(lines.iter().map(|l| l.lines).collect::<Vec<_>>(), [30_000, 10_000, 40_000]);
}

/// Single process that is asked to stop after a number of sums, as by Ctrl-C.
struct StopAfter {
    sums: AtomicU64,
    stop: Arc<AtomicBool>,
}

impl Communicator for StopAfter {
    fn rank(&self) -> usize {
        0
    }

    fn size(&self) -> usize {
        1
    }

    fn sum(&self, words: &mut [i64]) {
        SingleProcess.sum(words);
        if self.sums.fetch_sub(1, Relaxed) == 1 {
            self.stop.store(true, Relaxed);
        }
    }
}

/// Runs are stopped within stages and between repeats, and resumed with other numbers of threads.
#[test]
fn a_run_that_is_stopped_again_and_again_gives_the_same_bits() {
    let of = |transport: &str| format!("Repeat(times: 8, stages: [{SHOTS}, {transport}])");
    let shared = [SHARED, SOLVE].map(|stages| (stages.to_owned(), 300));
    for (stages, every) in [(of(BATCHES), 300), (of(REPLICAS), 0)].into_iter().chain(shared) {
        let case = Case::new(&stages);
        let whole = case.run();
        for sums in [23, 41] {
            let (out, mut stops) = (format!("stopped-{sums}"), 0);
            let directory = case.folder.path().join(&out);
            loop {
                let stop = Arc::new(AtomicBool::new(false));
                let comm = StopAfter { sums: AtomicU64::new(sums + stops as u64), stop: Arc::clone(&stop) };
                let checkpoint_every = Duration::from_secs(every);
                let options = RunOptions { stop, checkpoint_every, ..case.options(&out, 1 + stops % 3) };
                let outcome = if stops == 0 {
                    run_together(Ok(case.pipeline.clone()), &options, &comm)
                } else {
                    resume_together(&directory, &options, &comm)
                };
                match outcome {
                    Ok(_) => break,
                    Err(
                        Error::Interrupted { .. }
                        | Error::InterruptedSaving { .. }
                        | Error::InterruptedMeasuring { .. },
                    ) => stops += 1,
                    Err(error) => panic!("{}", error.chain()),
                }
                // Each attempt is a little longer, because a short one may not complete a slice.
                assert!(stops < 200, "{stages}: no end after {stops} stops");
            }
            println!("{stages}: {stops} stops");
            assert!(stops > 1, "{stages}: {stops} stops");
            assert!(case.files(&out) == whole, "{stages}, after {stops} stops");
        }
    }
}

#[test]
fn check_tells_what_repeats_cost() {
    for (how, expected) in [
        ("times: 1000", "Repeat: 1_000 times; each time"),
        ("times: 1000, at_most: 10", "Repeat: 10 times; each time"),
        ("until: Seconds(90)", "  90.0 s  Repeat: for 90.0 s; each time"),
        (
            "until: RelativeError(0.01), at_most: 7",
            "Repeat: until the relative error is 1 %, 7 times at most; each",
        ),
        ("until: RelativeError(0.01)", " or more, without outputs:"),
    ] {
        let case = Case::new(&format!("Repeat({how}, stages: [{SHOTS}, {BATCHES}])"));
        let text = estimate(&case.pipeline, &NoProgress).unwrap().to_string();
        assert!(text.contains(expected), "{text}");
        assert!(text.contains("SecondShot: 2_000 lines at "), "{text}");
    }
}
