//! Third-party files, which are read in place and are not part of the project.

use std::fs;

use sir_geom::{LoadOptions, Scene, Warning, load};

use crate::files::third_party_data;

/// Numbers of triangles in the files, including those without an area, as counted in their README.
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
#[ignore = "needs third-party scenes: set SIR_TEST_DATA to their folder"]
fn scenes_have_as_many_triangles_as_their_readme_says() {
    let data = third_party_data();
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

/// Checks area and material of every triangle by its number in the file.
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
#[ignore = "needs third-party scenes: set SIR_TEST_DATA to their folder"]
fn triangles_have_the_order_of_the_reference_tables() {
    let data = third_party_data();
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
