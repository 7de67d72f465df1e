//! The program `sir`: exit codes, standard output and standard error.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

const ROOM: &str = "mtllib room.mtl
v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 0 0 2\nv 2 0 2\nv 2 2 2\nv 0 2 2
usemtl wall\nf 1 2 3 4\nf 6 5 8 7\nf 5 1 4 8\nf 2 6 7 3\nf 5 6 2 1
usemtl lamp\nf 4 3 7 8\n";
const MATERIALS: &str = "newmtl wall\nKd 0.5 0.5 1\nnewmtl lamp\nKd 0.2 0.2 0.2\nKe 1 1 1\n";
const PIPELINE: &str = r#"(stages: [
    Load(path: "room.obj"),
    FirstShot(lines: 2_000),
    Multipath(lines: 2_000),
    Save([Table(path: "patches.csv"), Image(path: "view.png", width: 16, height: 12, samples: 1)]),
])"#;

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in [("room.obj", ROOM), ("room.mtl", MATERIALS), ("room.ron", PIPELINE)] {
        fs::write(folder.path().join(name), text).unwrap();
    }
    folder
}

fn sir(folder: &Path, args: &[&str]) -> (i32, String, String) {
    let Output { status, stdout, stderr } =
        Command::new(env!("CARGO_BIN_EXE_sir")).args(args).current_dir(folder).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (status.code().unwrap(), text(stdout), text(stderr))
}

#[test]
fn a_run_prints_its_files_and_leaves_progress_to_the_error_stream() {
    let folder = folder();
    let (code, stdout, stderr) = sir(folder.path(), &["run", "room.ron"]);
    assert_eq!(code, 0, "{stderr}");
    let first = stdout.lines().next().unwrap();
    assert!(first.ends_with("results/room/view.png") && Path::new(first).is_absolute(), "{first}");
    assert!(Path::new(first).is_file());
    for part in ["FirstShot", "lines/s", "absorbed", "result.json"] {
        assert!(stdout.contains(part), "{stdout}");
    }
    assert!(stderr.contains("warning: ") && stderr.contains("Multipath: 2_000 lines"), "{stderr}");
    assert!(stderr.lines().count() < 20, "{stderr}");
}

#[test]
fn quiet_and_json_are_for_programs() {
    let folder = folder();
    let (code, stdout, stderr) = sir(
        folder.path(),
        &["run", "room.ron", "--quiet", "--json", "--seed", "9", "--out", "o", "--threads", "2"],
    );
    assert_eq!(code, 0, "{stderr}");
    assert!(stderr.lines().all(|line| line.starts_with("warning: ")), "{stderr}");
    let report: serde_json::Value = serde_json::from_str(&stdout).unwrap();
    assert_eq!((&report["version"], &report["seed"]), (&3.into(), &9.into()));
    assert_eq!(fs::read_to_string(folder.path().join("o/result.json")).unwrap(), stdout);

    let (code, stdout, _) = sir(folder.path(), &["compare", "o", "o/patches.csv", "--json"]);
    assert_eq!(code, 0);
    let comparison: serde_json::Value = serde_json::from_str(&stdout).unwrap();
    assert_eq!(comparison["luminance"]["relative_rms"], 0.0);
    let (code, stdout, _) = sir(folder.path(), &["compare", "o", "o"]);
    assert!(code == 0 && stdout.contains("relative RMS"), "{stdout}");
}

