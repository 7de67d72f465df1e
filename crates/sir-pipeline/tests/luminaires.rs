//! Luminaires of a pipeline: their place, their light, and error messages.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use std::fs;
use std::path::Path;

use glam::DVec3;
use sir_geom::{LightKind, Rgb, Scene, luminance};
use sir_pipeline::NoProgress;
use sir_pipeline::check::estimate;
use sir_pipeline::fingerprint::of_scene;
use sir_pipeline::plan::Pipeline;
use sir_pipeline::prepare::{Prepared, prepare};

/// Intensities along the axes of the luminaire of [`files`]: −z (its aim), +z, +x (its length), −x, +y, −y.
const AIM: f64 = 400.0;
const BACK: f64 = 150.0;
const LENGTH: f64 = 900.0;
const OTHER_END: f64 = 250.0;
const LEFT: f64 = 500.0;
const RIGHT: f64 = 100.0;

/// Returns an IES file of type C with these intensities.
fn ies(tilt: &str, sizes: &str) -> String {
    let planes = [LENGTH, LEFT, OTHER_END, RIGHT, LENGTH].map(|side| format!("{AIM} {side} {BACK}"));
    format!(
        "IESNA:LM-63-2002\n[LUMINAIRE] Axes\nTILT={tilt}\n1 -1 1 3 5 1 2 {sizes}\n1 1 30\n0 90 180\n0 90 180 270 360\n{}\n",
        planes.join("\n")
    )
}

/// Writes a floor with y up, a dark floor whose lamp shows that z is up, and photometric files.
fn files(folder: &Path) {
    let write = |name: &str, text: &str| fs::write(folder.join(name), text).unwrap();
    write("floor.obj", "v -9 -5 -9\nv -9 -5 9\nv 9 -5 9\nv 9 -5 -9\nf 1 2 3 4\n");
    write(
        "hall.obj",
        "mtllib hall.mtl\nv -9 -9 -5\nv 9 -9 -5\nv 9 9 -5\nv -9 9 -5\nusemtl floor\nf 1 2 3 4\n\
         v 0 0 4\nv 0 1 4\nv 1 1 4\nv 1 0 4\nusemtl lamp\nf 5 6 7 8\n",
    );
    write("hall.mtl", "newmtl floor\nKd .5 .5 .5\nnewmtl lamp\nKd 0 0 0\nKe 1 1 1\n");
    write("axes.ies", &ies("NONE", "0 0 0"));
    write("panel.ies", &ies("NONE", "0.3 1.2 0"));
    write("tilting.ies", &ies("INCLUDE\n1\n3\n0 90 180\n1 0.5 0.25", "0 0 0"));
    write("other.ies", &ies("NONE", "0 0 0").replacen("400", "401", 1));
    write("text.ies", "not a photometric file\n");
}

/// Reads a pipeline with a luminaire in a folder with all files, and prepares its scene. The error has all messages.
fn try_prepare(load: &str, luminaire: &str) -> Result<Prepared, String> {
    let folder = tempfile::tempdir().unwrap();
    files(folder.path());
    let text = format!(
        "(units: Photometric, stages: [Load({load}),\nLight([Luminaire({luminaire})]),\nFirstShot(lines: 1000)])"
    );
    let plain = |text: String| text.replace(&format!("{}/", folder.path().display()), "");
    let pipeline =
        Pipeline::parse(&text, &folder.path().join("x.ron")).map_err(|error| plain(error.to_string()))?;
    prepare(&pipeline, &NoProgress).map_err(|error| plain(error.chain()))
}

fn scene_of(load: &str, luminaire: &str) -> Scene {
    try_prepare(load, luminaire).unwrap_or_else(|error| panic!("{error}")).model.scene
}

/// Returns the scene with a luminaire at the origin, y up.
fn scene(luminaire: &str) -> Scene {
    scene_of("path: \"floor.obj\"", &format!("position: (0, 0, 0), {luminaire}"))
}

