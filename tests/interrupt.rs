//! Resumption of runs that were stopped, killed, or ended by a full disk, with the real program and real signals.

#![cfg(unix)]
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "test helpers fail and print like tests")]

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::thread::sleep;
use std::time::Duration;

/// Pipeline that takes several seconds, with outputs in between.
const PIPELINE: &str = r#"Pipeline(
    stages: [
        Load(path: "furnace.gltf"),
        Subdivide(patches: 3_000),
        FirstShot(lines: 4_000_000),
        Save([Table(path: "direct.npy")]),
        Multipath(lines: 8_000_000),
        Save([Table(path: "patches.csv"), Gltf(path: "lit.glb")]),
    ],
)"#;

fn sir() -> Command {
    Command::new(env!("CARGO_BIN_EXE_sir"))
}

/// Returns a folder with a scene and a pipeline with this text.
fn folder(text: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/furnace/furnace.gltf");
    fs::copy(scene, folder.path().join("furnace.gltf")).unwrap();
    fs::write(folder.path().join("work.ron"), text).unwrap();
    folder
}

fn in_replicas() -> String {
    PIPELINE
        .replace("Multipath(lines: 8_000_000)", "Multipath(lines: 16_000_000, transport: Replicas(count: 3))")
}

fn repeated() -> String {
    let lines =
        "Repeat(times: 40, stages: [FirstShot(lines: 200_000), Multipath(lines: 300_000)]),\n        ";
    let [start, end] =
        ["FirstShot", "Save([Table(path: \"patches"].map(|place| PIPELINE.find(place).unwrap());
    format!("{}{lines}{}", &PIPELINE[..start], &PIPELINE[end..])
}

/// Starts a run, or resumes the run in this directory if there is a checkpoint.
fn start(folder: &Path, out: &str, threads: usize, every: &str) -> Child {
    let mut command = sir();
    if folder.join(out).join("checkpoint").exists() {
        command.args(["resume", out]);
    } else {
        command.args(["run", "work.ron", "--out", out]);
    }
    command.args(["--threads", &threads.to_string(), "--checkpoint-every", every]);
    command.current_dir(folder).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap()
}

fn finish(folder: &Path, out: &str) {
    let Output { status, stderr, .. } = start(folder, out, 2, "300").wait_with_output().unwrap();
    assert!(status.success(), "{}", String::from_utf8_lossy(&stderr));
}

/// Waits until a file exists.
fn wait_for(path: &Path) {
    while !path.exists() {
        sleep(Duration::from_millis(10));
    }
}

fn signal(child: &Child, name: &str) {
    // `kill` of the shell, because not every system has a program of that name.
    Command::new("sh").args(["-c", &format!("kill {name} {}", child.id())]).status().unwrap();
}

/// Returns all files of a finished run, with the times removed from the report.
fn files(directory: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let entries = fs::read_dir(directory).unwrap().map(|entry| entry.unwrap().path());
    entries
        .map(|path| {
            let mut bytes = fs::read(&path).unwrap();
            if path.ends_with("result.json") {
                let mut report: serde_json::Value = serde_json::from_slice(&bytes).unwrap();
                forget_times(&mut report);
                bytes = serde_json::to_vec(&report).unwrap();
            }
            (path.strip_prefix(directory).unwrap().to_owned(), bytes)
        })
        .collect()
}

/// Clears the times of a report and, recursively, of its stages.
fn forget_times(report: &mut serde_json::Value) {
    report["time"] = 0.into();
    for parts in ["stages", "convergence"] {
        if let Some(parts) = report.get_mut(parts).and_then(|parts| parts.as_array_mut()) {
            parts.iter_mut().for_each(forget_times);
        }
    }
}

#[track_caller]
fn assert_same(folder: &Path, out: &str, whole: &str) {
    let (a, b) = (files(&folder.join(out)), files(&folder.join(whole)));
    assert_eq!(a.keys().collect::<Vec<_>>(), b.keys().collect::<Vec<_>>());
    for (name, bytes) in &a {
        assert!(*bytes == b[name], "{} differs from that of an uninterrupted run", name.display());
    }
}

#[test]
fn a_run_that_is_killed_twenty_times_gives_the_same_bytes() {
    let folder = folder(PIPELINE);
    let folder = folder.path();
    finish(folder, "whole");
    let (mut kills, mut runs) = (0, 0);
    // Scattered but deterministic pauses.
    let mut pause = (0..).map(|i: u64| Duration::from_millis(40 + i * 7919 % 450));
    while kills < 20 {
        let out = format!("run-{runs}");
        loop {
            let mut child = start(folder, &out, 1 + kills % 3, "0.05");
            sleep(pause.next().unwrap());
            if child.try_wait().unwrap().is_none() && kills < 20 {
                signal(&child, "-KILL");
                kills += 1;
            }
            let Output { status, stderr, .. } = child.wait_with_output().unwrap();
            if status.success() {
                break;
            }
            assert_eq!(status.code(), None, "{}", String::from_utf8_lossy(&stderr));
        }
        assert_same(folder, &out, "whole");
        runs += 1;
    }
    println!("{kills} kills in {runs} runs");
}

