//! Whole pipelines, from the pipeline file to the output files: reproducible bytes, conserved power, exact answers, and
//! snapshots that show which numbers a change affects.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "test helpers fail and print like tests"
)]

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use sir::geom::Rgb;
use sir::pipeline::plan::Pipeline;
use sir::pipeline::report::{LinesReport, Report, Time};
use sir::pipeline::run::{RunOptions, run_pipeline as run};
use sir::view::{Row, Table};

/// Closed room whose ceiling is a lamp, with a sheet above the floor that is lit from both sides. One wall reflects
/// nothing.
const ROOM: &str = "mtllib room.mtl
v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 0 0 2\nv 2 0 2\nv 2 2 2\nv 0 2 2
v 0.5 0.5 0.5\nv 1.5 0.5 0.5\nv 1.5 0.6 1.5\nv 0.5 0.6 1.5
usemtl wall\nf 1 2 3 4\nf 6 5 8 7\nf 5 6 2 1
usemtl black\nf 5 1 4 8
usemtl red\nf 2 6 7 3
usemtl lamp\nf 4 3 7 8
usemtl sheet\nf 9 12 11 10\n";
const ROOM_MATERIALS: &str =
    "newmtl wall\nKd 0.5 0.5 0.75\nnewmtl black\nKd 0 0 0\nnewmtl red\nKd 0.75 0.125 0.125
newmtl lamp\nKd 0.25 0.25 0.25\nKe 1 0.5 0.25\nnewmtl sheet\nKd 0.5 0.5 0.5\n";
const ROOM_PIPELINE: &str = r#"Pipeline(
    seed: 5,
    stages: [
        Load(path: "room.obj"),
        Subdivide(patches: 200),
        FirstShot(lines: 50_000),
        Save([Table(path: "direct.npy")]),
        Multipath(lines: 50_000),
        Save([
            Image(path: "view.png", width: 32, height: 24, samples: 2),
            Image(path: "view.exr", width: 32, height: 24, samples: 2),
            Gltf(path: "result.glb"),
            Table(path: "patches.csv"),
        ]),
    ],
)"#;

/// Open box whose floor emits: light escapes, and lines cross an odd number of surfaces.
const OPEN_BOX: &str = "mtllib open.mtl
v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1
usemtl glow\nf 1 5 6 2
usemtl wall\nf 1 2 3 4\nf 6 5 8 7\nf 5 1 4 8\nf 2 6 7 3\n";
const OPEN_BOX_MATERIALS: &str = "newmtl glow\nKd 0.5 0.5 0.5\nKe 1 2 4\nnewmtl wall\nKd 0.875 0.75 0.5\n";
const OPEN_BOX_PIPELINE: &str = r#"Pipeline(
    stages: [
        Load(path: "open.obj", sides: Front),
        Subdivide(patches: 40, of: Triangles),
        FirstShot(lines: 20_000),
        Multipath(lines: 20_000, transport: Replicas(tail: 4_000)),
        Save([Table(path: "patches.csv")]),
    ],
)"#;

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in [
        ("room.obj", ROOM),
        ("room.mtl", ROOM_MATERIALS),
        ("open.obj", OPEN_BOX),
        ("open.mtl", OPEN_BOX_MATERIALS),
    ] {
        fs::write(folder.path().join(name), text).unwrap();
    }
    folder
}

/// Returns the folder of one of the repository's own scenes.
fn scene_folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(name)
}

/// Finished run with its output files, except the report.
struct Outcome {
    report: Report,
    files: BTreeMap<String, Vec<u8>>,
    table: Table,
}

/// Runs a pipeline as if its file were in the folder `scene`, with a new temporary output folder.
fn outcome(scene: &Path, text: &str, seed: Option<u64>) -> Outcome {
    let pipeline = Pipeline::parse(text, &scene.join("test.ron")).unwrap_or_else(|e| panic!("{e}"));
    let results = tempfile::tempdir().unwrap();
    let out = results.path().join("run");
    let options = RunOptions { out: Some(out.clone()), seed, ..RunOptions::default() };
    let report = run(&pipeline, &options).unwrap_or_else(|e| panic!("{}", e.chain())).report;
    let read =
        |o: &sir::pipeline::report::OutputReport| (o.path.clone(), fs::read(out.join(&o.path)).unwrap());
    let files = report.outputs.iter().map(read).collect();
    let entries = fs::read_dir(&out).unwrap().count();
    assert_eq!(entries, report.outputs.len() + 1, "a run directory holds the outputs and the report");
    let table = Table::read(&out.join("patches.csv")).unwrap();
    Outcome { report, files, table }
}

/// Returns the report without its times.
fn timeless(mut report: Report) -> String {
    report.time = Time::of(0.0);
    for stage in &mut report.stages {
        stage.time = Time::of(0.0);
        stage.convergence.iter_mut().for_each(|point| point.time = Time::of(0.0));
    }
    report.to_json()
}

