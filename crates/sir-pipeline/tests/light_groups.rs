//! Light groups: their sum is the light of all, factors dim it, and nothing depends on workers or interruptions.

#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout, reason = "a test fails by panicking")]

#[path = "../../sir-parallel/tests/parallel/ranks.rs"]
#[allow(dead_code, reason = "its tests use all of it")]
mod ranks;

use std::collections::BTreeMap;
use std::fs;
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering::Relaxed};
use std::time::Duration;

use sir_geom::Rgb;
use sir_parallel::{Communicator, SingleProcess};
use sir_pipeline::plan::Pipeline;
use sir_pipeline::report::{ErrorsFrom, Report, Time};
use sir_pipeline::run::{read_report, resume_together, run_together};
use sir_pipeline::{Error, MixOptions, RunOptions, mix};
use sir_radiosity::MIN_REPEATS;
use sir_view::Table;

/// A room without a ceiling, with a lamp that faces down; the walls are colored.
const ROOM: &str = "mtllib room.mtl
v 0 0 0
v 4 0 0
v 4 0 4
v 0 0 4
v 0 3 0
v 4 3 0
v 4 3 4
v 0 3 4
v 1 2.5 1
v 2 2.5 1
v 2 2.5 2
v 1 2.5 2
usemtl wall
f 1 4 3 2
f 1 2 6 5
f 2 3 7 6
f 3 4 8 7
f 4 1 5 8
usemtl lamp
f 9 10 11 12
";

const MATERIALS: &str = "newmtl wall\nKd 0.6 0.5 0.3\nnewmtl lamp\nKd 0 0 0\nKe 30 20 10\n";

const POINT: &str = "Point(position: (3, 1, 3), power: (40, 50, 60)GROUP)";
const SKY: &str = "Sky(horizontal: (3, 4, 6)GROUP)";
const SUN: &str = "Distant(direction: (1, -3, 1), irradiance: (5, 4, 3)GROUP)";

const SOLVE: &str = "Solve(lines: 300_000)";
const SHOTS: &str = "FirstShot(lines: 20_000), Save([Table(path: \"direct.npy\")]), SecondShot(lines: 5_000), Multipath(lines: 60_000)";