#[test]
fn signals_save_the_state_and_exit_with_130() {
    for (name, text) in
        [("batches", PIPELINE.to_owned()), ("replicas", in_replicas()), ("repeats", repeated())]
    {
        let folder = folder(&text);
        let folder = folder.path();
        finish(folder, "whole");
        for which in ["-INT", "-TERM", "-HUP"] {
            let child = start(folder, "stopped", 1, "300");
            wait_for(&folder.join("stopped/checkpoint"));
            sleep(Duration::from_millis(300));
            signal(&child, which);
            if which == "-HUP" {
                // A closed terminal sends it twice.
                signal(&child, which);
            }
            let Output { status, stderr, .. } = child.wait_with_output().unwrap();
            let stderr = String::from_utf8(stderr).unwrap();
            assert_eq!(status.code(), Some(130), "{name}: {stderr}");
            assert!(
                stderr.contains("interrupted") && stderr.contains("`sir resume stopped` continues"),
                "{stderr}"
            );
            assert!(!folder.join("stopped/result.json").exists());
            assert!(!folder.join("stopped/.lock").exists());
        }
        let again = sir().args(["run", "work.ron", "--out", "stopped"]).current_dir(folder).output().unwrap();
        assert_eq!(again.status.code(), Some(2), "an interrupted run is not replaced by accident");
        finish(folder, "stopped");
        assert_same(folder, "stopped", "whole");
    }
}

#[test]
fn a_run_started_by_nohup_outlives_its_terminal() {
    let folder = folder(PIPELINE);
    let folder = folder.path();
    let mut command = Command::new("sh");
    command.args(["-c", "trap '' HUP; exec \"$0\" run work.ron --out run", env!("CARGO_BIN_EXE_sir")]);
    let child = command.current_dir(folder).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
    wait_for(&folder.join("run/checkpoint"));
    signal(&child, "-HUP");
    let Output { status, stderr, .. } = child.wait_with_output().unwrap();
    assert!(status.success(), "{}", String::from_utf8_lossy(&stderr));
}

#[test]
fn a_directory_in_use_is_refused_until_its_run_has_ended() {
    let folder = folder(PIPELINE);
    let folder = folder.path();
    let mut child = start(folder, "used", 1, "0.05");
    wait_for(&folder.join("used/checkpoint"));
    for (args, text) in [
        (&["run", "work.ron", "--out", "used"][..], "used is in use by another run"),
        (&["run", "work.ron", "--out", "used", "--force"], "used is in use by another run"),
        (&["resume", "used"], "the run in used cannot be resumed: it is in use by another run"),
    ] {
        let Output { status, stderr, .. } = sir().args(args).current_dir(folder).output().unwrap();
        let stderr = String::from_utf8(stderr).unwrap();
        assert_eq!(status.code(), Some(2), "{args:?}: {stderr}");
        assert!(stderr.contains(text) && !stderr.contains("interrupted"), "{args:?}: {stderr}");
    }
    assert!(child.try_wait().unwrap().is_none(), "the run must take longer than the refusals");
    signal(&child, "-KILL");
    child.wait().unwrap();
    // A killed run holds no lock.
    finish(folder, "used");
    finish(folder, "whole");
    assert_same(folder, "used", "whole");
}

/// A folder with the name of the lock emulates a folder in which no file can be created, which nothing is for root.
#[test]
fn a_directory_that_cannot_be_written_to_is_named() {
    let folder = folder(PIPELINE);
    let folder = folder.path();
    fs::create_dir_all(folder.join("fixed/.lock")).unwrap();
    let Output { status, stderr, .. } =
        sir().args(["run", "work.ron", "--out", "fixed"]).current_dir(folder).output().unwrap();
    let stderr = String::from_utf8(stderr).unwrap();
    assert_eq!(status.code(), Some(1), "{stderr}");
    assert!(stderr.contains("error: cannot write to the directory fixed; "), "{stderr}");
    assert!(!stderr.contains("checkpoint"), "{stderr}");
}

/// Environment variables of launchers stand in for the launchers.
#[cfg(not(feature = "mpi"))]
#[test]
fn several_processes_need_mpi() {
    let folder = folder(PIPELINE);
    for (variable, size, code) in [
        ("OMPI_COMM_WORLD_SIZE", "4", 1),
        ("PMI_SIZE", "4", 1),
        ("SLURM_STEP_NUM_TASKS", "4", 1),
        ("SLURM_STEP_NUM_TASKS", "1", 2),
        ("SLURM_NTASKS", "4", 2),
    ] {
        // Without the refusal, the command fails because there is no such run.
        let mut command = sir();
        let Output { status, stderr, .. } =
            command.args(["resume", "none"]).env(variable, size).current_dir(folder.path()).output().unwrap();
        let stderr = String::from_utf8(stderr).unwrap();
        assert_eq!(status.code(), Some(code), "{variable}={size}: {stderr}");
        assert_eq!(stderr.contains("built without MPI") && stderr.contains(variable), code == 1, "{stderr}");
    }
}

