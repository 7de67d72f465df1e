//! Tests drafted pipelines: what they choose for small scenes, and that they can be read and run.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs;
use std::path::{Path, PathBuf};

use sir_pipeline::draft::{Draft, DraftOptions, Goal, PIPELINE_FILE, draft};
use sir_pipeline::plan::{Action, Lamp, Pipeline};
use sir_pipeline::run::{RunOptions, run_pipeline};
use sir_pipeline::{Error, Units};

/// Writes a closed, gray room of 4 × 3 × 5 units times `scale`, without its last `open` walls.
fn room(folder: &Path, scale: f64, open: usize) -> PathBuf {
    let mut text = String::new();
    for i in 0..8 {
        let at = |axis: usize, size: f64| if i >> axis & 1 == 1 { scale * size } else { 0.0 };
        text += &format!("v {} {} {}\n", at(0, 4.0), at(1, 3.0), at(2, 5.0));
    }
    let walls = ["1 5 6 2", "3 4 8 7", "1 2 4 3", "5 7 8 6", "1 3 7 5", "2 6 8 4"];
    walls[..6 - open].iter().for_each(|wall| text += &format!("f {wall}\n"));
    fs::write(folder.join("room.obj"), text).unwrap();
    folder.join("room.obj")
}

fn options(folder: &Path) -> DraftOptions {
    DraftOptions {
        out: Some(folder.join("out")),
        results: folder.join("results"),
        force: false,
        goal: Goal { relative_error: Some(0.05), seconds: Some(60.0) },
        command: "sir light room.obj".into(),
    }
}

/// Returns the lights of a draft, after checking that the file is the pipeline, and that every doubt names its line.
fn lamps(drafted: &Draft) -> Vec<Lamp> {
    let text = fs::read_to_string(drafted.directory.join(PIPELINE_FILE)).unwrap();
    assert_eq!(text, drafted.pipeline.text);
    for choice in &drafted.choices {
        assert!(text.lines().nth(choice.line - 1).unwrap().contains(&choice.set), "{choice:?}\n{text}");
    }
    let lights = drafted.pipeline.stages.iter().filter_map(|stage| match &stage.action {
        Action::Light(light) => Some(light.lamps.clone()),
        _ => None,
    });
    lights.flatten().collect()
}

#[test]
fn every_choice_of_a_draft_has_its_reason() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("box.gltf");
    let box_of_ours = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/cornell-box");
    for file in fs::read_dir(&box_of_ours).unwrap() {
        let name = file.unwrap().file_name();
        fs::copy(box_of_ours.join(&name), folder.path().join(&name)).unwrap();
    }
    fs::rename(folder.path().join("cornell-box.gltf"), &scene).unwrap();
    let drafted = draft(&scene, &options(folder.path())).unwrap();
    assert_eq!(lamps(&drafted), []);
    assert_eq!(drafted.choices, []);
    let folder = folder.path().display().to_string();
    insta::assert_snapshot!(drafted.pipeline.text.replace(&folder, "FOLDER"));
}

#[test]
fn a_dark_room_gets_a_lamp_and_an_open_one_the_sky() {
    let folder = tempfile::tempdir().unwrap();
    let closed = draft(&room(folder.path(), 1.0, 0), &options(folder.path())).unwrap();
    assert!(matches!(lamps(&closed)[..], [Lamp::Panel(_)]));
    assert_eq!(closed.pipeline.units, Units::Photometric);
    assert!(closed.choices[1].doubt.contains("no openings, so a lamp was added"), "{:?}", closed.choices);

    let folder = tempfile::tempdir().unwrap();
    let open = draft(&room(folder.path(), 1.0, 1), &options(folder.path())).unwrap();
    assert!(matches!(lamps(&open)[..], [Lamp::Sky(_)]));
    assert!(open.choices[1].doubt.contains("a lamp would be `Light([Panel("), "{:?}", open.choices);
}

