//! Validates pipeline files without running them. Prints all problems of each file, or its stages and outputs.
//!
//!     cargo run -p sir-pipeline --example check_pipelines -- FILE.ron …

use std::path::Path;
use std::process::ExitCode;

use sir_pipeline::plan::Pipeline;

#[allow(clippy::print_stdout, reason = "a program's output")]
fn main() -> ExitCode {
    let mut valid = true;
    for file in std::env::args().skip(1) {
        match Pipeline::read(Path::new(&file)) {
            Ok(pipeline) => {
                let stages: Vec<&str> = pipeline.stages.iter().map(|s| s.action.name()).collect();
                let outputs: Vec<String> =
                    pipeline.outputs().map(|o| o.path().display().to_string()).collect();
                println!("{file}: {}; writes {}", stages.join(", "), outputs.join(", "));
            }
            Err(error) => {
                valid = false;
                eprint!("{error}");
            }
        }
    }
    if valid { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
