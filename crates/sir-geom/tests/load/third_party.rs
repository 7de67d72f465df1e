//! Files by others, which are read where they are and are no part of the project.

use std::fs;
use std::path::{Path, PathBuf};

use sir_geom::{LoadError, LoadOptions, Scene, SceneError, Warning, load};

use crate::files::{chain, third_party_data};

fn files_below(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() { files_below(&path, found) } else { found.push(path) }
    }
}

#[test]
fn every_file_of_the_corpus_ends_with_a_scene_or_an_error() {
    let Some(data) = third_party_data() else { return };
    let mut files = Vec::new();
    files_below(&data.join("corpus"), &mut files);
    files.sort();
    let (mut loaded, mut refused, mut other) = (0, 0, 0);
    for file in &files {
        match load(file, &LoadOptions::default()) {
            Ok(_) => loaded += 1,
            Err(LoadError::UnknownFormat { .. }) => other += 1,
            Err(error) => {
                refused += 1;
                println!("{}", chain(&error));
            }
        }
    }
    println!("{loaded} files loaded, {refused} refused, {other} of other formats");
    assert!(loaded >= 45 && loaded + refused >= 200, "{loaded} loaded, {refused} refused");
}

/// A file that a validator finds no error in is refused only for what it does not hold.
#[test]
fn valid_gltf_files_are_refused_for_want_of_triangles_only() {
    let Some(data) = third_party_data() else { return };
    let mut files = Vec::new();
    files_below(&data.join("corpus/gltf-validator"), &mut files);
    let mut valid = 0;
    for report in files.iter().filter(|f| f.to_string_lossy().ends_with(".report.json")) {
        let json: serde_json::Value = serde_json::from_slice(&fs::read(report).unwrap()).unwrap();
        if json["issues"]["numErrors"] != 0 {
            continue;
        }
        valid += 1;
        let file = PathBuf::from(report.to_string_lossy().trim_end_matches(".report.json"));
        match load(&file, &LoadOptions::default()) {
            Ok(_)
            | Err(LoadError::Scene { source: SceneError::Empty { .. }, .. })
            | Err(LoadError::RequiredExtensions { .. }) => {}
            // Some have buffers without data, on purpose.
            Err(error) => assert!(chain(&error).contains("which has 0 bytes"), "{}", chain(&error)),
        }
    }
    assert!(valid > 50, "only {valid} valid files");
}

/// Triangles of the files, those without an area included, as their README counts them.
const TRIANGLES: [(&str, usize); 11] = [
    ("cornell-mcguire/CornellBox-Original.obj", 36),
    ("cornell-mcguire/CornellBox-Sphere.obj", 2_188),
    ("mgf-leuven-office/leuven-office.obj", 741),
    ("mgf-salon/salon.obj", 9_253),
    ("mgf-soda/soda.obj", 95_908),
    ("staircase/staircase.obj", 262_663),
    ("living-room-2/living-room-2.obj", 414_841),
    ("classroom/classroom.obj", 103_832),
    ("godot-room/room.glb", 63_720),
    ("game-maps/pandora/pandora.obj", 60_810),
    ("game-maps/turbine/turbine.obj", 3_064),
];

#[test]
fn scenes_have_as_many_triangles_as_their_readme_says() {
    let Some(data) = third_party_data() else { return };
    for (name, expected) in TRIANGLES {
        let built = load(&data.join("scenes").join(name), &LoadOptions::default()).unwrap();
        let dropped: u64 = built
            .warnings
            .iter()
            .map(|w| if let Warning::DroppedTriangles { count } = w { *count } else { 0 })
            .sum();
        assert_eq!(built.scene.triangles().len() + dropped as usize, expected, "{name}");
        assert!(built.warnings.len() < 12, "{name}: {:?}", built.warnings);
    }
}

/// Area and material of every triangle by its number in the file.
fn check_against_table(scene: &Scene, table: &str) -> usize {
    let rows: Vec<Vec<&str>> = table
        .lines()
        .filter(|line| !line.starts_with('#') && !line.starts_with("tri,"))
        .map(|line| line.split(',').collect())
        .collect();
    assert_eq!(rows.len(), scene.triangles().len());
    for t in scene.triangle_ids() {
        let source = scene.triangle(t).source as usize;
        let [number, material, area, ..] = rows[source][..] else { panic!("row {source}") };
        assert_eq!(number.parse::<usize>().unwrap(), source);
        assert_eq!(material, scene.material(t).name, "triangle {source}");
        // The tables state six digits.
        let expected: f64 = area.parse().unwrap();
        assert!((scene.area(t) / expected - 1.0).abs() < 1e-5, "triangle {source}: {} {area}", scene.area(t));
    }
    rows.len()
}

#[test]
fn triangles_have_the_order_of_the_reference_tables() {
    let Some(data) = third_party_data() else { return };
    for (name, expected) in [
        ("cornell-mcguire/CornellBox-Original.obj", 36),
        ("mgf-leuven-office/leuven-office.obj", 741),
        ("mgf-soda/soda.obj", 95_908),
    ] {
        let path = data.join("scenes").join(name);
        let scene = load(&path, &LoadOptions::default()).unwrap().scene;
        let table = fs::read_to_string(path.with_file_name("reference-radiosity.csv")).unwrap();
        assert_eq!(check_against_table(&scene, &table), expected, "{name}");
    }
}