#[test]
fn lengths_are_in_meters_after_a_scale() {
    let folder = tempfile::tempdir().unwrap();
    let in_meters = lamps(&draft(&room(folder.path(), 1.0, 0), &options(folder.path())).unwrap());
    let other = tempfile::tempdir().unwrap();
    let drafted = draft(&room(other.path(), 1000.0, 0), &options(other.path())).unwrap();
    assert_eq!(lamps(&drafted), in_meters);
    assert!(drafted.choices[0].set.contains("scale: 0.001"), "{:?}", drafted.choices);
}

#[test]
fn the_same_scene_gives_the_same_pipeline_which_runs() {
    let folder = tempfile::tempdir().unwrap();
    let scene = room(folder.path(), 1.0, 0);
    let options = DraftOptions { out: None, ..options(folder.path()) };
    let [first, second] = [0; 2].map(|_| draft(&scene, &options).unwrap());
    assert_eq!(first.pipeline.text, second.pipeline.text);
    assert_eq!([&first, &second].map(|d| d.directory.file_name().unwrap()), ["room", "room-2"]);

    // The goal is soon reached in a room of 20,000 patches.
    let run = RunOptions { out: Some(first.directory.clone()), ..RunOptions::default() };
    let result = run_pipeline(&first.pipeline, &run).unwrap();
    let kinds: Vec<&str> = result.report.outputs.iter().map(|output| output.kind.as_str()).collect();
    assert_eq!(kinds, ["report", "image", "gltf"]);
    let again = draft(&scene, &DraftOptions { out: Some(first.directory), ..options });
    assert!(matches!(again, Err(Error::Exists { .. })), "{again:?}");
}

#[test]
fn an_edited_pipeline_is_not_replaced() {
    let folder = tempfile::tempdir().unwrap();
    let scene = room(folder.path(), 1.0, 0);
    let options = options(folder.path());
    let drafted = draft(&scene, &options).unwrap();
    let path = drafted.directory.join(PIPELINE_FILE);
    // The same draft again is no loss.
    draft(&scene, &options).unwrap();
    let edited = drafted.pipeline.text.replace("power: 10_000", "power: 20_000");
    fs::write(&path, &edited).unwrap();
    let refused = draft(&scene, &options);
    assert!(matches!(refused, Err(Error::OtherPipeline { .. })), "{refused:?}");
    assert_eq!(fs::read_to_string(&path).unwrap(), edited);
    draft(&scene, &DraftOptions { force: true, ..options }).unwrap();
    assert_eq!(fs::read_to_string(&path).unwrap(), drafted.pipeline.text);
}

#[test]
fn what_is_no_scene_leaves_nothing_behind() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("room.ron"), "()").unwrap();
    fs::write(folder.path().join("empty.glb"), "").unwrap();
    for name in ["room.ron", "empty.glb", "missing.obj", "picture.png", "."] {
        let refused = draft(&folder.path().join(name), &options(folder.path()));
        assert!(refused.is_err(), "{name}");
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
}

#[test]
fn names_in_the_file_cannot_break_the_pipeline() {
    let folder = tempfile::tempdir().unwrap();
    let scene = room(folder.path(), 1.0, 0);
    // A ground that gets a focus, whose comment has the name.
    let ground = "o \"x\\ */ //\u{1b}[0m\u{85}Load(\nv -900 -1 -900\nv -900 -1 900\nv 900 -1 900\nv 900 -1 -900\nf -4 -3 -2 -1\n";
    let text = fs::read_to_string(&scene).unwrap() + ground;
    let named = folder.path().join("a \"room\" \\ № 1.obj");
    fs::write(&named, text).unwrap();
    let drafted = draft(&named, &options(folder.path())).unwrap();
    assert!(drafted.pipeline.stages.iter().any(|stage| matches!(stage.action, Action::Focus(_))));
    Pipeline::read(&drafted.directory.join(PIPELINE_FILE)).unwrap();
}
