//! Pipelines for third-party scenes.
//!
//! The scenes are not part of the project. They are read from the folder in the variable `SIR_TEST_DATA`, or from the
//! folder `shared` next to the repository. Without them the pipelines are only parsed, and the test prints this.

#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "test helpers fail and print like tests")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use sir::pipeline::plan::Pipeline;

fn pipelines() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/third-party");
    let mut found: Vec<PathBuf> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    found.retain(|path| path.extension().is_some_and(|e| e == "ron"));
    found.sort();
    assert_eq!(found.len(), 11);
    found
}

/// Returns the path of the scene of a pipeline, below `data`.
fn scene_of(text: &str) -> &str {
    let (_, rest) = text.split_once("Load(path: \"data/").unwrap();
    rest.split('"').next().unwrap()
}

#[test]
fn all_are_pipelines_whose_scenes_are_in_data_and_which_the_readme_names() {
    let readme = fs::read_to_string(pipelines()[0].with_file_name("README.md")).unwrap();
    let copies = tempfile::tempdir().unwrap();
    for path in pipelines() {
        // A pipeline can be read only if its scene exists. An empty file is sufficient.
        let text = fs::read_to_string(&path).unwrap();
        let scene = copies.path().join("data").join(scene_of(&text));
        fs::create_dir_all(scene.parent().unwrap()).unwrap();
        fs::write(&scene, "").unwrap();
        let copy = copies.path().join(path.file_name().unwrap());
        fs::write(&copy, &text).unwrap();
        let pipeline = Pipeline::read(&copy).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(pipeline.scene_path(), scene);
        let name = path.file_stem().unwrap().to_str().unwrap();
        assert!(readme.contains(&format!("`{name}`")), "{name} is not in the README");
    }
}

#[test]
#[ignore = "needs third-party scenes: set SIR_TEST_DATA to their folder"]
fn all_check_where_their_scenes_are() {
    let data = match std::env::var_os("SIR_TEST_DATA") {
        Some(folder) => PathBuf::from(folder),
        None => Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared"),
    };
    let scenes = data.join("scenes");
    let copies = tempfile::tempdir().unwrap();
    for path in pipelines() {
        let text = fs::read_to_string(&path).unwrap();
        let scene = scenes.join(scene_of(&text));
        if !scene.is_file() {
            println!("skipped: no file {}", scene.display());
            continue;
        }
        let text = text.replace("data/", &format!("{}/", scenes.canonicalize().unwrap().display()));
        let copy = copies.path().join(path.file_name().unwrap());
        fs::write(&copy, text).unwrap();
        let output = Command::new(env!("CARGO_BIN_EXE_sir")).arg("check").arg(&copy).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    }
}
