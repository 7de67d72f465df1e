//! A program that embeds `sir`: it writes a pipeline, then checks and runs it with the commands of `sir`.
//!
//!     cargo run --release -p sir-cli --example own_command

use std::error::Error;
use std::ffi::OsStr;
use std::path::Path;
use std::process::ExitCode;

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/furnace/furnace.gltf");
    std::fs::copy(scene, folder.path().join("furnace.gltf"))?;
    let pipeline = folder.path().join("furnace.ron");
    let stages = r#"[Load(path: "furnace.gltf"), FirstShot(lines: 100_000), Multipath(lines: 100_000)]"#;
    std::fs::write(&pipeline, format!("Pipeline(stages: {stages})"))?;

    let checked = sir_cli::main_from([OsStr::new("sir"), OsStr::new("check"), pipeline.as_os_str()]);
    if checked != ExitCode::SUCCESS {
        return Ok(checked);
    }
    let out = folder.path().join("result");
    let options = ["--quiet", "--out"].map(OsStr::new);
    let command = [OsStr::new("sir"), OsStr::new("run"), pipeline.as_os_str()];
    Ok(sir_cli::main_from([&command[..], &options, &[out.as_os_str()]].concat()))
}