/// Returns the luminous intensity of a point light in a direction.
fn candela(kind: &LightKind, direction: DVec3) -> f64 {
    match kind {
        LightKind::Point { intensity, spread, .. } => luminance(*intensity) * spread.share(direction),
        LightKind::Distant { .. } => panic!("{kind:?}"),
    }
}

/// Checks the intensities along axes of the world.
#[track_caller]
fn assert_axes(scene: &Scene, expected: &[(DVec3, f64)]) {
    let kind = &scene.lights()[0].kind;
    for &(direction, intensity) in expected {
        let found = candela(kind, direction);
        assert!((found / intensity - 1.0).abs() < 1e-9, "{direction}: {found} cd, not {intensity}");
    }
}

/// Returns the luminous flux per band of all sources of a scene with a luminaire at the origin, y up.
fn flux(luminaire: &str) -> Rgb {
    let luminaire = format!("position: (0, 0, 0), {luminaire}");
    let prepared = try_prepare("path: \"floor.obj\"", &luminaire).unwrap_or_else(|error| panic!("{error}"));
    prepared.sources.iter().map(|source| source.power).sum()
}

const X: DVec3 = DVec3::X;
const Y: DVec3 = DVec3::Y;
const Z: DVec3 = DVec3::Z;

#[test]
fn a_luminaire_is_aimed_down_and_turned_counterclockwise_seen_from_above() {
    let file = "file: \"axes.ies\"";
    // With y up, counterclockwise seen from above is from +x to −z.
    assert_axes(&scene(file), &[(-Y, AIM), (Y, BACK), (X, LENGTH), (-X, OTHER_END), (-Z, LEFT), (Z, RIGHT)]);
    assert_axes(
        &scene(&format!("{file}, rotate: 90")),
        &[(-Y, AIM), (-Z, LENGTH), (Z, OTHER_END), (-X, LEFT), (X, RIGHT)],
    );
    let between = DVec3::new(0.75f64.sqrt(), 0.0, -0.5);
    assert_axes(&scene(&format!("{file}, rotate: 30")), &[(between, LENGTH)]);
    assert_axes(&scene(&format!("{file}, rotate: -90")), &[(Z, LENGTH)]);
    // With z up it is from +x to +y.
    for load in ["path: \"floor.obj\", up: (0, 0, 1)", "path: \"hall.obj\""] {
        let scene = |rest: &str| scene_of(load, &format!("{file}, position: (0, 0, 0){rest}"));
        assert_axes(
            &scene(""),
            &[(-Z, AIM), (Z, BACK), (X, LENGTH), (-X, OTHER_END), (Y, LEFT), (-Y, RIGHT)],
        );
        assert_axes(&scene(", rotate: 90"), &[(-Z, AIM), (Y, LENGTH), (-X, LEFT)]);
    }
    let x_up = scene_of("path: \"floor.obj\", up: (1, 0, 0)", &format!("{file}, position: (0, 0, 0)"));
    assert_axes(&x_up, &[(-X, AIM), (Y, LENGTH), (Z, LEFT)]);
}

#[test]
fn a_luminaire_is_aimed_along_a_direction_or_at_a_point() {
    let file = "file: \"axes.ies\"";
    for aim in ["aim: (3, 0, 0)", "target: (2, 0, 0)"] {
        let aimed = scene(&format!("{file}, {aim}"));
        assert_axes(&aimed, &[(X, AIM), (-X, BACK), (Y, LENGTH), (-Z, LEFT)]);
        // From behind, looking along +x, −z is on the left.
        assert_axes(&scene(&format!("{file}, {aim}, rotate: 90")), &[(X, AIM), (-Z, LENGTH)]);
    }
    assert_axes(&scene(&format!("{file}, aim: (0, 1, 0)")), &[(Y, AIM), (X, LENGTH), (Z, LEFT)]);
    let oblique = DVec3::new(1.0, -2.0, 2.0) / 3.0;
    assert_axes(&scene(&format!("{file}, aim: (1, -2, 2), rotate: 17")), &[(oblique, AIM), (-oblique, BACK)]);
}

