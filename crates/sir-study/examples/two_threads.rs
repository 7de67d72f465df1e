//! Measures the speed-up of a small pipeline on two threads, and checks that one and two threads give the same result.
//!
//!     cargo run --release -p sir-study --example two_threads

#![allow(clippy::print_stdout, reason = "an example talks to its reader")]

use std::num::NonZeroUsize;
use std::path::Path;

use sir_pipeline::{NoProgress, RunOptions, run};
use sir_study::scaling::{Plan, measure, text};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = tempfile::tempdir()?;
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/furnace/furnace.gltf");
    std::fs::copy(scene, folder.path().join("furnace.gltf"))?;
    let path = folder.path().join("furnace.ron");
    let stages = r#"[Load(path: "furnace.gltf"), FirstShot(lines: 300_000), Multipath(lines: 300_000)]"#;
    std::fs::write(&path, format!("Pipeline(stages: {stages})"))?;

    let one = NonZeroUsize::MIN;
    let two = one.saturating_add(1);
    let plan = Plan::new(&[one], &[one, two], two);
    // `sir_study::scaling::scaling` starts the program `sir` for each run; here all runs share this process.
    let study = measure("furnace", sir_parallel::cores().get(), &plan, &NoProgress, &mut |workers| {
        let options = RunOptions {
            out: Some(folder.path().join("result")),
            force: true,
            threads: Some(workers.threads),
            ..RunOptions::default()
        };
        Ok(run(&path, &options)?.report)
    })?;
    print!("{}", text(&study));
    for row in &study.rows {
        println!("{}: {:.2} times as fast as one thread", row.workers, row.whole.speed_up);
    }
    Ok(())
}
