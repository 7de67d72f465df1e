//! Why a scene file cannot be read.

use std::io;
use std::path::PathBuf;

use thiserror::Error;

use crate::error::SceneError;

/// Why a scene file cannot be read. Every message names the file and says what to do where that is not obvious.
#[derive(Debug, Error)]
pub enum LoadError {
    /// The extension of the file's name is none of those that are read.
    #[error("{}: the name ends in {}, but .gltf, .glb and .obj files are read; convert the scene to one of these", path.display(), extension.as_ref().map_or("no extension".to_owned(), |e| format!("\".{e}\"")))]
    UnknownFormat {
        /// The scene file.
        path: PathBuf,
        /// What its name ends in.
        extension: Option<String>,
    },
    /// The reader of the format was left out when the program was built.
    #[error("{}: the reader of this format is switched off; build sir-geom with the cargo feature `{feature}`", path.display())]
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
        /// What the operating system says.
        source: io::Error,
    },
    /// A file that the scene cannot do without cannot be read.
    #[error("{}: {element} is in the file {}, which cannot be read; put it there, or export the scene again", scene.display(), path.display())]
    Missing {
        /// The scene file.
        scene: PathBuf,
        /// The element of the file, such as `buffer 0`.
        element: String,
        /// The file that it refers to.
        path: PathBuf,
        /// What the operating system says.
        source: io::Error,
    },
    /// The file breaks the rules of glTF 2.0 in a part that a scene is made of.
    #[error("{}: not valid glTF 2.0: {what}; a glTF validator tells more, and exporting the file again often helps", path.display())]
    Gltf {
        /// The scene file.
        path: PathBuf,
        /// The element of the file, and what is wrong with it.
        what: String,
    },
    /// The file states that it makes no sense without extensions that are not known here.
    #[error("{}: the file requires the glTF extensions {}, which are not supported; export it without them", path.display(), names.join(", "))]
    RequiredExtensions {
        /// The scene file.
        path: PathBuf,
        /// The unknown extensions among those required.
        names: Vec<String>,
    },
    /// The file refers to data in a place that is not looked into.
    #[error("{}: {element} refers to \"{uri}\": {why}; put the data into a file beside the scene or into the scene itself", path.display())]
    Reference {
        /// The scene file.
        path: PathBuf,
        /// The element of the file, such as `buffer 0`.
        element: String,
        /// The reference, shortened if it is long.
        uri: String,
        /// Why it is not followed.
        why: String,
    },
    /// A line of an OBJ or MTL file has no meaning.
    #[error("{}:{line}: {what}; correct this line, or export the file again", path.display())]
    Syntax {
        /// The OBJ or MTL file.
        path: PathBuf,
        /// The line, from 1.
        line: usize,
        /// What is wrong with it.
        what: String,
    },
    /// A face of an OBJ file refers to a vertex that is not there.
    #[error("{}:{line}: a face refers to vertex {index}, but there are {count} vertices{}; export the file again", path.display(), if index.starts_with('-') { " before it" } else { "" })]
    NoSuchVertex {
        /// The OBJ file.
        path: PathBuf,
        /// The line, from 1.
        line: usize,
        /// The number as the file has it.
        index: String,
        /// How many vertices the file has, or, if the number is negative and so counts back, how many stand before
        /// the line.
        count: usize,
    },
    /// The file describes more geometry than is taken in.
    #[error("{}: the scene has more than {limit} {what} once its instances are laid out; leave out or simplify parts of it", path.display())]
    TooLarge {
        /// The scene file.
        path: PathBuf,
        /// `vertices`, `triangles` or `mesh primitives`.
        what: &'static str,
        /// How many are taken in.
        limit: usize,
    },
    /// The file could be read, but does not describe a scene.
    #[error("{}: no scene can be made of this file{}", path.display(), if skipped.is_empty() { String::new() } else { format!(", in which {skipped}") })]
    Scene {
        /// The scene file.
        path: PathBuf,
        /// What geometry was passed over, if any: `4 mesh primitives of points or lines were skipped`.
        skipped: String,
        /// What is wrong with it.
        source: SceneError,
    },
}
