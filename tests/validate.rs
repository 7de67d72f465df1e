//! `sir validate`: exit codes, files, and wrong answers.

#![cfg(unix)]
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::thread::sleep;
use std::time::Duration;

const DATA: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/crates/sir-validate/data");

fn validate(folder: &Path, args: &[&str]) -> (i32, String, String) {
    let program =
        Command::new(env!("CARGO_BIN_EXE_sir")).arg("validate").args(args).current_dir(folder).output();
    let Output { status, stdout, stderr } = program.unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (status.code().unwrap(), text(stdout), text(stderr))
}

/// Returns a folder with the exact answers, one of which is changed.
fn wrong_answers() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for name in sir_validate::FILES {
        let text = fs::read_to_string(Path::new(DATA).join(name)).unwrap();
        let changed = text.replace("\"floor\": 18.1818196215391", "\"floor\": 19.0");
        assert_eq!(changed != text, name == "radiosity-exact.json");
        fs::write(folder.path().join(name), changed).unwrap();
    }
    folder
}

#[test]
fn right_answers_end_with_0() {
    let folder = tempfile::tempdir().unwrap();
    let (code, stdout, stderr) = validate(
        folder.path(),
        &["--quick", "--case", "re-08,CIE-5.2,RE-02", "--out", "there", "--threads", "2", "--seed", "5"],
    );
    assert_eq!(code, 0, "{stderr}");
    assert!(
        stdout.contains("\n23 of 23 answers in 2 cases are exact to within noise; not run: RE-02.\n"),
        "{stdout}"
    );
    assert!(stdout.contains("`sir validate --quick --seed 5`") && stdout.contains("| B floor "), "{stdout}");
    assert!(stderr.contains("RE-08, Box with one element per face"), "{stderr}");
    assert_eq!(fs::read_to_string(folder.path().join("there/validation.md")).unwrap(), stdout);
    let json = fs::read_to_string(folder.path().join("there/validation.json")).unwrap();
    let report: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(report["cases"][1]["checks"][0]["verdict"], "passed");
    assert_eq!(
        report["cases"][0]["skipped"].as_str().unwrap().split(';').next(),
        Some("a scene cannot be infinite")
    );
}

#[test]
fn wrong_answers_end_with_1_after_the_table() {
    let folder = wrong_answers();
    let (code, stdout, stderr) =
        validate(folder.path(), &["--quick", "--case", "RE-08", "--reference", ".", "--quiet"]);
    assert_eq!(code, 1, "{stderr}");
    assert_eq!(stdout.matches("| WRONG |").count(), 1, "{stdout}");
    assert_eq!(stderr.lines().count(), 1, "{stderr}");
    assert!(
        stderr.starts_with("error: 12 of 13 answers in 1 cases") && stderr.contains("1 are wrong"),
        "{stderr}"
    );
    let (code, stdout, _) =
        validate(folder.path(), &["--quick", "--case", "RE-08", "--reference", ".", "-q", "--json"]);
    let report: serde_json::Value = serde_json::from_str(&stdout).unwrap();
    assert_eq!((code, &report["cases"][0]["checks"][1]["verdict"]), (1, &"wrong".into()));
}

#[test]
fn mistakes_end_with_2_and_say_what_to_do() {
    let folder = wrong_answers();
    let (code, _, stderr) = validate(folder.path(), &["--case", "RE-77"]);
    assert_eq!(code, 2);
    assert!(stderr.starts_with("error: there is no case RE-77; the cases are VF-01, "), "{stderr}");
    let (code, _, stderr) = validate(folder.path(), &["--reference", "nowhere"]);
    assert!(code == 2 && stderr.contains("--reference needs a folder with view-factors.json"), "{stderr}");
    fs::write(folder.path().join("cie171.json"), "{}").unwrap();
    let (code, _, stderr) = validate(folder.path(), &["--reference", "."]);
    assert!(code == 2 && stderr.contains("cie171.json is not a file of exact answers"), "{stderr}");
}

#[test]
fn an_interrupt_ends_with_130() {
    let mut command = Command::new(env!("CARGO_BIN_EXE_sir"));
    let child = command.arg("validate").stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    sleep(Duration::from_secs(1));
    let kill = format!("kill -INT {}", child.id());
    assert!(Command::new("sh").args(["-c", &kill]).status().unwrap().success());
    let Output { status, stdout, stderr } = child.wait_with_output().unwrap();
    assert_eq!(status.code(), Some(130), "{}", String::from_utf8_lossy(&stderr));
    assert!(stdout.is_empty());
    assert!(String::from_utf8_lossy(&stderr).contains("error: interrupted"));
}
