//! Broken and difficult third-party files, which are read in place and are not part of the project.

use std::fs;
use std::path::{Path, PathBuf};

use sir_geom::{LoadError, SceneError};

use crate::bounded::{alone, load_within_bounds};
use crate::files::{chain, third_party_data};

/// Adds all scene files in a folder and below it, by name, with the total size of all files in the same folder.
fn scenes_below(folder: &Path, found: &mut Vec<(PathBuf, usize)>) {
    let mut paths: Vec<PathBuf> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    let bytes = paths.iter().map(|path| fs::metadata(path).unwrap().len() as usize).sum();
    for path in paths {
        if path.is_dir() {
            scenes_below(&path, found);
        } else if path.extension().is_some_and(|e| ["obj", "gltf", "glb"].iter().any(|known| e == *known)) {
            found.push((path, bytes));
        }
    }
}

/// Returns true if the report of a validator has no error for a file; `None` if there is no report.
fn is_valid(file: &Path) -> Option<bool> {
    let report = fs::read(format!("{}.report.json", file.display())).ok()?;
    let report: serde_json::Value = serde_json::from_slice(&report).unwrap();
    Some(report["issues"]["numErrors"] == 0)
}

/// Returns true if a valid file is rejected for a good reason.
fn by_design(error: &LoadError) -> bool {
    match error {
        // No triangles, or an unsupported extension, which the error names.
        LoadError::Scene { source: SceneError::Empty { .. }, .. } => true,
        LoadError::RequiredExtensions { names, .. } => !names.is_empty(),
        // A buffer may have neither a file nor the binary chunk: its bytes are expected from elsewhere.
        other => chain(other).contains("has no data"),
    }
}

#[test]
#[ignore = "needs third-party scenes: set SIR_TEST_DATA to their folder"]
fn every_file_of_the_corpus_ends_with_a_scene_or_an_error() {
    let _alone = alone();
    let data = third_party_data();
    let mut files = Vec::new();
    scenes_below(&data.join("corpus"), &mut files);
    let (mut loaded, mut valid, mut refused, mut design) = (0, 0, 0, 0);
    for (file, bytes) in &files {
        let ok = is_valid(file);
        valid += usize::from(ok == Some(true));
        let kind = match load_within_bounds(file, *bytes) {
            Ok(_) => {
                loaded += 1;
                "loaded".to_owned()
            }
            Err(error) if ok == Some(true) => {
                assert!(by_design(&error), "a valid file is refused: {}", chain(&error));
                design += 1;
                format!("by design  {}", chain(&error))
            }
            Err(error) => {
                refused += 1;
                format!("refused    {}", chain(&error))
            }
        };
        let data = data.display().to_string() + "/corpus/";
        println!("{}  {}", file.display().to_string().replace(&data, ""), kind.replace(&data, ""));
    }
    println!("{} files: {loaded} loaded, {refused} refused, {design} by design", files.len());
    assert!(files.len() > 230 && loaded >= 45 && valid > 50, "{loaded} of {} loaded", files.len());
}
