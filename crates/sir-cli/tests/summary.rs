//! The summary that `sir run` prints.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::path::Path;

use sir_cli::summary::summary;
use sir_pipeline::{RunOptions, run};

/// Lights the furnace by a pipeline with these fields of `Multipath` and these stages after it. Returns the summary and
/// the surface of the domain \[m²\].
fn shown(fields: &str, stages: &str) -> (String, f64) {
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/furnace/furnace.gltf");
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("furnace.ron");
    std::fs::copy(scene, folder.path().join("furnace.gltf")).unwrap();
    let text = format!(
        "(units: Photometric, stages: [Load(path: \"furnace.gltf\"), FirstShot(lines: 2_000), \
         Multipath(lines: 20_000{fields}), {stages}])"
    );
    std::fs::write(&path, text).unwrap();
    let options = RunOptions { out: Some(folder.path().join("out")), ..RunOptions::default() };
    let result = run(&path, &options).unwrap();
    let lines = result.report.stages[2].lines.as_ref().unwrap();
    (summary(&result), lines.domain.as_ref().unwrap().surface)
}

#[test]
fn the_domain_of_global_lines_is_named() {
    for (fields, name) in [
        ("", "hull"),
        (", domain: Box", "box"),
        (", domain: Sphere, transport: Replicas(count: 2)", "sphere"),
    ] {
        let (shown, surface) = shown(fields, "");
        let expected = format!("20_000 lines through the {name} ({surface:.6} m²) in ");
        assert!(shown.contains(&expected), "{shown}");
    }
}

#[test]
fn sensors_are_summed_up() {
    let points =
        "Sensors(name: \"desk\", at: Points([(position: (0.1, 0.1, 0.1), direction: (0, 1, 0))]), rays: 100)";
    let (shown, _) = shown("", points);
    assert!(shown.contains("desk: 1 points, mean ") && shown.contains(" lx, minimum "), "{shown}");
}