const SENSORS: &str = "Sensors(name: \"desk\", at: Plane(height: 0.75, spacing: 1), rays: 2_000),
    Sensors(name: \"probes\", at: Probes(spacing: 1.5), rays: 256)";

/// Returns a lamp, in a group if that has a name.
fn lamp(lamp: &str, group: &str) -> String {
    lamp.replace("GROUP", &if group.is_empty() { String::new() } else { format!(", group: \"{group}\"") })
}

/// Pipeline in its own folder.
struct Case {
    folder: tempfile::TempDir,
    pipeline: Pipeline,
}

impl Case {
    fn new(seed: u64, lamps: &[String], stages: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let text = format!(
            "(seed: {seed}, stages: [Load(path: \"room.obj\"), Light([{}]), Subdivide(patches: 150), {stages}, {SENSORS}, Save([
                Table(path: \"patches.npy\"), Table(path: \"triangles.npy\", per: Triangle),
                Table(path: \"materials.csv\", per: Material), Gltf(path: \"lit.glb\"),
                Image(path: \"view.exr\", width: 16, samples: 1), Image(path: \"view.png\", width: 16, samples: 1),
                Report(path: \"page.html\"), Lightmap(path: \"map.glb\", size: 64, direct: true)])])",
            lamps.join(", ")
        );
        for (name, text) in [("room.obj", ROOM), ("room.mtl", MATERIALS), ("x.ron", &text)] {
            fs::write(folder.path().join(name), text).unwrap();
        }
        let pipeline = Pipeline::read(&folder.path().join("x.ron")).unwrap_or_else(|e| panic!("{e}"));
        Self { folder, pipeline }
    }

    /// Four groups: the lamp of the scene, a point, the sky, and the sun, which is in no group.
    fn grouped(seed: u64, stages: &str) -> Self {
        let lamps = [
            "Group(name: \"ceiling\", materials: [\"lamp\"])".to_owned(),
            lamp(POINT, "desk"),
            lamp(SKY, "sky"),
            lamp(SUN, ""),
        ];
        Self::new(seed, &lamps, stages)
    }

    fn place(&self, out: &str) -> PathBuf {
        self.folder.path().join(out)
    }

    fn options(&self, out: &str, threads: usize) -> RunOptions {
        RunOptions {
            out: Some(self.place(out)),
            threads: NonZeroUsize::new(threads),
            ..RunOptions::default()
        }
    }

    fn run(&self) -> Outcome {
        run_together(Ok(self.pipeline.clone()), &self.options("run", 2), &SingleProcess)
            .unwrap_or_else(|e| panic!("{}", e.chain()));
        self.outcome("run")
    }

    /// Mixes the result of a run into a new directory.
    fn mix(&self, out: &str, factors: &[(&str, Rgb)]) -> Outcome {
        mix(&self.place("run"), &self.mix_options(out, factors)).unwrap_or_else(|e| panic!("{}", e.chain()));
        self.outcome(out)
    }

    fn mix_options(&self, out: &str, factors: &[(&str, Rgb)]) -> MixOptions {
        let factors = factors.iter().map(|(name, factor)| ((*name).to_owned(), *factor)).collect();
        MixOptions { factors, out: Some(self.place(out)), ..MixOptions::default() }
    }

    /// Returns the files in a directory, and its report.
    fn outcome(&self, out: &str) -> Outcome {
        let directory = self.place(out);
        let report = read_report(&directory).unwrap();
        // Pages state times.
        let outputs = report.outputs.iter().filter(|output| output.kind != "report");
        let files = outputs.map(|o| (o.path.clone(), fs::read(directory.join(&o.path)).unwrap())).collect();
        Outcome { directory, files, report: timeless(report) }
    }
}

/// What a run or a mix has written.
#[derive(PartialEq)]
struct Outcome {
    directory: PathBuf,
    files: BTreeMap<String, Vec<u8>>,
    report: Report,
}

impl Outcome {
    fn table(&self, name: &str) -> Table {
        Table::read(&self.directory.join(name)).unwrap()
    }

    /// Returns the columns `E_g`, `E`, `E_direct`, `se_g` and `se` of all sensors.
    fn desk(&self) -> Vec<[f64; 5]> {
        let text = String::from_utf8(self.files["desk.csv"].clone()).unwrap();
        let mut lines = text.lines();
        let names: Vec<&str> = lines.next().unwrap().split(',').collect();
        let column = |name| names.iter().position(|known| *known == name).unwrap();
        let columns = ["E_g", "E", "E_direct", "se_g", "se"].map(column);
        lines
            .map(|line| {
                let numbers: Vec<f64> = line.split(',').map(|number| number.parse().unwrap()).collect();
                columns.map(|column| numbers[column])
            })
            .collect()
    }
}

/// Removes the times of a report.
fn timeless(mut report: Report) -> Report {
    fn stages(all: &mut [sir_pipeline::report::StageReport]) {
        for stage in all {
            stage.time = Time::of(0.0);
            stage.convergence.iter_mut().for_each(|point| point.time = Time::of(0.0));
            stage.pilot.iter_mut().for_each(|pilot| pilot.time = Time::of(0.0));
            stages(&mut stage.stages);
        }
    }
    report.time = Time::of(0.0);
    stages(&mut report.stages);
    report.groups.iter_mut().for_each(|group| stages(&mut group.stages));
    report
}

fn gray(factor: f64) -> Rgb {
    Rgb::splat(factor)
}

/// Asserts that numbers with standard errors from 8 to 16 repeats agree. The mean square of z is then 1.15 to 1.4 at most,
/// from the tails of Student's t distribution, (n − 1)/(n − 3). Seeds are fixed; of other ones, about one in a thousand
/// would fail.
fn assert_same_light(a: &[[f64; 2]], b: &[[f64; 2]], what: &str) {
    let z: Vec<f64> = a
        .iter()
        .zip(b)
        .filter(|([_, sa], [_, sb])| sa + sb > 0.0)
        .map(|([x, sa], [y, sb])| (x - y) / sa.hypot(*sb))
        .collect();
    let square = z.iter().map(|z| z * z).sum::<f64>() / z.len() as f64;
    let worst = z.iter().fold(0.0, |most: f64, z| most.max(z.abs()));
    println!("{what}: {} numbers, mean z² {square:.3}, worst {worst:.2}", z.len());
    assert!(a.len() == b.len() && z.len() > 10 && square < 1.6 && worst < 5.5, "{what}: {square} {worst}");
}

fn irradiances(table: &Table) -> Vec<[f64; 2]> {
    let bands = |row: &sir_view::Row| {
        let (e, s) = (row.irradiance.to_array(), row.irradiance_error.to_array());
        [0, 1, 2].map(|k| [e[k], s[k]])
    };
    table.rows.iter().flat_map(bands).collect()
}

#[test]
fn the_sum_of_groups_is_the_light_of_all() {
    let lamps = [lamp(POINT, ""), lamp(SKY, ""), lamp(SUN, "")];
    let cases = [Case::grouped(1, SOLVE), Case::new(2, &lamps, SOLVE)];
    let [grouped, whole] = cases.each_ref().map(Case::run);
    for table in ["patches.npy", "triangles.npy"] {
        let [a, b] = [&grouped, &whole].map(|run| irradiances(&run.table(table)));
        assert_same_light(&a, &b, table);
    }
    let of = |run: &Outcome| run.desk().iter().map(|d| [d[1], d[4]]).collect::<Vec<_>>();
    assert_same_light(&of(&grouped), &of(&whole), "sensors");
    let [a, b] = [&grouped, &whole].map(|run| run.table("materials.csv"));
    for (a, b) in a.rows.iter().zip(&b.rows) {
        let z = (a.radiosity - b.radiosity)
            / (a.error * a.error + b.error * b.error).map(f64::sqrt).max(gray(1e-12));
        assert!(z.abs().max_element() < 4.0, "{z}");
    }
    let names: Vec<_> = grouped.report.groups.iter().map(|group| group.name.as_str()).collect();
    assert_eq!(names, ["ceiling", "desk", "sky", "other"]);
    let power: Rgb = grouped.report.groups.iter().map(|group| Rgb::from_array(group.power)).sum();
    assert!(power.abs_diff_eq(Rgb::from_array(whole.report.scene.power), 1e-9));
    assert!(whole.report.groups.is_empty() && !whole.directory.join("group-1.light").exists());
    // What the stages report is the sum of what those of the groups report.
    let solve = grouped.report.stages.iter().find(|stage| stage.name == "Solve").unwrap();
    let errors = solve.light.as_ref().unwrap().errors;
    assert_eq!(errors.from, ErrorsFrom::Spread);
    assert!(
        errors.samples >= MIN_REPEATS
            && solve.light.as_ref().unwrap().relative_error.iter().all(|error| (0.001..0.1).contains(error))
    );
}

#[test]
fn a_mix_with_all_factors_one_has_the_same_bits() {
    let case = Case::grouped(3, SHOTS);
    let run = case.run();
    let same = case.mix("mix", &[("desk", gray(1.0))]);
    assert!(run.files.len() > 12 && same.files == run.files);
    assert!(same.report.mixed_from.is_some());
    let (a, b) = (&same.report, &run.report);
    assert_eq!((&a.stages, &a.groups, &a.outputs, &a.scene), (&b.stages, &b.groups, &b.outputs, &b.scene));
    // Again, with another number of threads, and the default directory.
    let options = MixOptions { threads: NonZeroUsize::new(1), ..MixOptions::default() };
    let first = mix(&run.directory, &options).unwrap();
    assert!(first.directory.ends_with("run-mix"));
    assert!(case.outcome("run-mix").files == run.files);
    assert!(mix(&run.directory, &options).unwrap().directory.ends_with("run-mix-2"));
    assert!(case.place("mix/page.html").exists());
}

/// A group has random numbers of its own, and those of the run if it is that of all other lights.
#[test]
fn a_group_with_the_factor_zero_might_as_well_not_be_there() {
    let case = Case::new(4, &[lamp(POINT, "desk"), lamp(SUN, "sun"), lamp(SKY, "")], SHOTS);
    case.run();
    let without = Case::new(4, &[lamp(SUN, "sun"), lamp(SKY, "")], SHOTS).run();
    let dark = case.mix("a", &[("desk", gray(0.0))]);
    // The up direction of the scene would be that without the lamp, too.
    assert!(dark.files == without.files);
    let only_sky = Case::new(4, &[lamp(SKY, "")], SHOTS).run();
    assert!(case.mix("b", &[("desk", gray(0.0)), ("sun", gray(0.0))]).files == only_sky.files);
    let nothing = case.mix("c", &[("desk", gray(0.0)), ("sun", gray(0.0)), ("other", gray(0.0))]);
    assert!(
        nothing
            .table("patches.npy")
            .rows
            .iter()
            .all(|row| row.radiosity == Rgb::ZERO && row.error == Rgb::ZERO)
    );
}

#[test]
fn light_is_linear_in_the_factors_and_variances_in_their_squares() {
    let case = Case::grouped(5, SOLVE);
    case.run();
    let names = ["ceiling", "desk", "sky", "other"];
    let factors = [Rgb::new(2.0, 0.5, 0.0), gray(0.25), Rgb::new(1.0, 0.9, 0.8), gray(0.0)];
    let only = |k: usize| {
        let dark: Vec<_> =
            names.iter().filter(|name| **name != names[k]).map(|name| (*name, gray(0.0))).collect();
        case.mix(&format!("only-{k}"), &dark)
    };
    let alone = [0, 1, 2, 3].map(only);
    let all: Vec<_> = names.into_iter().zip(factors).collect();
    let mixed = case.mix("mixed", &all);
    for table in ["patches.npy", "triangles.npy", "materials.csv"] {
        let parts = alone.each_ref().map(|one| one.table(table));
        for (i, row) in mixed.table(table).rows.iter().enumerate() {
            let sum = |of: &dyn Fn(&sir_view::Row, Rgb) -> Rgb| {
                parts.iter().zip(factors).map(|(part, factor)| of(&part.rows[i], factor)).sum::<Rgb>()
            };
            let close = |a: Rgb, b: Rgb| a.abs_diff_eq(b, 1e-9 * b.abs().max_element().max(1e-3));
            assert!(close(row.irradiance, sum(&|row, factor| factor * row.irradiance)), "{table} {i}");
            assert!(close(row.radiosity, sum(&|row, factor| factor * row.radiosity)), "{table} {i}");
            let square = sum(&|row, factor| (factor * row.irradiance_error).powf(2.0));
            assert!(close(row.irradiance_error, square.map(f64::sqrt)), "{table} {i}");
        }
    }
    let parts = alone.each_ref().map(Outcome::desk);
    for (i, sensor) in mixed.desk().into_iter().enumerate() {
        let green: f64 = parts.iter().zip(factors).map(|(part, factor)| factor.y * part[i][0]).sum();
        let square: f64 =
            parts.iter().zip(factors).map(|(part, factor)| (factor.y * part[i][3]).powi(2)).sum();
        assert!((sensor[0] / green - 1.0).abs() < 1e-9 && (sensor[3] / square.sqrt() - 1.0).abs() < 1e-9);
        assert!(sensor[2] <= sensor[1] && sensor[4] > 0.0);
    }
    // The lamp itself is dimmed, too.
    let lit = mixed.table("materials.csv");
    let lamp = lit.rows.iter().zip(&lit.names).find(|(_, name)| *name == "lamp").unwrap().0;
    let share = lamp.radiosity / Rgb::new(30.0, 20.0, 10.0);
    assert!(share.y > 0.0 && (share.x / share.y - 4.0).abs() < 1e-9 && share.z == 0.0, "{share}");
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

#[test]
fn any_number_of_workers_gets_the_same_bits_after_any_interruption() {
    for stages in [
        SHOTS,
        "Solve(lines: 60_000)",
        "Repeat(until: RelativeError(0.2), at_most: 12, stages: [Solve(lines: 4_000)])",
    ] {
        let case = Case::grouped(6, stages);
        let whole = case.run();
        let same = |out: &str| {
            let other = case.outcome(out);
            assert!(other.files == whole.files && other.report == whole.report, "{stages}: {out}");
            for group in 1..=4 {
                let file = format!("group-{group}.light");
                assert!(
                    fs::read(case.place(out).join(&file)).unwrap()
                        == fs::read(case.place("run").join(&file)).unwrap()
                );
            }
        };
        for (ranks, threads) in [(1, 1), (3, 2)] {
            let out = format!("{ranks}-{threads}");
            let options = case.options(&out, threads);
            let reports = ranks::run_ranks(ranks, |comm| {
                run_together(Ok(case.pipeline.clone()), &options, comm).unwrap().report
            });
            same(&out);
            assert!(reports.into_iter().all(|report| timeless(report) == whole.report));
        }
        let (mut stops, mut begun) = (0, Vec::new());
        loop {
            let stop = Arc::new(AtomicBool::new(false));
            let comm = StopAfter { sums: AtomicU64::new(60 + 6 * stops as u64), stop: Arc::clone(&stop) };
            let checkpoint_every = Duration::from_secs(300);
            let options = RunOptions { stop, checkpoint_every, ..case.options("stopped", 1 + stops % 3) };
            let outcome = match stops {
                0 => run_together(Ok(case.pipeline.clone()), &options, &comm),
                _ => resume_together(&case.place("stopped"), &options, &comm),
            };
            match outcome {
                Err(error) if error.kind() == sir_pipeline::ErrorKind::Interrupted => stops += 1,
                outcome => {
                    outcome.unwrap_or_else(|error| panic!("{stages}: {}", error.chain()));
                    break;
                }
            }
            begun.push(
                (1..=4).filter(|n| case.place("stopped").join(format!("group-{n}.light")).exists()).count(),
            );
            assert!(stops < 300, "{stages}: no end after {stops} stops");
        }
        println!("{stages}: {stops} stops, finished groups at each {begun:?}");
        assert!(begun.iter().any(|finished| (1..4).contains(finished)), "{stages}: {begun:?}");
        same("stopped");
    }
}

#[test]
fn what_cannot_be_mixed_is_refused() {
    let case = Case::new(7, &[lamp(POINT, "desk"), lamp(SKY, "")], "FirstShot(lines: 2_000)");
    let run = case.run();
    let refused = |factors: &[(&str, Rgb)], out: &str| {
        mix(&run.directory, &case.mix_options(out, factors)).unwrap_err().chain()
    };
    insta::assert_snapshot!(refused(&[("dusk", gray(0.5))], "a"), @"light group `dusk`: did you mean `desk`?");
    insta::assert_snapshot!(refused(&[("sun", gray(0.5))], "a"), @"light group `sun`: the light groups of the run are `desk` and `other`");
    insta::assert_snapshot!(refused(&[("desk", gray(-0.5))], "a"), @"light group `desk`: its factor must be from 0 to 1,000,000");
    insta::assert_snapshot!(refused(&[("desk", gray(1e21))], "a"), @"light group `desk`: its factor must be from 0 to 1,000,000");
    insta::assert_snapshot!(refused(&[("desk", gray(f64::NAN))], "a"), @"light group `desk`: its factor must be from 0 to 1,000,000");
    insta::assert_snapshot!(refused(&[("desk", gray(0.5)), ("desk", gray(1.0))], "a"), @"light group `desk`: it has a factor already; give one factor for each group");
    assert!(!case.place("a").exists());
    assert!(matches!(mix(&run.directory, &case.mix_options("run", &[])), Err(Error::MixOfItself { .. })));
    case.mix("b", &[]);
    assert!(matches!(mix(&run.directory, &case.mix_options("b", &[])), Err(Error::Exists { .. })));
    assert!(matches!(mix(&case.place("b"), &case.mix_options("c", &[])), Err(Error::MixOfMix { .. })));
    assert!(matches!(mix(&case.place("d"), &case.mix_options("c", &[])), Err(Error::NoResult { .. })));
    let ungrouped = Case::new(7, &[lamp(SKY, "")], "FirstShot(lines: 2_000)");
    let directory = ungrouped.run().directory;
    assert!(matches!(mix(&directory, &ungrouped.mix_options("c", &[])), Err(Error::NoLightGroups { .. })));
    // The scene has changed since, or a file is damaged.
    let scene = case.place("room.obj");
    fs::write(&scene, ROOM.replace("v 4 3 4", "v 4 3 5")).unwrap();
    assert!(matches!(mix(&run.directory, &case.mix_options("c", &[])), Err(Error::GroupFile { .. })));
    fs::write(&scene, ROOM).unwrap();
    assert!(!case.place("c").exists());
    // The file is that of another group.
    fs::copy(run.directory.join("group-1.light"), run.directory.join("group-2.light")).unwrap();
    assert!(matches!(mix(&run.directory, &case.mix_options("f", &[])), Err(Error::GroupFile { .. })));
    fs::write(run.directory.join("group-2.light"), "").unwrap();
    assert!(matches!(mix(&run.directory, &case.mix_options("e", &[])), Err(Error::GroupFile { .. })));
}
