//! The reference of the pipeline file says what the program does.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use std::fs;
use std::path::{Path, PathBuf};

use sir_pipeline::plan::{Action, Pipeline};

fn reference() -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/pipeline.md");
    fs::read_to_string(path).unwrap()
}

/// The examples, parsed in a folder that has their scene. All must be valid.
fn examples() -> Vec<Pipeline> {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("room.gltf"), "").unwrap();
    let text = reference();
    let blocks = text.split("```ron\n").skip(1).map(|block| block.split("```").next().unwrap());
    blocks
        .map(|block| {
            Pipeline::parse(block, &folder.path().join("pipeline.ron")).unwrap_or_else(|e| panic!("{e}"))
        })
        .collect()
}

#[test]
fn all_examples_are_valid() {
    assert_eq!(examples().len(), 5);
}

#[test]
fn the_defaults_are_those_of_the_reference() {
    let all = examples();
    let actions = |p: &Pipeline| -> Vec<Action> {
        let mut actions: Vec<Action> = p.stages.iter().map(|s| s.action.clone()).collect();
        for action in &mut actions {
            if let Action::Load { path, .. } = action {
                *path = PathBuf::new();
            }
        }
        actions
    };
    // The last two say the same, at length and in short.
    let [.., long, short] = &all[..] else { panic!("two examples") };
    assert_eq!(long.seed, short.seed);
    assert_eq!(long.units, short.units);
    assert_eq!(actions(long), actions(short));
}

/// The pipelines of the scenes that come with the project.
#[test]
fn pipelines_of_the_project_are_valid() {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let folders = fs::read_dir(scenes).unwrap().map(|entry| entry.unwrap().path());
    let pipelines: Vec<PathBuf> = folders.map(|f| f.join("pipeline.ron")).filter(|p| p.is_file()).collect();
    assert!(!pipelines.is_empty());
    for path in pipelines {
        Pipeline::read(&path).unwrap_or_else(|e| panic!("{e}"));
    }
}

/// An unknown field is answered with the list of those that exist; each of them must be in the reference, in the
/// section of its owner.
#[test]
fn all_fields_are_documented() {
    let text = reference();
    let nonsense = "(stages: [Load(zzzzzzzz: 1), Subdivide(zzzzzzzz: 1), Focus(zzzzzzzz: 1),
        Light([Point(zzzzzzzz: 1, spread: Spot(zzzzzzzz: 1)), Point(spread: Lambertian(zzzzzzzz: 1)), Distant(zzzzzzzz: 1),
        Panel(zzzzzzzz: 1), Sky(zzzzzzzz: 1, model: Cie(zzzzzzzz: 1)), Environment(zzzzzzzz: 1)]), FirstShot(zzzzzzzz: 1), SecondShot(zzzzzzzz: 1), Multipath(zzzzzzzz: 1),
        Save([Image(zzzzzzzz: 1, camera: Camera(zzzzzzzz: 1)), Gltf(zzzzzzzz: 1), Table(zzzzzzzz: 1)])], zzzzzzzz: 1)";
    let problems = Pipeline::parse(nonsense, Path::new("x.ron")).unwrap_err();
    let lists: Vec<&str> = problems
        .list()
        .iter()
        .map(|p| p.help.as_str())
        .filter(|help| help.contains(" has the fields "))
        .collect();
    assert_eq!(lists.len(), 19);
    for list in lists {
        let (owner, fields) = list.split_once(" has the fields ").unwrap();
        let section = match owner {
            "`Camera`" | "`Point`" | "`Lambertian`" | "`Spot`" | "`Distant`" | "`Panel`" | "`Sky`"
            | "`Cie`" | "`Environment`" => format!("| field of {owner}"),
            _ => format!("# {owner}"),
        };
        let start = text.find(&section).unwrap_or_else(|| panic!("no section {section}"));
        let end = text[start + 2..].find("\n#").map_or(text.len(), |end| start + 2 + end);
        for field in fields.split('`').skip(1).step_by(2) {
            assert!(text[start..end].contains(&format!("\n| `{field}` |")), "{owner} lacks {field}");
        }
    }
}