#[test]
fn light_groups_are_dimmed_after_the_run() {
    let folder = folder();
    let light = r#"Light([Point(position: (1, 1, 1), power: 5, group: "desk")]), FirstShot("#;
    fs::write(folder.path().join("room.ron"), PIPELINE.replace("FirstShot(", light)).unwrap();
    let sir = |args: &[&str]| sir(folder.path(), args);
    let (code, stdout, stderr) = sir(&["check", "room.ron"]);
    assert!(code == 0 && stdout.contains("2 light groups, each with all lines"), "{stdout}{stderr}");
    let (code, stdout, stderr) = sir(&["run", "room.ron"]);
    assert!(
        code == 0 && stdout.contains("light group desk: 5.000000 + 5.000000 + 5.000000 W\n"),
        "{stdout}{stderr}"
    );
    let (code, stdout, stderr) =
        sir(&["mix", "results/room", "--set", "desk=0.5", "--set", "other=(1, 0, 2)"]);
    assert_eq!(code, 0, "{stderr}");
    assert!(stdout.lines().next().unwrap().ends_with("results/room-mix/view.png"), "{stdout}");
    assert!(stdout.contains("W × 0.5\n") && stdout.contains("W × (1, 0, 2)\n"), "{stdout}");
    let same = ["mix", "results/room", "--quiet", "--json", "--out", "same", "--set", "desk=1"];
    let (code, stdout, _) = sir(&same);
    let report: serde_json::Value = serde_json::from_str(&stdout).unwrap();
    assert_eq!((code, &report["mixed_from"]), (0, &"results/room".into()));
    let table = |directory: &str| fs::read(folder.path().join(directory).join("patches.csv")).unwrap();
    assert!(table("same") == table("results/room") && table("same") != table("results/room-mix"));
    for (args, part) in [
        (
            &["mix", "results/room", "--set", "sky=1"][..],
            "the light groups of the run are `desk` and `other`",
        ),
        (&["mix", "results/room", "--set", "desk=-1"], "a finite number, 0 or more"),
        (&["mix", "results/room", "--set", "desk"], "write the name of a light group and a factor"),
        (&["mix", "same"], "`sir mix results/room` mixes it"),
        (&same, "--force"),
    ] {
        let (code, _, stderr) = sir(args);
        assert!(code == 2 && stderr.contains(part), "{args:?}: {stderr}");
    }
}

#[test]
fn wrong_usage_and_wrong_pipelines_exit_with_2() {
    let folder = folder();
    fs::write(folder.path().join("bad.ron"), "(stages: [FirstShot(line: 3)])").unwrap();
    fs::write(folder.path().join("picture.png"), b"\x89PNG\xff").unwrap();
    for (args, part) in [
        (&["run"][..], "Usage"),
        (&["walk"], "Usage"),
        (&["run", "room.ron", "--threads", "0"], "whole number from 1"),
        (&["run", "none.ron"], "error: cannot read the pipeline none.ron: "),
        (&["run", "picture.png"], "error: picture.png is not a text file"),
        (&["run", "bad.ron"], "error: unknown field `line` in `FirstShot`\n --> bad.ron:1:21\n"),
        (&["check", "bad.ron"], "help: did you mean `lines`?"),
    ] {
        let (code, stdout, stderr) = sir(folder.path(), args);
        assert_eq!((code, stdout.as_str()), (2, ""), "{args:?}: {stderr}");
        assert!(stderr.contains(part), "{args:?}: {stderr}");
    }
    assert!(!folder.path().join("results").exists());
    assert_eq!(sir(folder.path(), &["run", "room.ron", "--out", "o"]).0, 0);
    let (code, _, stderr) = sir(folder.path(), &["run", "room.ron", "--out", "o"]);
    assert!(
        code == 2 && stderr.contains("help: `--out DIR` chooses another directory, `--force`"),
        "{stderr}"
    );
    assert_eq!(sir(folder.path(), &["run", "room.ron", "--out", "o", "--force"]).0, 0);
}

#[test]
fn failures_exit_with_1() {
    let folder = folder();
    let (code, _, stderr) = sir(folder.path(), &["compare", "room.obj", "nothing.csv"]);
    assert_eq!(code, 1, "{stderr}");
    fs::write(folder.path().join("room.obj"), "f 1 2 3\n").unwrap();
    let (code, stdout, stderr) = sir(folder.path(), &["run", "room.ron"]);
    assert_eq!((code, stdout.as_str()), (1, ""));
    assert!(stderr.lines().last().unwrap().starts_with("error: room.obj"), "{stderr}");
    assert!(!folder.path().join("results").exists());
}

#[test]
fn help_has_examples_and_exit_codes() {
    let (code, stdout, _) = sir(Path::new("."), &["--help"]);
    assert_eq!(code, 0);
    for part in ["sir run ", "sir check ", "sir compare ", "Exit codes", "Load(path: "] {
        assert!(stdout.contains(part), "{stdout}");
    }
}

