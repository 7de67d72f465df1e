//! Malicious pipelines, and runs that cannot succeed: each is rejected early, with one clear error.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

use sir_parallel::SingleProcess;
use sir_pipeline::plan::Pipeline;
use sir_pipeline::run::{RunOptions, resume_together, run_pipeline as run};
use sir_pipeline::{Error, ErrorKind};

/// Time limit for reading a text: far more than needed, so that the test passes on a busy machine.
const TIME_LIMIT: Duration = Duration::from_secs(20);

/// Maximum size of the error of a text of any length \[bytes\].
const MAX_ERROR_BYTES: usize = 60_000;

/// Reads a text as a pipeline file, and returns the error message.
fn refused(text: &[u8]) -> String {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("room.ron");
    fs::write(folder.path().join("room.gltf"), "").unwrap();
    fs::write(&path, text).unwrap();
    let start = Instant::now();
    let error = Pipeline::read(&path).unwrap_err();
    assert!(start.elapsed() < TIME_LIMIT, "{:?}", start.elapsed());
    assert_eq!(error.kind(), ErrorKind::Usage);
    let message = error.chain();
    assert!(message.len() < MAX_ERROR_BYTES && message.contains("room.ron"), "{} bytes", message.len());
    assert!(!message.contains(|c: char| c.is_control() && c != '\n'), "{message:?}");
    message
}

#[test]
fn deep_nesting_is_refused_at_once() {
    for (open, close) in
        [("[", "]"), ("(", ")"), ("Some(", ")"), ("A(", ")"), ("(a: ", ")"), ("{1: ", "}"), ("[(", ")]")]
    {
        for depth in [20, 60, 120, 5_000] {
            let closed = format!("{}1{}", open.repeat(depth), close.repeat(depth));
            assert!(refused(closed.as_bytes()).contains("error"));
            refused(open.repeat(depth).as_bytes());
            refused(format!("Pipeline(stages: [Load(path: {closed})])").as_bytes());
        }
    }
    assert!(refused("/*".repeat(50_000).as_bytes()).contains("comment"));
}

#[test]
fn texts_that_are_too_long_are_not_read() {
    assert!(refused(&vec![b' '; (1 << 18) + 1]).contains("a pipeline is a short text"));
    // Endless files are rejected, too.
    if cfg!(target_os = "linux") {
        let error = Pipeline::read(Path::new("/dev/zero")).unwrap_err();
        assert!(matches!(error, Error::LongPipeline { .. }), "{error}");
    }
}

#[test]
fn many_mistakes_are_not_all_shown() {
    for mistake in [
        "Load(path: 1),",
        "Lod(),",
        "Save([Table(path: \"a.csv\")]),",
        "FirstShot(line: 1, line: 2),",
        "1,",
        "x,",
    ] {
        let many = (1 << 18) / mistake.len() - 20;
        let message = refused(format!("Pipeline(stages: [{}])", mistake.repeat(many)).as_bytes());
        assert!(message.contains("more problems are not shown"), "{mistake}");
    }
    let twice = "seed: 1,".repeat(30_000);
    assert!(refused(format!("Pipeline({twice})").as_bytes()).contains("not shown"));
    let outputs = "Table(path: \"a.csv\"),".repeat(10_000);
    assert!(refused(format!("Pipeline(stages: [Save([{outputs}])])").as_bytes()).contains("used twice"));
}

#[test]
fn names_and_numbers_without_bound() {
    let long = "x".repeat(200_000);
    for text in [
        format!("Pipeline(stages: [{long}()])"),
        format!("Pipeline({long}: 1)"),
        format!("Pipeline(stages: [Load(path: \"{long}\")])"),
        format!("Pipeline(stages: [Load(path: \"room.gltf\"), FirstShot(lines: {})])", "9".repeat(200_000)),
        format!("Pipeline(stages: [Load(path: \"room.gltf\"), FirstShot(lines: 1e{})])", "9".repeat(1000)),
        "Pipeline(stages: [Load(path: \"\u{1b}[2J\")])".into(),
        "Pipeline(stages: [Load(path: \"a\\u{0}b\")])".into(),
        "\u{feff}".into(),
        String::new(),
    ] {
        refused(text.as_bytes());
    }
    for text in [&b"(\xe9)"[..], b"\x89PNG\r\n\x1a\n"] {
        assert!(refused(text).contains("not a text file in UTF-8 or UTF-16"));
    }
}