#[test]
fn an_array_has_rows_and_columns() {
    let lit = scene(
        "file: \"axes.ies\", columns: 3, column_step: (1, 0, 0), rows: 2, row_step: (0, 0, 2), target: (0, -4, 0)",
    );
    let position = |kind: &LightKind| match kind {
        LightKind::Point { position, .. } => *position,
        LightKind::Distant { .. } => panic!("{kind:?}"),
    };
    let positions: Vec<DVec3> = lit.lights().iter().map(|light| position(&light.kind)).collect();
    let expected: Vec<DVec3> =
        [0.0, 2.0].iter().flat_map(|&z| [0.0, 1.0, 2.0].map(|x| DVec3::new(x, 0.0, z))).collect();
    assert_eq!(positions, expected);
    for light in lit.lights() {
        let towards = (DVec3::new(0.0, -4.0, 0.0) - position(&light.kind)).normalize();
        assert!((candela(&light.kind, towards) / AIM - 1.0).abs() < 1e-9, "{:?}", light.kind);
        assert_eq!(light.name, "axes");
    }
}

#[test]
fn the_flux_is_that_of_the_file_times_all_factors() {
    let of = |rest: &str| flux(&format!("file: \"axes.ies\"{rest}"));
    // Per octant (π/2 − 1) P + (A + B)/2, with the intensity P at the pole.
    let sides = LENGTH + LEFT + OTHER_END + RIGHT;
    let all = 4.0 * (0.5 * std::f64::consts::PI - 1.0) * (AIM + BACK) + 2.0 * sides;
    for (rest, expected) in [
        ("", all),
        (", dimming: 0.5, maintenance: 0.8", 0.4 * all),
        (", flux: 3600", 3600.0),
        (", flux: 3600, dimming: 0.5, maintenance: 0.8", 1440.0),
        (", color: (0.2, 0.1, 0)", all),
        (", temperature: 2700", all),
        (", temperature: 20000, flux: 100", 100.0),
        (", columns: 2, column_step: (1, 0, 0), rows: 3, row_step: (0, 0, 1)", 6.0 * all),
    ] {
        let found = luminance(of(rest));
        assert!((found / expected - 1.0).abs() < 1e-9, "{rest}: {found} lm, not {expected} lm");
    }
    let [warm, cold] = [", temperature: 2700", ", temperature: 20000"].map(of);
    assert!(warm.x > warm.z && cold.x < cold.z, "{warm} {cold}");
    let colored = of(", color: (0.2, 0.1, 0)");
    assert!((colored.x / colored.y - 2.0).abs() < 1e-12 && colored.z == 0.0, "{colored}");
}

/// The opening of 1.2 × 0.3 m is a black rectangle with its length along x.
#[test]
fn light_comes_from_the_opening_of_the_file() {
    let panel = "file: \"panel.ies\", opening: FromFile, rotate: 90, color: (2, 1, 1)";
    let lit = scene(panel);
    assert!(lit.lights().is_empty());
    // Of its two faces, one shines down and one up.
    let faces: Vec<_> = lit.materials().iter().filter(|material| material.beam.is_some()).collect();
    assert!(
        faces.len() == 2 && faces.iter().all(|face| face.name == "panel" && face.reflectance == Rgb::ZERO)
    );
    let is_lit = |triangle| lit.material(triangle).beam.is_some();
    let corners: Vec<DVec3> = lit
        .triangle_ids()
        .filter(|&triangle| is_lit(triangle))
        .flat_map(|triangle| lit.corners(triangle))
        .collect();
    let extent = corners.iter().fold(DVec3::ZERO, |extent, corner| extent.max(corner.abs()));
    assert!(extent.abs_diff_eq(DVec3::new(0.15, 0.0, 0.6), 1e-12), "{extent}");
    let point = luminance(flux("file: \"panel.ies\""));
    assert!((luminance(flux(panel)) / point - 1.0).abs() < 1e-9);
}

#[test]
fn lamps_that_depend_on_their_tilt_are_dimmed() {
    let of = |aim: &str| luminance(flux(&format!("file: \"tilting.ies\"{aim}")));
    let upright = of("");
    for (aim, factor) in [
        (", aim: (1, 0, 0)", 0.5),
        (", aim: (1, -1, 0)", 0.75),
        (", aim: (0, 1, 0)", 0.25),
        (", rotate: 40", 1.0),
    ] {
        assert!((of(aim) / upright / factor - 1.0).abs() < 1e-9, "{aim}");
    }
}

