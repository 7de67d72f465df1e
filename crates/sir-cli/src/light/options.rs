//! Options of `sir light`.

use std::path::PathBuf;

use sir_pipeline::draft::Goal;

use crate::how::HowArgs;
use crate::numbers::{minutes, per_cent};

/// Time for the light, unless another goal is given \[min\].
const MINUTES: f64 = 2.0;

/// Error at which the light is done, unless another goal is given.
const ERROR: f64 = 0.01;

/// Arguments of `sir light`.
#[derive(Debug, clap::Args)]
pub struct LightArgs {
    /// The scene: a .gltf, .glb or .obj file.
    pub scene: PathBuf,
    /// Time for the light in minutes. Without it and without --error: 2 minutes, or less if the error is 1 % before.
    ///
    /// Reading the scene and writing the files take additional time.
    #[arg(long, value_name = "M", value_parser = minutes)]
    pub minutes: Option<f64>,
    /// Relative error of a patch at which the light is done, such as 2%. With --minutes, the first of both ends the run.
    #[arg(long, value_name = "E%", value_parser = per_cent)]
    pub error: Option<f64>,
    /// Write the pipeline only; `sir run` runs it.
    #[arg(long)]
    pub dry_run: bool,
    /// Output directory; default: a new directory results/NAME, where NAME is the file name of the scene without extension.
    ///
    /// If that directory exists, results/NAME-2 is created, and so on. A directory given here is refused if it holds a
    /// result or another pipeline, unless --force is given.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Replace the result, the pipeline and files of the same names in the directory given with --out.
    #[arg(long, requires = "out")]
    pub force: bool,
    /// Options of the execution.
    #[command(flatten)]
    pub how: HowArgs,
}

/// Returns a time in seconds, rounded to milliseconds, so that a pipeline has few digits.
fn seconds(minutes: f64) -> f64 {
    (60_000.0 * minutes).round() / 1000.0
}

impl LightArgs {
    /// Returns when the run is done.
    pub(super) fn goal(&self) -> Goal {
        match (self.minutes, self.error) {
            (None, None) => Goal { relative_error: Some(ERROR), seconds: Some(60.0 * MINUTES) },
            (minutes, error) => Goal { relative_error: error, seconds: minutes.map(seconds) },
        }
    }

    /// Returns the command that drafts the same pipeline.
    pub(super) fn command(&self) -> String {
        // Not the path, which may be that of another machine or user.
        let name = self.scene.file_name().unwrap_or_default().to_string_lossy();
        let minutes = self.minutes.map_or(String::new(), |minutes| format!(" --minutes {minutes}"));
        let error = self.error.map_or(String::new(), |error| format!(" --error {}%", 100.0 * error));
        format!("sir light {name}{minutes}{error}")
    }
}
