//! Distribution of patches in a pipeline with a focus.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use sir_pipeline::NoProgress;
use sir_pipeline::plan::Pipeline;
use sir_pipeline::prepare::prepare;

/// The floor of a pavilion is part of a ground of 200 × 200 m: nearly all patches are in the pavilion, and the floor
/// has its share of them.
#[test]
fn a_wide_ground_has_patches_in_the_focus_only() {
    let folder = tempfile::tempdir().unwrap();
    let quads = "v -100 0 -100\nv -100 0 100\nv 100 0 100\nv 100 0 -100\nf 1 2 3 4\n\
                 v -1 2 -1\nv 1 2 -1\nv 1 2 1\nv -1 2 1\nf 5 6 7 8\n";
    std::fs::write(folder.path().join("field.obj"), quads).unwrap();
    let text = "(stages: [Load(path: \"field.obj\"), Light([Sky(horizontal: 1)]),
        Focus(min: (-1, 0, -1), max: (1, 2, 1)), Subdivide(patches: 1000), FirstShot(lines: 1000)])";
    let pipeline = Pipeline::parse(text, &folder.path().join("x.ron")).unwrap();
    let model = prepare(&pipeline, &NoProgress).unwrap().model;
    let (mut floor, mut roof, mut outside) = (0, 0, 0);
    for t in model.scene.triangle_ids() {
        let corners = model.scene.corners(t);
        let reach = corners.iter().map(|corner| corner.x.abs().max(corner.z.abs())).fold(0.0, f64::max);
        let mut patches = 0;
        model.mesh.for_each_piece_of(t, |_, _| patches += 1);
        match model.scene.triangle(t).source {
            0 | 1 if reach < 1.001 => floor += patches,
            0 | 1 => outside += patches,
            _ => roof += patches,
        }
    }
    assert!((400..=600).contains(&floor) && (400..=600).contains(&roof), "{floor} + {roof}");
    assert!(outside < 20, "{outside} patches outside");
}
