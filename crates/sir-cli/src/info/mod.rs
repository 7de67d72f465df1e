//! `sir info`: the contents of a scene, and suggested pipeline settings.

mod text;

use std::path::PathBuf;

use sir_pipeline::info::inspect;

use crate::error::CliError;

/// Arguments of `sir info`.
#[derive(Debug, clap::Args)]
pub struct InfoArgs {
    /// The scene: a .gltf, .glb or .obj file.
    pub scene: PathBuf,
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
}

/// Executes the command: reads the scene and returns the text to print.
pub(crate) fn command(args: &InfoArgs) -> Result<String, CliError> {
    let info = inspect(&args.scene)?;
    Ok(if args.json { format!("{:#}\n", serde_json::json!(info)) } else { text::text(&info) })
}