#[test]
fn mistakes_have_one_message_each() {
    let mut all = String::new();
    for luminaire in [
        "position: (0, 1, 0)",
        "file: \"none.ies\", position: (0, 1, 0)",
        "file: \"text.ies\", position: (0, 1, 0)",
        "file: \".\", position: (0, 1, 0)",
        "file: \"axes.ies\"",
        "file: \"axes.ies\", position: (0, 1, 0), aim: (1, 0, 0), target: (0, 0, 0)",
        "file: \"axes.ies\", position: (0, 1, 0), aim: (0, 0, 0)",
        "file: \"axes.ies\", position: (0, 1, 0), target: (0, 1, 0)",
        "file: \"axes.ies\", position: (0, 1, 0), color: (1, 1, 1), temperature: 3000",
        "file: \"axes.ies\", position: (0, 1, 0), color: (0, 0, 0)",
        "file: \"axes.ies\", position: (0, 1, 0), temperature: 1000",
        "file: \"axes.ies\", position: (0, 1, 0), columns: 3",
        "file: \"axes.ies\", position: (0, 1, 0), rows: 0",
        "file: \"axes.ies\", position: (0, 1, 0), opening: FromFile",
        "file: \"axes.ies\", position: (0, 1, 0), opening: Sphere",
        "file: \"axes.ies\", position: (0, 1, 0), dimming: 1.5",
        "file: \"axes.ies\", position: (0, 1, 0), maintenance: 0",
        "file: \"axes.ies\", position: (0, 1, 0), flux: 0",
        "file: \"axes.ies\", position: (0, 1, 0), intensity: 5",
        "file: \"axes.ies\", position: (0, 1, 0), dim: 0.5",
        "file: \"axs.ies\", position: (0, 1, 0)",
        "file: \"axes.ies\", position: (0, 1, 0), rows: 2, row_step: (0, 0, 1), column_step: (1, 0, 0)",
        "file: \"axes.ies\", position: (0, 1, 0), columns: 10000, rows: 10000, column_step: (1, 0, 0), row_step: (0, 0, 1)",
    ] {
        let message = try_prepare("path: \"floor.obj\"", luminaire).unwrap_err();
        assert_eq!(message.matches("error: ").count(), 1, "{luminaire}: {message}");
        all += &format!("{message}\n");
    }
    // All light is turned off.
    let dark = "file: \"axes.ies\", position: (0, 1, 0), dimming: 0";
    all += &try_prepare("path: \"floor.obj\"", dark).unwrap_err();
    all += &try_prepare("path: \"floor.obj\"", &format!("{dark}, group: \"desk\"")).unwrap_err();
    all += &try_prepare("path: \"hall.obj\"", &format!("{dark}, group: \"desk\"")).unwrap_err();
    insta::assert_snapshot!(all);
}

#[test]
fn many_luminaires_are_counted_in_the_memory() {
    let folder = tempfile::tempdir().unwrap();
    files(folder.path());
    let peak = |rest: &str| {
        let text = format!(
            "(units: Photometric, stages: [Load(path: \"floor.obj\"), Light([Luminaire(file: \"panel.ies\", \
             position: (0, 0, 0), {rest})]), FirstShot(lines: 10)])"
        );
        let pipeline = Pipeline::parse(&text, &folder.path().join("x.ron")).unwrap();
        estimate(&pipeline, &NoProgress).unwrap().peak_memory
    };
    for (opening, least) in [("Point", 800_000), ("FromFile", 4 * 400_000)] {
        let array = format!("columns: 1000, column_step: (0.001, 0, 0), opening: {opening}");
        let more = peak(&array) - peak(&format!("opening: {opening}"));
        assert!((least..3 * least).contains(&more), "{opening}: {more} bytes");
    }
}