#[test]
fn info_tells_people_and_programs_the_same() {
    let folder = folder();
    let (code, stdout, stderr) = sir(folder.path(), &["info", "room.obj"]);
    assert_eq!((code, stderr.as_str()), (0, ""));
    let (code, json, _) = sir(folder.path(), &["info", "room.obj", "--json"]);
    assert_eq!(code, 0);
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!((&json["triangles"], &json["vertices"]), (&12.into(), &8.into()));
    assert!(stdout.contains("triangles  12\n") && stdout.contains("extent     2 × 2 × 2 m"), "{stdout}");
    for setting in json["settings"].as_array().unwrap() {
        assert!(stdout.contains(setting["set"].as_str().unwrap()), "{stdout}");
    }
    let (code, stdout, stderr) = sir(folder.path(), &["info", "absent.obj"]);
    assert_eq!((code, stdout.as_str()), (1, ""));
    assert!(stderr.starts_with("error: ") && stderr.contains("absent.obj"), "{stderr}");
}

#[test]
fn a_scene_is_lit_by_one_command_which_ends_with_the_page() {
    let folder = folder();
    let light = |args: &[&str]| sir(folder.path(), &[&["light"], args].concat());
    let (code, stdout, stderr) = light(&["room.obj", "--minutes", "0.001", "--quiet"]);
    assert_eq!(code, 0, "{stderr}");
    let page = stdout.lines().last().unwrap().strip_prefix("page: ").unwrap();
    assert!(page.ends_with("results/room/report.html") && Path::new(page).is_file(), "{stdout}");
    assert!(stdout.contains("sir run results/room/pipeline.ron"), "{stdout}");

    // The pipeline is one like any other.
    let (code, _, stderr) = sir(folder.path(), &["check", "results/room/pipeline.ron"]);
    assert_eq!(code, 0, "{stderr}");

    let (code, stdout, _) = light(&["room.obj", "--dry-run", "--json", "--error", "5%", "--out", "drafted"]);
    assert_eq!(code, 0);
    let drafted: serde_json::Value = serde_json::from_str(&stdout).unwrap();
    assert!(Path::new(drafted["pipeline"].as_str().unwrap()).ends_with("drafted/pipeline.ron"));
    assert_eq!(fs::read_dir(folder.path().join("drafted")).unwrap().count(), 1);
    let text = fs::read_to_string(folder.path().join("drafted/pipeline.ron")).unwrap();
    assert!(text.contains("until: RelativeError(0.05), stages") && text.contains("../room.obj"), "{text}");

    for (args, expected) in [
        (&["room.ron"][..], "`sir run room.ron` runs it"),
        (&["room.obj", "--error", "0.02"], "with a per cent sign"),
        (&["room.obj", "--minutes", "0"], "a number of minutes from 0.001"),
        (&["room.obj", "--out", "results/room"], "already holds a result"),
    ] {
        let (code, stdout, stderr) = light(args);
        assert!(code == 2 && stdout.is_empty() && stderr.contains(expected), "{code} {stderr}");
    }
    let (code, _, stderr) = light(&["."]);
    assert!(code == 1 && stderr.contains(". is a folder; name the scene file in it"), "{code} {stderr}");
}

#[test]
fn editors_and_shells_learn_what_there_is() {
    let folder = tempfile::tempdir().unwrap();
    let (code, stdout, _) = sir(folder.path(), &["schema"]);
    let schema: serde_json::Value = serde_json::from_str(&stdout).unwrap();
    let records = schema["records"].as_array().unwrap();
    let load = records.iter().find(|record| record["name"] == "Load").unwrap();
    assert_eq!((code, &load["fields"][0]["name"]), (0, &"path".into()));
    assert!(schema["choices"].as_array().unwrap().iter().any(|choice| choice["what"] == "stage"));
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let (code, stdout, _) = sir(folder.path(), &["completions", shell]);
        assert!(code == 0 && stdout.contains("viewfactors"), "{shell}");
    }
    let (code, stdout, _) = sir(folder.path(), &["--version"]);
    assert!(code == 0 && stdout.contains("\nbuild: ") && stdout.contains("\nfeatures: "), "{stdout}");
}
