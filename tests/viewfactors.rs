//! `sir viewfactors`: output, files, and errors.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

/// Cube of six named two-sided faces, without a material library. There is nothing outside of it.
const CUBE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1
usemtl gray\no floor\nf 1 2 3 4\no \"ceiling, high\"\nf 6 5 8 7\ng west\nf 5 1 4 8\ng east\nf 2 6 7 3\no south\nf 5 6 2 1\no north\nf 4 3 7 8\n";

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("cube.obj"), CUBE).unwrap();
    let unnamed: String =
        CUBE.lines().filter(|line| !line.starts_with(['o', 'g'])).map(|l| format!("{l}\n")).collect();
    fs::write(folder.path().join("unnamed.obj"), unnamed).unwrap();
    folder
}

fn sir(folder: &Path, args: &str) -> (i32, String, String) {
    let Output { status, stdout, stderr } = Command::new(env!("CARGO_BIN_EXE_sir"))
        .arg("viewfactors")
        .args(args.split_whitespace())
        .current_dir(folder)
        .output()
        .unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (status.code().unwrap(), text(stdout), text(stderr))
}

#[test]
fn tables_and_files_agree() {
    let folder = folder();
    let args = "cube.obj --by group --sides front --error 0.004 --closure --out vf --quiet";
    let (code, stdout, stderr) = sir(folder.path(), args);
    assert_eq!(code, 0, "{stderr}");
    assert!(stdout.contains("\"ceiling, high\"") && stdout.contains("reciprocity of 15 pairs"), "{stdout}");
    assert!(stdout.ends_with("vf/viewfactors.json\n"), "{stdout}");
    let read = |name: &str| fs::read_to_string(folder.path().join("vf").join(name)).unwrap();
    let json: Value = serde_json::from_str(&read("viewfactors.json")).unwrap();
    for matrix in ["counted", "closed"] {
        let matrix = &json[matrix];
        for i in 0..6 {
            assert!((matrix["row_sums"][i].as_f64().unwrap() - 1.0).abs() < 1e-9);
            for j in (0..6).filter(|&j| j != i) {
                let of = |name: &str| matrix[name][i][j].as_f64().unwrap();
                let exact = if i / 2 == j / 2 { 0.199_824_895_698_387 } else { 0.200_043_776_075_403 };
                assert!((of("factors") - exact).abs() < 4.0 * of("errors"), "F_{i}{j}");
                assert!(of("errors") <= 0.004);
            }
        }
    }
    let csv = read("factors.csv");
    let rows: Vec<&str> = csv.lines().collect();
    assert_eq!(
        rows[0],
        "group,area,lines,floor,\"\"\"ceiling, high\"\"\",west,east,south,north,blocked,escaped"
    );
    let first: Vec<f64> = rows[1].split(',').skip(1).map(|x| x.parse().unwrap()).collect();
    assert_eq!(first[0], 1.0);
    let found: Vec<f64> = (0..6).map(|j| json["counted"]["factors"][0][j].as_f64().unwrap()).collect();
    assert_eq!(first[2..8], found);
    assert_eq!(read("pairs.csv").lines().count(), 31);
    assert_eq!(read("closed.csv").lines().count(), 7);

    // The reported number of lines gives the same result again, with another number of threads.
    let lines = &json["lines"];
    let args = format!("cube.obj --by group --sides front --lines {lines} --closure --threads 3 --json -q");
    let (code, stdout, stderr) = sir(folder.path(), &args);
    assert_eq!(code, 0, "{stderr}");
    assert_eq!(stdout, read("viewfactors.json"));
}

#[test]
fn sides_decide_what_escapes() {
    let folder = folder();
    let of = |sides: &str| -> Value {
        let args = format!("cube.obj --lines 3000 --json -q --sides {sides}");
        serde_json::from_str(&sir(folder.path(), &args).1).unwrap()
    };
    let (both, front) = (of("as-authored"), of("front"));
    assert_eq!(both["groups"][0]["area"], 12.0);
    assert_eq!((&front["groups"][0]["area"], &front["counted"]["escaped"][0]), (&6.0.into(), &0.0.into()));
    // Half of the power is sent from the outside of the cube and escapes. The tolerance is four standard errors of
    // 3,000 lines.
    assert!((both["counted"]["escaped"][0].as_f64().unwrap() - 0.5).abs() < 0.037);
}

#[test]
fn mistakes_say_what_to_do() {
    let folder = folder();
    for (args, code, expected) in [
        ("absent.obj", 1, "absent.obj"),
        ("cube.ron", 1, "cube.ron"),
        ("unnamed.obj --by group", 2, "use `--by material`"),
        ("cube.obj --by group --lines 95", 1, "ask for at least 96"),
        ("cube.obj --error 0", 2, "write a number from"),
        ("cube.obj --error", 2, "--error"),
        ("cube.obj --relative 0.1", 2, "--error <E>"),
        ("cube.obj --lines many", 2, "such as 1_000_000"),
        ("cube.obj --by color", 2, "group"),
        ("cube.obj --sides none", 2, "as-authored"),
        ("", 2, "<SCENE>"),
    ] {
        let (found, stdout, stderr) = sir(folder.path(), args);
        assert_eq!((found, stdout.as_str()), (code, ""), "{args}: {stderr}");
        assert!(stderr.contains(expected), "{args}: {stderr}");
    }
    let args = "cube.obj --lines 1000 --out vf -q";
    assert_eq!(sir(folder.path(), args).0, 0);
    let (code, _, stderr) = sir(folder.path(), args);
    assert!(code == 2 && stderr.contains("--force"), "{stderr}");
    assert_eq!(sir(folder.path(), &format!("{args} --force")).0, 0);
}

#[cfg(unix)]
#[test]
fn an_interrupt_ends_with_130() {
    use std::process::Stdio;
    let folder = folder();
    let mut child = Command::new(env!("CARGO_BIN_EXE_sir"))
        .args(["viewfactors", "cube.obj", "--error", "1e-6", "--out", "vf"])
        .current_dir(folder.path())
        .stderr(Stdio::piped())
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    std::thread::sleep(std::time::Duration::from_millis(500));
    assert!(child.try_wait().unwrap().is_none());
    Command::new("sh").args(["-c", &format!("kill -INT {}", child.id())]).status().unwrap();
    let Output { status, stderr, .. } = child.wait_with_output().unwrap();
    let stderr = String::from_utf8(stderr).unwrap();
    assert_eq!(status.code(), Some(130), "{stderr}");
    assert!(stderr.contains("interrupted after"), "{stderr}");
    assert!(!folder.path().join("vf/viewfactors.json").exists());
}