/// A luminaire above the ceiling or beside the room, unlike one that lights the scene from outside.
#[test]
fn luminaires_outside_of_the_scene_are_pointed_out() {
    let folder = tempfile::tempdir().unwrap();
    files(folder.path());
    // A floor, a ceiling 3 m above it, and a wall of 9 m beside them.
    let room =
        "v 0 0 0\nv 0 0 4\nv 6 0 4\nv 6 0 0\nf 1 2 3 4\nv 0 3 0\nv 6 3 0\nv 6 3 4\nv 0 3 4\nf 5 6 7 8\n";
    fs::write(folder.path().join("room.obj"), room).unwrap();
    let outside = |scene: &str, luminaire: &str| -> Vec<String> {
        let text = format!(
            "(units: Photometric, stages: [Load(path: \"{scene}.obj\"), Light([\
             Luminaire(file: \"axes.ies\", position: (3, 2, 2)), Luminaire({luminaire})]), FirstShot(lines: 10)])"
        );
        let pipeline = Pipeline::parse(&text, &folder.path().join("x.ron")).unwrap();
        let suspicions = prepare(&pipeline, &NoProgress).unwrap().suspicions;
        suspicions.into_iter().filter(|suspicion| suspicion.contains("outside of the scene,")).collect()
    };
    let one = outside("room", "file: \"axes.ies\", name: \"a\", position: (3, 3.2, 2)");
    assert_eq!(
        one,
        [
            "the luminaire \"a\" at (3, 3.2, 2) is outside of the scene, which extends from (0, 0, 0) to (6, 3, 4); is the \
          position right?"
        ]
    );
    for opening in ["Point", "FromFile"] {
        let array = "columns: 4, column_step: (1.5, 0, 0), rows: 2, row_step: (0, 0, 1)";
        let some = outside(
            "room",
            &format!("file: \"panel.ies\", position: (3, 2.9, 1.5), {array}, opening: {opening}"),
        );
        assert!(
            some.len() == 1
                && some[0]
                    .starts_with("2 of 8 luminaires \"panel\", the first at (7.5, 2.9, 1.5), are outside"),
            "{some:?}"
        );
    }
    for luminaire in [
        // At the ceiling, and at a wall.
        "file: \"axes.ies\", position: (3, 3, 2)",
        "file: \"axes.ies\", position: (0, 2, 2)",
        // A floodlight that is aimed into the open side of the scene.
        "file: \"axes.ies\", position: (3, 2.5, 8), target: (3, 0, 2)",
    ] {
        assert_eq!(outside("room", luminaire), [""; 0], "{luminaire}");
    }
    // Above a ground.
    assert_eq!(outside("floor", "file: \"axes.ies\", position: (3, 8, 2)"), [""; 0]);
}

/// The hash of a scene has the tables of its luminaires, but not by their text, which would be gigabytes.
#[test]
fn fingerprints_of_luminaires_are_different_and_cheap() {
    let of = |rest: &str| of_scene(&scene(rest));
    let first = of("file: \"axes.ies\"");
    assert_eq!(of("file: \"axes.ies\""), first);
    for other in [
        "file: \"axes.ies\", rotate: 1",
        "file: \"axes.ies\", name: \"b\"",
        "file: \"axes.ies\", dimming: 0.9",
        "file: \"other.ies\", name: \"axes\", flux: 1000",
    ] {
        assert_ne!(of(other), first, "{other}");
    }
    let same_flux = |file: &str| of(&format!("file: \"{file}.ies\", name: \"a\", flux: 1000"));
    assert_ne!(same_flux("other"), same_flux("axes"));
    for (file, opening) in [("axes", "Point"), ("panel", "FromFile")] {
        let many = scene(&format!(
            "file: \"{file}.ies\", opening: {opening}, columns: 40, column_step: (0.2, 0, 0), rows: 25, \
             row_step: (0, 0, 0.2), target: (0, -4, 0)"
        ));
        let text = format!("{:?} {:?}", many.lights(), many.materials());
        assert!(text.len() < 2_000_000, "{opening}: {} bytes", text.len());
        assert_ne!(of_scene(&many), first);
    }
}