/// A file size limit emulates a full disk. It is large enough for the first checkpoint only.
#[test]
fn a_full_disk_is_an_error_that_leaves_the_checkpoint_before_it() {
    let folder = folder(PIPELINE);
    let folder = folder.path();
    finish(folder, "whole");
    let script = "trap '' XFSZ; ulimit -f 100; exec \"$0\" run work.ron --out full --checkpoint-every 0";
    let sir = env!("CARGO_BIN_EXE_sir");
    let Output { status, stderr, .. } =
        Command::new("sh").args(["-c", script, sir]).current_dir(folder).output().unwrap();
    let stderr = String::from_utf8(stderr).unwrap();
    assert_eq!(status.code(), Some(1), "{stderr}");
    let last = stderr.lines().last().unwrap();
    assert!(last.starts_with("error: cannot write the checkpoint full/checkpoint; "), "{stderr}");
    assert!(last.contains("still intact") && last.contains("too large"), "{stderr}");
    finish(folder, "full");
    assert_same(folder, "full", "whole");
    // Without room for any checkpoint, there is none to resume from.
    let script = script.replace("ulimit -f 100", "ulimit -f 0").replace("--out full", "--out empty");
    let Output { status, stderr, .. } =
        Command::new("sh").args(["-c", &script, sir]).current_dir(folder).output().unwrap();
    let stderr = String::from_utf8(stderr).unwrap();
    assert_eq!(status.code(), Some(1), "{stderr}");
    assert!(stderr.contains("error: cannot write the checkpoint empty/checkpoint; "), "{stderr}");
    assert!(!stderr.contains("intact") && !stderr.contains("resumed"), "{stderr}");
}

#[test]
fn what_cannot_be_resumed_is_refused_with_the_reason() {
    let folder = folder(PIPELINE);
    let folder = folder.path();
    let child = start(folder, "stopped", 1, "300");
    sleep(Duration::from_millis(500));
    signal(&child, "-TERM");
    assert_eq!(child.wait_with_output().unwrap().status.code(), Some(130));
    let refused = |directory: &str| {
        let Output { status, stderr, .. } =
            sir().args(["resume", directory]).current_dir(folder).output().unwrap();
        let stderr = String::from_utf8(stderr).unwrap();
        assert_eq!(status.code(), Some(2), "{stderr}");
        let start = format!("error: the run in {directory} cannot be resumed: ");
        assert!(stderr.contains(&start) && stderr.contains("`sir run PIPELINE`"), "{stderr}");
        stderr.lines().find(|line| line.starts_with(&start)).unwrap().to_owned()
    };
    // Changes a file, tries to resume, and restores the file.
    let with = |file: &str, change: &dyn Fn(Vec<u8>) -> Vec<u8>| {
        let path = folder.join(file);
        let before = fs::read(&path).unwrap();
        fs::write(&path, change(before.clone())).unwrap();
        let error = refused("stopped");
        fs::write(&path, before).unwrap();
        error
    };
    let text = |from: &'static str, to: &'static str| {
        move |bytes| String::from_utf8(bytes).unwrap().replacen(from, to, 1).into_bytes()
    };
    let error = with("work.ron", &text("8_000_000", "9_000_000"));
    assert!(error.contains("work.ron has changed; restore it, or start a new run"), "{error}");
    let other_camera = |bytes: Vec<u8>| {
        let mut scene: serde_json::Value = serde_json::from_slice(&bytes).unwrap();
        scene["cameras"][0]["perspective"]["yfov"] = 0.5.into();
        serde_json::to_vec(&scene).unwrap()
    };
    let error = with("furnace.gltf", &other_camera);
    assert!(error.contains("furnace.gltf has changed; restore it, or start a new run"), "{error}");
    let error = with("furnace.gltf", &text("0.5", "0.25"));
    assert!(error.contains("furnace.gltf has changed; restore it, or start a new run"), "{error}");
    let flip = |mut bytes: Vec<u8>| {
        let middle = bytes.len() / 2;
        bytes[middle] ^= 1;
        bytes
    };
    assert!(with("stopped/checkpoint", &flip).contains("damaged"));
    let cut = |bytes: Vec<u8>| bytes[..bytes.len() / 2].to_vec();
    assert!(with("stopped/checkpoint", &cut).contains("damaged"));
    let other = |bytes: Vec<u8>| [b"SIR checkpoint 0\n", &bytes[..]].concat();
    assert!(with("stopped/checkpoint", &other).contains("another version"));
    finish(folder, "stopped");
    assert!(refused("stopped").contains("the run is finished; see its result.json"));
    assert!(refused("nowhere").contains("there is no such directory"));
    fs::create_dir(folder.join("empty")).unwrap();
    assert!(refused("empty").contains("it holds no checkpoint; start a new run"));
}
