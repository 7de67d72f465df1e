//! Writes the project's scenes to a folder: `cargo run -p sir-scenes --example make_scenes [FOLDER]`.
//!
//! The default folder is `scenes` in the repository.

use std::{error::Error, fs, path::PathBuf};

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args_os()
        .nth(1)
        .map_or_else(|| PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes")), PathBuf::from);
    for stored in sir_scenes::stored()? {
        let path = folder.join(stored.path);
        if let Some(parent) = path.parent() {
            fs::create_dir_all(parent)?;
        }
        sir_scenes::write_gltf(&stored.scene, &path)?;
        eprintln!("{}: {} triangles", path.display(), stored.scene.triangles().len());
    }
    for stored in sir_scenes::stored_texts() {
        let path = folder.join(stored.path);
        fs::write(&path, stored.text)?;
        eprintln!("{}", path.display());
    }
    Ok(())
}
