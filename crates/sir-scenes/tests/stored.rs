//! The files in `scenes/` are the generator's output, and loading them gives the same scenes.

use std::{fs, path::PathBuf};

use sir_geom::{LoadOptions, Projection, TriangleId, load};
use sir_photometry::Photometry;
use sir_scenes::{DOWNLIGHT_FLUX, RECESSED_FLUX, Stored, TASK_FLUX, stored, stored_texts, write_gltf};

/// Relative precision of glTF's 32-bit floats.
const SINGLE: f64 = f32::EPSILON as f64;

fn committed(stored: &Stored) -> PathBuf {
    PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes")).join(stored.path)
}

#[test]
fn files_are_what_the_generator_makes() {
    let folder = tempfile::tempdir().unwrap();
    for stored in stored().unwrap() {
        let path = folder.path().join(committed(&stored).file_name().unwrap());
        write_gltf(&stored.scene, &path).unwrap();
        assert!(
            fs::read(&path).unwrap() == fs::read(committed(&stored)).unwrap(),
            "{} differs from the generator's output; run `cargo run -p sir-scenes --example make_scenes`",
            stored.path
        );
    }
}

#[test]
fn files_are_read_as_the_scenes_that_they_store() {
    for stored in stored().unwrap() {
        let (made, name) = (&stored.scene, stored.path);
        let read = load(&committed(&stored), &LoadOptions::default()).unwrap();
        assert_eq!(read.warnings, [], "{name}");
        let read = read.scene;

        assert_eq!(read.materials().len(), made.materials().len(), "{name}");
        for (a, b) in made.materials().iter().zip(read.materials()) {
            assert_eq!((&a.name, a.sides), (&b.name, b.sides), "{name}");
            assert!((a.opacity.factor - b.opacity.factor).abs() < SINGLE, "{name}: {a:?} {b:?}");
            assert!(a.reflectance.abs_diff_eq(b.reflectance, SINGLE), "{name}: {a:?} {b:?}");
            assert!(
                a.exitance.abs_diff_eq(b.exitance, 2.0 * SINGLE * a.exitance.length()),
                "{name}: {a:?} {b:?}"
            );
        }

        // A file groups triangles by material.
        let mut order: Vec<TriangleId> = made.triangle_ids().collect();
        order.sort_by_key(|t| made.triangle(*t).material);
        assert_eq!(read.triangles().len(), order.len(), "{name}");
        for (a, b) in order.into_iter().zip(read.triangle_ids()) {
            assert_eq!(made.material(a).name, read.material(b).name, "{name}");
            for (p, q) in made.corners(a).into_iter().zip(read.corners(b)) {
                assert!(p.abs_diff_eq(q, SINGLE * p.length()), "{name}: {p} {q}");
            }
        }
        assert!((read.total_area() / made.total_area() - 1.0).abs() < SINGLE, "{name}");

        assert_eq!(read.cameras().len(), made.cameras().len(), "{name}");
        for (a, b) in made.cameras().iter().zip(read.cameras()) {
            assert_eq!(a.name, b.name);
            assert!(a.eye.abs_diff_eq(b.eye, SINGLE * a.eye.length()), "{name}: {a:?} {b:?}");
            assert!(a.forward.abs_diff_eq(b.forward, 4.0 * SINGLE), "{name}: {a:?} {b:?}");
            let right = |c: &sir_geom::Camera| c.forward.cross(c.up).normalize();
            assert!(right(a).abs_diff_eq(right(b), 4.0 * SINGLE), "{name}: {a:?} {b:?}");
            let (f, g) = match (a.projection, b.projection) {
                (
                    Projection::Perspective { vertical_fov: f },
                    Projection::Perspective { vertical_fov: g },
                )
                | (Projection::Orthographic { height: f }, Projection::Orthographic { height: g }) => (f, g),
                _ => panic!("{name}: {a:?} {b:?}"),
            };
            assert!((f / g - 1.0).abs() < SINGLE, "{name}: {a:?} {b:?}");
            match (a.aspect, b.aspect) {
                (Some(f), Some(g)) => assert!((f - g).abs() < 2.0 * SINGLE, "{name}: {a:?} {b:?}"),
                (f, g) => assert_eq!(f, g, "{name}"),
            }
        }
    }
}

/// Because positions are rounded, storing and loading changes no coordinate.
#[test]
fn reading_room_comes_back_unchanged() {
    let all = stored().unwrap();
    let room = all.iter().find(|s| s.path.starts_with("reading-room")).unwrap();
    let read = load(&committed(room), &LoadOptions::default()).unwrap().scene;
    let sorted = |scene: &sir_geom::Scene| {
        let mut v: Vec<_> = scene.vertices().iter().map(|p| p.to_array()).collect();
        v.sort_by(|a, b| a.partial_cmp(b).unwrap());
        v
    };
    assert!(sorted(&read) == sorted(&room.scene));
}

#[test]
fn text_files_are_what_the_generator_makes() {
    for stored in stored_texts() {
        let path = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes")).join(stored.path);
        assert!(
            fs::read_to_string(&path).unwrap() == stored.text,
            "{} differs from the generator's output; run `cargo run -p sir-scenes --example make_scenes`",
            stored.path
        );
    }
}

/// The flux that a photometric file states is the integral of its intensities.
#[test]
fn photometric_files_have_the_flux_that_they_state() {
    let expected = [(RECESSED_FLUX, 30.0), (DOWNLIGHT_FLUX, 11.0), (TASK_FLUX, 6.0)];
    for (stored, (flux, watts)) in stored_texts().into_iter().zip(expected) {
        let file = Photometry::parse(stored.text.as_bytes()).unwrap();
        assert_eq!(file.warnings, Vec::<String>::new(), "{}", stored.path);
        assert_eq!(file.watts, Some(watts), "{}", stored.path);
        let integral = file.distribution.flux();
        assert!((integral / flux - 1.0).abs() < 0.001, "{}: {integral} lm", stored.path);
        for stated in [file.stated_flux, file.lamp_flux].into_iter().flatten() {
            assert!((integral / stated - 1.0).abs() < 0.001, "{}: {stated} lm", stored.path);
        }
    }
}

/// Means over the spectrum that lighting designers assume for an office.
#[test]
fn office_has_usual_reflectances() {
    let all = stored().unwrap();
    let office = all.iter().find(|s| s.path.starts_with("office")).unwrap();
    for (name, expected) in [("ceiling", 0.8), ("wall", 0.6), ("floor", 0.3), ("desk", 0.5)] {
        let material = office.scene.materials().iter().find(|m| m.name == name).unwrap();
        let luminance = material.reflectance.dot([0.2126, 0.7152, 0.0722].into());
        assert!((luminance - expected).abs() < 0.01, "{name}: {luminance}");
    }
}
