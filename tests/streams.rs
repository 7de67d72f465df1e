//! The program `sir` when nobody reads its standard output or standard error, or when their disk is full.

#![cfg(unix)]
#![allow(clippy::unwrap_used, reason = "test helpers fail like tests")]

use std::fs;
use std::io::{Read as _, pipe};
use std::path::Path;
use std::process::{Command, Output, Stdio};

/// Scene with warnings: a reflectance that is too large, and a file that does not exist.
const ROOM: &str = "mtllib room.mtl\nmtllib missing.mtl
v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 0 0 2\nv 2 0 2\nv 2 2 2\nv 0 2 2
usemtl wall\nf 1 2 3 4\nf 6 5 8 7\nf 5 1 4 8\nf 2 6 7 3\nf 5 6 2 1
usemtl lamp\nf 4 3 7 8\n";
const MATERIALS: &str = "newmtl wall\nKd 0.5 0.5 1\nnewmtl lamp\nKd 0.2 0.2 0.2\nKe 1 1 1\n";
const PIPELINE: &str = r#"(stages: [Load(path: "room.obj"), FirstShot(lines: 2_000), Multipath(lines: 2_000),
    Save([Table(path: "patches.csv")])])"#;
const WRONG: &str = r#"(stages: [Load(path: "room.obj"), FirstShot(lines: 0)])"#;

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let files = [("room.obj", ROOM), ("room.mtl", MATERIALS), ("room.ron", PIPELINE), ("wrong.ron", WRONG)];
    files.iter().for_each(|(name, text)| fs::write(folder.path().join(name), text).unwrap());
    folder
}

fn sir(folder: &Path, args: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_sir"));
    command.args(args).current_dir(folder);
    command
}

/// Returns a pipe whose reader has gone.
fn closed() -> Stdio {
    pipe().unwrap().1.into()
}

/// Returns a file on a full disk.
#[cfg(target_os = "linux")]
fn full() -> Stdio {
    fs::OpenOptions::new().write(true).open("/dev/full").unwrap().into()
}

/// Name of an output, and a function that opens it.
type Opener = (&'static str, fn() -> Stdio);

/// Returns ways to lose what is written.
fn broken() -> Vec<Opener> {
    vec![
        ("closed", closed),
        #[cfg(target_os = "linux")]
        ("full", full),
    ]
}

#[test]
fn a_run_whose_messages_nobody_reads_gives_the_same_result() {
    let folder = folder();
    let folder = folder.path();
    let Output { status, stdout, .. } = sir(folder, &["run", "room.ron", "--out", "read"]).output().unwrap();
    assert!(status.success());
    for (name, stderr) in broken() {
        for quiet in ["", "--quiet"] {
            let out = format!("{name}{quiet}");
            let mut args = vec!["run", "room.ron", "--out", &out];
            args.extend(Some(quiet).filter(|quiet| !quiet.is_empty()));
            let told = sir(folder, &args).stderr(stderr()).output().unwrap();
            assert_eq!(told.status.code(), Some(0), "{out}");
            assert_eq!(told.stdout.is_empty(), stdout.is_empty(), "{out}");
            for file in ["patches.csv", "result.json"] {
                assert!(folder.join(&out).join(file).exists(), "{out}/{file}");
            }
            let table = |run: &str| fs::read(folder.join(run).join("patches.csv")).unwrap();
            assert!(table(&out) == table("read"), "{out}");
        }
    }
}

#[test]
fn all_output_may_go_to_a_reader_that_stops_reading() {
    let folder = folder();
    let (mut reader, writer) = pipe().unwrap();
    let mut command = sir(folder.path(), &["run", "room.ron", "--out", "run"]);
    let mut child = command.stdout(writer.try_clone().unwrap()).stderr(writer).spawn().unwrap();
    drop(command);
    // As `head -c 1` does.
    reader.read_exact(&mut [0]).unwrap();
    drop(reader);
    assert_eq!(child.wait().unwrap().code(), Some(0));
    assert!(folder.path().join("run/result.json").exists());
}

#[test]
fn exit_codes_of_failures_do_not_depend_on_who_reads() {
    let folder = folder();
    let code = |args: &[&str], stderr: Stdio| {
        sir(folder.path(), args).stdout(Stdio::null()).stderr(stderr).status().unwrap().code()
    };
    for (name, stderr) in broken() {
        assert_eq!(code(&["check", "wrong.ron"], stderr()), Some(2), "{name}");
        assert_eq!(code(&["run", "wrong.ron"], stderr()), Some(2), "{name}");
        assert_eq!(code(&["run", "room.ron", "--no-such-option"], stderr()), Some(2), "{name}");
        assert_eq!(code(&["info", "missing.obj"], stderr()), Some(1), "{name}");
        let view_factors = ["viewfactors", "room.obj", "--lines", "1000", "--out", name];
        assert_eq!(code(&view_factors, stderr()), Some(0), "{name}");
    }
}

#[test]
fn a_reader_that_has_read_enough_is_no_failure() {
    let folder = folder();
    for args in [&["info", "room.obj"][..], &["check", "room.ron"], &["--help"], &["--version"]] {
        let Output { status, stderr, .. } =
            sir(folder.path(), args).stdout(closed()).stderr(Stdio::piped()).output().unwrap();
        let stderr = String::from_utf8(stderr).unwrap();
        assert_eq!(status.code(), Some(0), "{args:?}: {stderr}");
        assert!(stderr.lines().all(|line| line.starts_with("warning: ")), "{args:?}: {stderr}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn output_that_does_not_fit_on_the_disk_is_a_failure_with_a_message() {
    let folder = folder();
    let commands = [
        &["run", "room.ron", "--out", "run", "--quiet"][..],
        &["resume", "run"],
        &["info", "room.obj"],
        &["--help"],
    ];
    for args in commands {
        let output = sir(folder.path(), args).stdout(full()).output().unwrap();
        let stderr = String::from_utf8(output.stderr).unwrap();
        if args[0] == "resume" {
            assert!(
                stderr.contains("the run is finished"),
                "a run is complete without its summary: {stderr}"
            );
            continue;
        }
        assert_eq!(output.status.code(), Some(1), "{args:?}: {stderr}");
        assert!(
            stderr.contains("error: cannot write to standard output: No space left"),
            "{args:?}: {stderr}"
        );
    }
    assert!(folder.path().join("run/result.json").exists());
}