fn lines_stages(report: &Report) -> impl Iterator<Item = (&str, &LinesReport)> {
    report.stages.iter().filter_map(|s| Some((s.name.as_str(), s.lines.as_ref()?)))
}

/// Fails unless every stage conserves power, and multipath emits what the first shot left unshot, up to the noise of
/// the forecast.
fn assert_balanced(report: &Report) {
    for (name, lines) in lines_stages(report) {
        let b = &lines.balance;
        for k in 0..3 {
            let sum = b.absorbed[k] + b.blocked[k] + b.escaped[k] + b.unshot[k];
            assert!((sum / b.emitted[k] - 1.0).abs() < 1e-12, "{name}: {b:?}");
        }
    }
    let stages: Vec<_> = lines_stages(report).map(|(_, lines)| lines).collect();
    let [first, second] = [0, 1].map(|stage: usize| &stages[stage].balance);
    for k in 0..3 {
        assert!((first.emitted[k] / report.scene.power[k] - 1.0).abs() < 1e-9);
        let (ratio, left) = (second.emitted[k] / first.unshot[k], second.unshot[k] / second.emitted[k]);
        if stages[1].walks > 0 {
            assert!((ratio - 1.0).abs() < 1e-12, "batches sent {ratio} of the unshot power");
            // What is left after random walks is zero on average.
            let walked = stages[1].walked[k] / second.emitted[k];
            assert!(walked < 0.5 && left.abs() < 0.02, "{walked} by walks, {left} unshot");
        } else {
            assert!((ratio - 1.0).abs() < 0.05, "multipath sent {ratio} of the unshot power");
            assert!(left < 1e-3, "{left} is unshot after the tail");
        }
    }
}

#[test]
fn the_same_pipeline_gives_the_same_bytes_and_another_seed_others() {
    let folder = folder();
    let [a, b] = [None, Some(5)].map(|seed| outcome(folder.path(), ROOM_PIPELINE, seed));
    let names: Vec<&str> = a.files.keys().map(String::as_str).collect();
    assert_eq!(names, ["direct.npy", "patches.csv", "result.glb", "view.exr", "view.png"]);
    for (name, bytes) in &a.files {
        assert!(*bytes == b.files[name], "{name} differs between two runs");
    }
    assert_eq!(timeless(a.report), timeless(b.report));
    let other = outcome(folder.path(), ROOM_PIPELINE, Some(6));
    for (name, bytes) in &other.files {
        assert!(*bytes != a.files[name], "{name} does not depend on the seed");
    }
}

#[test]
fn a_room_stays_as_it_was() {
    let folder = folder();
    let Outcome { report, table, .. } = outcome(folder.path(), ROOM_PIPELINE, None);
    assert_balanced(&report);
    insta::assert_snapshot!("room_radiosities", triangles(&table));
    insta::assert_snapshot!("room_stages", stages(&report));
}

#[test]
fn an_open_box_stays_as_it_was() {
    let folder = folder();
    let Outcome { report, table, .. } = outcome(folder.path(), OPEN_BOX_PIPELINE, None);
    assert_balanced(&report);
    insta::assert_snapshot!("open_box_radiosities", triangles(&table));
    insta::assert_snapshot!("open_box_stages", stages(&report));
}

/// Returns the mean of independent results, and its standard error per band.
fn mean_and_error(samples: &[Rgb]) -> (Rgb, Rgb) {
    let n = samples.len() as f64;
    let mean = samples.iter().sum::<Rgb>() / n;
    let variance = samples.iter().map(|&x| (x - mean) * (x - mean)).sum::<Rgb>() / (n * (n - 1.0));
    (mean, variance.map(f64::sqrt))
}

#[track_caller]
fn assert_within_four_sigma(samples: &[Rgb], exact: Rgb, what: &str) {
    let (mean, sigma) = mean_and_error(samples);
    let z = (mean - exact) / sigma;
    println!("{what}: {mean:.4} ± {sigma:.4}, exact {exact:.4}, z {z:+.2}");
    assert!(z.abs().max_element() <= 4.0, "{what}: {mean} ± {sigma}, exact {exact}");
    assert!((sigma / exact).max_element() < 2e-3, "{what}: {sigma} is too coarse to tell anything");
}

