//! What can go wrong.

use std::path::PathBuf;

use sir_geom::SceneError;
use thiserror::Error;

/// Why a scene cannot be made or stored.
#[derive(Debug, Error)]
pub enum Error {
    /// The numbers asked for do not make a scene.
    #[error("the scene cannot be built from these numbers: {0}")]
    Scene(#[from] SceneError),
    /// The file cannot be written.
    #[error("{} cannot be written: {source}; check that its folder exists and may be written to", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// The name of the file does not say which form of glTF is meant.
    #[error("{} ends in neither .gltf nor .glb: name it .gltf for readable text or .glb for a small file", path.display())]
    Extension {
        /// The file.
        path: PathBuf,
    },
    /// A position is not a number that 32-bit floats can hold.
    #[error(
        "vertex {vertex} lies at {position:?}, which glTF's 32-bit floats cannot hold: scale the scene down"
    )]
    Position {
        /// Number of the vertex.
        vertex: usize,
        /// Where it lies.
        position: [f64; 3],
    },
}
