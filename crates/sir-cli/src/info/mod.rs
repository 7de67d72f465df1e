//! `sir info`: what is in a scene, and what a pipeline should set to light it.

mod advice;
mod lines;
mod numbers;
mod shape;
mod text;

use std::path::PathBuf;

pub use advice::Setting;
pub use lines::{Fates, Global, Lines};
pub use numbers::{Group, Info, Lights, MaterialInfo, Textures, inspect};
pub use shape::{Dominant, Extent, Twins};

use crate::error::Error;

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
pub(crate) fn command(args: &InfoArgs) -> Result<String, Error> {
    let info = inspect(&args.scene)?;
    Ok(if args.json { format!("{:#}\n", serde_json::json!(info)) } else { text::text(&info) })
}
