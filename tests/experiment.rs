//! `sir experiment`: report, resumption, and invalid inputs.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

/// Writes a pipeline for the Cornell box with few patches.
fn write_box(folder: &Path, name: &str, stages: &str) {
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/cornell-box/cornell-box.gltf");
    let text = format!("(stages: [Load(path: {scene:?}), Subdivide(patches: 200), {stages}])");
    fs::write(folder.join(name), text).unwrap();
}

const STAGES: &str = r#"FirstShot(lines: 2e6), Multipath(lines: 3e6),
    Save([Image(path: "a.exr", width: 16), Image(path: "b.png", width: 32, samples: 1), Gltf(path: "x.glb")])"#;

fn sir(folder: &Path, line: &str) -> (Option<i32>, String, String) {
    let words = line.split_whitespace();
    let output = Command::new(env!("CARGO_BIN_EXE_sir")).args(words).current_dir(folder).output().unwrap();
    let Output { status, stdout, stderr } = output;
    (status.code(), String::from_utf8(stdout).unwrap(), String::from_utf8(stderr).unwrap())
}

const LINE: &str = "experiment box.ron --scale 0.002 --reference 3 --threads 1,2 --ranks 1 --out o";

#[test]
fn a_report_has_all_parts_and_nothing_is_run_twice() {
    let folder = tempfile::tempdir().unwrap();
    write_box(folder.path(), "box.ron", STAGES);
    let (code, stdout, stderr) = sir(folder.path(), LINE);
    assert_eq!(code, Some(0), "{stderr}");
    assert!(stdout.contains("report.md") && stdout.contains("report.json"), "{stdout}");
    // Threads, the run itself, the reference, ten mixtures twice, and replicas.
    assert!(
        stderr.contains("run 27 of 27: box/farm-64") || stderr.contains("run 27 of 27: box/mix-time-90"),
        "{stderr}"
    );

    let read = |name: &str| fs::read_to_string(folder.path().join("o").join(name)).unwrap();
    let report = read("report.md");
    let (_, after_summary) = report.split_once("## Summary").unwrap();
    let mut rest = after_summary;
    for section in [
        "| efficiency is about 90 % for any number of processors up to 8 (threads) | box |",
        "## box",
        "### Pictures\n\n![box](box.png)",
        "### Speed-up and efficiency",
        "(box-scaling.svg)",
        "### Error",
        "### Local and global lines",
        "(box-mix.svg)",
        "### Lines that miss the scene",
        "### Cost of a line",
        "### Replicas and batches",
        "| Batches |",
    ] {
        rest = rest.split_once(section).unwrap_or_else(|| panic!("no {section:?} in its place:\n{report}")).1;
    }
    assert!(report.contains("0.002 times those of the pipelines"));
    for file in
        ["box.png", "box-scaling.svg", "box-mix.svg", "runs/box/full/a.exr", "runs/box/reference/patches.npy"]
    {
        assert!(folder.path().join("o").join(file).is_file(), "{file}");
    }

    let numbers: serde_json::Value = serde_json::from_str(&read("report.json")).unwrap();
    let scene = &numbers["scenes"][0];
    assert_eq!((&scene["lines"]["local"], &scene["lines"]["global"]), (&4000.into(), &6000.into()));
    assert_eq!(scene["error"]["reference_lines"]["global"], 18_000);
    assert_eq!(scene["mix"]["equal_lines"].as_array().unwrap().len(), 10);
    assert_eq!(scene["mix"]["equal_lines"][0]["lines"]["local"], 125);
    assert_eq!(scene["farm"]["transports"].as_array().unwrap().len(), 4);
    let error = scene["error"]["relative_rms"]["luminance"].as_f64().unwrap();
    assert!(error > 0.0 && error < 1.0, "{error}");
    // 64 replicas of 94 lines each lose most of the light.
    assert!(scene["farm"]["transports"][2]["reflected_bias"]["luminance"].as_f64().unwrap() < -0.1);

    // Derived pipelines can be run separately.
    let (code, stdout, _) = sir(folder.path(), "run o/runs/box/farm-08/pipeline.ron --out again --json");
    let again: serde_json::Value = serde_json::from_str(&stdout).unwrap();
    assert_eq!((code, &again["stages"][3]["batches"]), (Some(0), &8.into()));

    // If the reference is missing, only the reference is computed again.
    fs::remove_file(folder.path().join("o/runs/box/reference/patches.npy")).unwrap();
    let (code, _, stderr) = sir(folder.path(), LINE);
    assert_eq!(code, Some(0), "{stderr}");
    let made: Vec<&str> = stderr.lines().filter(|line| line.starts_with("run ")).collect();
    assert_eq!(made.len(), 1, "{stderr}");
    assert!(made[0].contains("box/reference"), "{stderr}");
    let again: serde_json::Value = serde_json::from_str(&read("report.json")).unwrap();
    for part in ["scaling", "error", "mix", "domains"] {
        let strip = |numbers: &serde_json::Value| {
            let mut part = numbers["scenes"][0][part].clone();
            if let Some(object) = part.as_object_mut() {
                object.remove("reference_seconds");
            }
            part
        };
        assert_eq!(strip(&again), strip(&numbers), "{part}");
    }
}

#[test]
fn parts_may_be_chosen() {
    let folder = tempfile::tempdir().unwrap();
    write_box(folder.path(), "box.ron", STAGES);
    let line = "experiment box.ron --scale 0.002 --parts domains,spread";
    let (code, _, stderr) = sir(folder.path(), line);
    assert_eq!(code, Some(0), "{stderr}");
    let out = folder.path().join("results/experiment");
    assert!(!out.join("runs").exists());
    let report = fs::read_to_string(out.join("report.md")).unwrap();
    assert!(report.contains("### Cost of a line") && !report.contains("### Error"), "{report}");
}

#[test]
fn wrong_inputs_are_told_before_anything_runs() {
    let folder = tempfile::tempdir().unwrap();
    write_box(folder.path(), "box.ron", STAGES);
    write_box(folder.path(), "direct.ron", "FirstShot(lines: 10)");
    fs::create_dir(folder.path().join("box")).unwrap();
    write_box(folder.path(), "box/pipeline.ron", STAGES);
    for (line, part) in [
        ("experiment box.ron --scale 0", "above 0 and at most 1"),
        ("experiment box.ron --scale 2", "above 0 and at most 1"),
        ("experiment box.ron --parts speed", "possible values: scaling, error, mix"),
        ("experiment none.ron", "cannot read the pipeline none.ron"),
        ("experiment direct.ron", "direct.ron has no `Multipath` stage"),
        ("experiment", "there is no scenes/museum-stairs/pipeline.ron"),
        ("experiment box.ron box/pipeline.ron", "two of the pipelines are called box"),
    ] {
        let (code, stdout, stderr) = sir(folder.path(), line);
        assert_eq!((code, stdout.as_str()), (Some(2), ""), "{line}: {stderr}");
        assert!(stderr.contains(part), "{line}: {stderr}");
    }
    assert!(!folder.path().join("results").exists());
}
