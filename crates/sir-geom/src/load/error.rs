//! Errors of reading a scene file.

use std::io;
use std::path::PathBuf;

use thiserror::Error;

use crate::error::SceneError;

/// Reason why a scene file cannot be read. Every message names the file, and what to do where that is not obvious.
#[derive(Debug, Error)]
pub enum LoadError {
    /// The extension of the file name is not supported.
    #[error("{}: unsupported type of file ({}); convert the scene to one of .gltf, .glb and .obj", path.display(), extension.as_ref().map_or("no extension".to_owned(), |e| format!("\".{e}\"")))]
    UnknownFormat {
        /// The scene file.
        path: PathBuf,
        /// Extension of its name, if any.
        extension: Option<String>,
    },
    /// The scene is a folder.
    #[error("{} is a folder; name the scene file in it", path.display())]
    Folder {
        /// The folder.
        path: PathBuf,
    },
    /// The reader for the format was disabled when the program was built.
    #[error("{}: the reader for this format is disabled; build sir-geom with the cargo feature `{feature}`", path.display())]
    WithoutReader {
        /// The scene file.
        path: PathBuf,
        /// The cargo feature.
        feature: &'static str,
    },
    /// The scene file is absent, is not a regular file, or cannot be read.
    #[error("cannot read the scene {}", path.display())]
    Read {
        /// The scene file.
        path: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },
    /// A file that the scene needs cannot be read.
    #[error("{}: {element} refers to the file {}, which cannot be read; add this file, or export the scene again", scene.display(), path.display())]
    Missing {
        /// The scene file.
        scene: PathBuf,
        /// Element of the scene file, such as `buffer 0`.
        element: String,
        /// File that the element refers to.
        path: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },
    /// The file violates glTF 2.0 in a part that the scene needs.
    #[error("{}: not valid glTF 2.0: {what}; check the file with a glTF validator, or export it again", path.display())]
    Gltf {
        /// The scene file.
        path: PathBuf,
        /// Element of the file, and what is wrong with it.
        what: String,
    },
    /// The file is of another version of glTF than 2.0, or needs a later one.
    #[error("{}: this is a file of glTF {version}, but only glTF 2.0 is supported; convert it to glTF 2.0, or export it again", path.display())]
    GltfVersion {
        /// The scene file.
        path: PathBuf,
        /// Version of the file, shortened if it is long.
        version: String,
    },
    /// The file requires extensions that are not supported.
    #[error("{}: the file requires the glTF extensions {}, which are not supported; export it without them", path.display(), names.join(", "))]
    RequiredExtensions {
        /// The scene file.
        path: PathBuf,
        /// Unsupported extensions among those required.
        names: Vec<String>,
    },
    /// The file refers to data in a place that is not accessed.
    #[error("{}: {element} refers to \"{uri}\": {why}; put the data into a file in the scene's folder, or embed it in the scene file", path.display())]
    Reference {
        /// The scene file.
        path: PathBuf,
        /// Element of the scene file, such as `buffer 0`.
        element: String,
        /// Reference, shortened if it is long.
        uri: String,
        /// Reason why it is not followed.
        why: String,
    },
    /// A line of an OBJ or MTL file is invalid.
    #[error("{}:{line}: {what}; correct this line, or export the file again", path.display())]
    Syntax {
        /// The OBJ or MTL file.
        path: PathBuf,
        /// Line number, from 1.
        line: usize,
        /// What is wrong with the line.
        what: String,
    },
    /// A face of an OBJ file refers to a vertex that does not exist.
    #[error("{}:{line}: a face refers to vertex {index}, but there are {count} vertices{}; export the file again", path.display(), if index.starts_with('-') { " before it" } else { "" })]
    NoSuchVertex {
        /// The OBJ file.
        path: PathBuf,
        /// Line number, from 1.
        line: usize,
        /// Vertex number as in the file.
        index: String,
        /// Number of vertices in the file or, if the vertex number is negative and so counts back, of those before the
        /// line.
        count: usize,
    },
    /// The file has more geometry than the limit.
    #[error("{}: the scene has more than {limit} {what} after its instances are expanded; remove or simplify parts of it", path.display())]
    TooLarge {
        /// The scene file.
        path: PathBuf,
        /// `vertices`, `triangles` or `mesh primitives`.
        what: &'static str,
        /// Maximum number.
        limit: usize,
    },
    /// The file can be read, but does not describe a scene.
    #[error("{}: no scene can be built from this file{}", path.display(), if skipped.is_empty() { String::new() } else { format!(" ({skipped})") })]
    Scene {
        /// The scene file.
        path: PathBuf,
        /// Summary of skipped geometry, if any: `4 mesh primitives of points or lines were skipped`.
        skipped: String,
        /// Reason why the scene cannot be built.
        source: SceneError,
    },
}
