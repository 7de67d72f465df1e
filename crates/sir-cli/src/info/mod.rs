//! `sir info`: what is in a scene, and what a pipeline should set to light it.

mod text;

use std::path::PathBuf;

use sir_pipeline::info::inspect;

use crate::error::CliError;

/// What to read, and how to tell it.
#[derive(Debug, clap::Args)]
pub struct InfoArgs {
    /// The scene: a .gltf, .glb or .obj file.
    pub scene: PathBuf,
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
}

/// Reads a scene; returns what there is to tell.
pub(crate) fn command(args: &InfoArgs) -> Result<String, CliError> {
    let info = inspect(&args.scene)?;
    Ok(if args.json { format!("{:#}\n", serde_json::json!(info)) } else { text::text(&info) })
}