#[test]
fn a_furnace_has_the_radiosity_of_the_geometric_series() {
    const TEXT: &str = r#"(stages: [
        Load(path: "furnace.gltf"), Subdivide(patches: 600), FirstShot(lines: 50_000), Multipath(lines: 200_000),
        Save([Table(path: "patches.csv")]),
    ])"#;
    // M / (1 − ρ) with M = 1 and ρ = 0.5, 0.8 and 0.9.
    let exact = Rgb::new(2.0, 5.0, 10.0);
    let mut means = Vec::new();
    let (mut far, mut values) = (0, 0);
    for seed in 1..=8 {
        let Outcome { report, table, .. } = outcome(&scene_folder("furnace"), TEXT, Some(seed));
        assert_balanced(&report);
        assert!(lines_stages(&report).all(|(_, lines)| lines.odd_lines == 0));
        means.push(table.rows.iter().map(|r| r.radiosity * r.area).sum::<Rgb>() / report.scene.area);
        for row in &table.rows {
            let z = (row.radiosity - exact) / row.error;
            far += z.to_array().iter().filter(|z| z.abs() > 5.0).count();
            values += 3;
        }
    }
    assert_within_four_sigma(&means, exact, "furnace");
    // Student's t with 15 degrees of freedom exceeds 5 with a probability of 1/6,300.
    println!("{far} of {values} values deviate by more than 5σ");
    assert!(far * 1000 <= values, "{far} of {values} values deviate by more than 5σ");
}

#[test]
fn concentric_spheres_have_their_exact_radiosities() {
    const TEXT: &str = r#"(stages: [
        Load(path: "concentric-spheres.glb"), FirstShot(lines: 50_000), Multipath(lines: 400_000, transport: Replicas(tail: 120_000)),
        Save([Table(path: "patches.csv")]),
    ])"#;
    // B₁ = 100 + 0.5 B₂ and B₂ = 0.8 (B₁/4 + 3 B₂/4): see scenes/README.md.
    let exact = [400.0 / 3.0, 200.0 / 3.0];
    let mut means = [Vec::new(), Vec::new()];
    for seed in 1..=8 {
        let Outcome { report, table, .. } = outcome(&scene_folder("concentric-spheres"), TEXT, Some(seed));
        assert_balanced(&report);
        for (k, mean) in means.iter_mut().enumerate() {
            let rows = || table.rows.iter().filter(|r| (r.center.length() > 1.5) == (k == 1));
            assert_eq!(rows().count(), 5120);
            let area: f64 = rows().map(|r| r.area).sum();
            mean.push(rows().map(|r| r.radiosity * r.area).sum::<Rgb>() / area);
        }
    }
    for (k, what) in ["inner sphere", "outer sphere"].into_iter().enumerate() {
        assert_within_four_sigma(&means[k], Rgb::splat(exact[k]), what);
    }
}

/// Formats the mean radiosity of each side of every triangle, and the root mean square of the standard errors of its
/// patches.
fn triangles(table: &Table) -> String {
    let mut text = String::from("triangle side      B_r     B_g     B_b      se_r    se_g    se_b\n");
    let mut sides: BTreeMap<(u32, bool), Vec<&Row>> = BTreeMap::new();
    for (i, row) in table.rows.iter().enumerate() {
        // The front of a patch comes first.
        let back = i > 0 && table.rows[i - 1].number == row.number;
        sides.entry((row.triangle, back)).or_default().push(row);
    }
    for ((triangle, back), rows) in sides {
        let n = rows.len() as f64;
        let b = rows.iter().map(|r| r.radiosity).sum::<Rgb>() / n;
        let se = (rows.iter().map(|r| r.error * r.error).sum::<Rgb>() / n).map(f64::sqrt);
        let side = if back { "back " } else { "front" };
        writeln!(
            text,
            "{triangle:8} {side}  {:7.4} {:7.4} {:7.4}   {:7.4} {:7.4} {:7.4}",
            b.x, b.y, b.z, se.x, se.y, se.z
        )
        .unwrap();
    }
    text
}

/// Formats the parts of a report about its scene and the stages with lines.
fn stages(report: &Report) -> String {
    let scene = &report.scene;
    let mut text = format!(
        "{} triangles, {} patches, {} sides, {:.6} m², {:.6?} W\n",
        scene.triangles, scene.patches, scene.sides, scene.area, scene.power
    );
    for (name, l) in lines_stages(report) {
        let b = &l.balance;
        let through =
            l.domain.as_ref().map_or(String::new(), |d| format!(" ({}, {:.6} m²)", d.kind, d.surface));
        writeln!(
            text,
            "{name}: {} lines{through}, {} crossings, {} odd, empty {:.6}",
            l.lines, l.crossings, l.odd_lines, l.empty_share
        )
        .unwrap();
        for (what, watts) in [
            ("emitted", b.emitted),
            ("absorbed", b.absorbed),
            ("blocked", b.blocked),
            ("escaped", b.escaped),
            ("unshot", b.unshot),
        ] {
            writeln!(text, "    {what:8} {watts:.9?} W").unwrap();
        }
        // Light that is neither shown nor measured is not summed up.
        if let Some(light) = report.stages.iter().find(|s| s.name == name).and_then(|s| s.light.as_ref()) {
            writeln!(text, "    relative error {:.6?}", light.relative_error).unwrap();
            writeln!(text, "    tally {}", light.tally_hash).unwrap();
        }
    }
    text
}