/// Programs on Windows write pipelines and points in UTF-16, with or without a byte order mark.
#[test]
fn utf16_is_read_as_utf8_is() {
    let folder = tempfile::tempdir().unwrap();
    let stages = "FirstShot(lines: 2), Sensors(name: \"e\", at: File(\"\u{4e2d}.txt\"))";
    let points = "1 1 0.5 0 0 1 # \u{4e2d}\r\n0.5 1 0.5 0 0 1\n";
    for mark in ["", "\u{feff}"] {
        for order in [u16::to_le_bytes, u16::to_be_bytes] {
            let write = |name: &str, text: &str| {
                let bytes: Vec<u8> = format!("{mark}{text}").encode_utf16().flat_map(order).collect();
                fs::write(folder.path().join(name), bytes).unwrap();
            };
            write("\u{4e2d}.txt", points);
            let expected = room(folder.path(), stages);
            write("room.ron", &expected.text);
            let read = Pipeline::read(&folder.path().join("room.ron")).unwrap();
            assert_eq!(
                (read.text.trim_start_matches('\u{feff}'), &read.stages),
                (&*expected.text, &expected.stages)
            );
        }
    }
    fs::write(folder.path().join("room.ron"), b"\xff\xfe(\0)\0").unwrap();
    let error = Pipeline::read(&folder.path().join("room.ron")).unwrap_err().chain();
    assert!(error.contains("room.ron:1:"), "{error}");
}

#[test]
fn what_is_no_file_is_said_to_be_none() {
    let folder = tempfile::tempdir().unwrap();
    let error = Pipeline::read(folder.path()).unwrap_err();
    assert!(matches!(error, Error::ReadPipeline { .. }), "{error}");
}

/// Writes a room that is lit by its ceiling, and returns a pipeline with these stages.
fn room(folder: &Path, stages: &str) -> Pipeline {
    let room = "mtllib room.mtl\nv 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 0 0 2\nv 2 0 2\nv 2 2 2\nv 0 2 2\n\
        usemtl wall\nf 1 2 3 4\nf 6 5 8 7\nf 5 1 4 8\nf 2 6 7 3\nf 5 6 2 1\nusemtl lamp\nf 4 3 7 8\n";
    fs::write(folder.join("room.obj"), room).unwrap();
    fs::write(folder.join("room.mtl"), "newmtl wall\nKd 0.5\nnewmtl lamp\nKd 0.2\nKe 1\n").unwrap();
    let text = format!("Pipeline(stages: [Load(path: \"room.obj\"), {stages}])");
    Pipeline::parse(&text, &folder.join("room.ron")).unwrap()
}

/// Four billion patches are within the limits of numbers, but not within the memory of machines (of up to 600 GB).
#[test]
#[cfg(target_os = "linux")]
fn what_does_not_fit_into_memory_is_refused_before_anything_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let stages = "Subdivide(patches: 2_100_000_000), FirstShot(lines: 1e6), Save([Table(path: \"a.csv\")])";
    let pipeline = room(folder.path(), stages);
    let results = folder.path().join("results");
    let error =
        run(&pipeline, &RunOptions { results: results.clone(), ..RunOptions::default() }).unwrap_err();
    assert!(matches!(error, Error::Memory { .. }), "{}", error.chain());
    assert!(error.chain().contains("make fewer patches"), "{}", error.chain());
    assert!(!results.exists());
}

#[test]
fn a_file_that_cannot_be_written_leaves_a_run_that_can_go_on() {
    let folder = tempfile::tempdir().unwrap();
    let stages = "FirstShot(lines: 2_000), Save([Table(path: \"a.csv\")])";
    let pipeline = room(folder.path(), stages);
    fs::write(folder.path().join("room.ron"), &pipeline.text).unwrap();
    let out = folder.path().join("out");
    // A folder has the name of the file, so that even the superuser cannot write to it.
    fs::create_dir_all(out.join("a.csv/x")).unwrap();
    let options = RunOptions { out: Some(out.clone()), force: true, ..RunOptions::default() };
    let error = run(&pipeline, &options).unwrap_err();
    assert!(matches!(error, Error::NotWritten { .. }), "{}", error.chain());
    assert!(
        error.chain().contains("a.csv") && error.chain().contains("then resume the run"),
        "{}",
        error.chain()
    );
    assert!(!out.join("result.json").exists());
    let left: Vec<_> = fs::read_dir(&out).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(left.len(), 2, "no partial file is left: {left:?}");
    fs::remove_dir_all(out.join("a.csv")).unwrap();
    resume_together(&out, &options, &SingleProcess).unwrap();
    assert!(out.join("a.csv").is_file() && out.join("result.json").is_file());
}
