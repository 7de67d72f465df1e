//! Runs a pipeline from Rust: checks it, runs it, and prints the errors of its stages and its output files.
//!
//!     cargo run --release -p sir-pipeline --example run_pipeline

#![allow(clippy::print_stdout, reason = "an example talks to its reader")]

use std::path::Path;
use std::sync::Arc;

use sir_pipeline::progress::{Meter, StageKind};
use sir_pipeline::{NoProgress, Progress, RunOptions, check, run};

/// Progress display that prints the name of each stage that traces lines.
#[derive(Debug)]
struct Names;

impl Progress for Names {
    fn begin(&self, title: &str, total: u64, _: StageKind) -> Box<dyn Meter> {
        println!("{title}: {total} lines");
        Box::new(NoProgress)
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // Output paths are relative to the run directory, input paths to the folder of the pipeline.
    let folder = tempfile::tempdir()?;
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/furnace/furnace.gltf");
    std::fs::copy(scene, folder.path().join("furnace.gltf"))?;
    let path = folder.path().join("furnace.ron");
    let text = r#"Pipeline(
        stages: [
            Load(path: "furnace.gltf"),
            Subdivide(patches: 1_000),
            FirstShot(lines: 100_000),
            Multipath(lines: 100_000),
            Save([Table(path: "patches.csv")]),
        ],
    )"#;
    std::fs::write(&path, text)?;

    let estimate = check(&path)?;
    println!(
        "{} patches, {} bytes at most",
        estimate.prepared.model.mesh.patch_count(),
        estimate.peak_memory
    );

    let options = RunOptions {
        out: Some(folder.path().join("result")),
        progress: Arc::new(Names),
        ..RunOptions::default()
    };
    let done = run(&path, &options)?;
    for stage in &done.report.stages {
        if let Some(light) = &stage.light {
            println!("{}: relative error {:?}", stage.name, light.relative_error);
        }
    }
    for output in &done.report.outputs {
        println!("{}: {}", output.kind, done.directory.join(&output.path).display());
    }
    Ok(())
}
