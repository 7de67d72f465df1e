//! Errors of this crate.

use std::path::PathBuf;

use sir_geom::SceneError;
use thiserror::Error;

/// Reason why a scene cannot be built or written.
#[derive(Debug, Error)]
pub enum Error {
    /// The parameters do not give a valid scene.
    #[error("the scene cannot be built from these parameters: {0}")]
    Scene(#[from] SceneError),
    /// The file cannot be written.
    #[error("{} cannot be written ({source}); check that its folder exists and is writable", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// Error of the operating system.
        source: std::io::Error,
    },
    /// The file name has neither of the two extensions of glTF.
    #[error("{} ends in neither .gltf nor .glb; name it .gltf for readable text or .glb for a small file", path.display())]
    Extension {
        /// The file.
        path: PathBuf,
    },
    /// A coordinate is not finite as a 32-bit float.
    #[error("vertex {vertex} at {position:?} cannot be stored in glTF's 32-bit floats; scale the scene down")]
    Position {
        /// Index of the vertex.
        vertex: usize,
        /// Position of the vertex.
        position: [f64; 3],
    },
}
