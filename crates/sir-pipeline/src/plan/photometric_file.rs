//! Photometric files of luminaires.

use std::io::ErrorKind;
use std::path::PathBuf;
use std::sync::Arc;

use sir_photometry::{Photometry, PhotometryError};

use crate::text::back_slashes::{path_help, printable};
use crate::text::field::Format;
use crate::text::formats::{Text, quoted};
use crate::text::paths::similar_file;
use crate::text::reader::Reader;
use crate::text::ron_tree::Node;

/// Photometric file. It is read together with the pipeline, so that its errors are reported as problems of the pipeline.
#[derive(Clone, Debug, PartialEq)]
pub struct PhotometricFile {
    /// Path of the file: the path in the pipeline, joined to the folder of the pipeline file.
    pub path: PathBuf,
    /// Contents of the file.
    pub contents: Arc<Photometry>,
}

impl PhotometricFile {
    /// Returns the name of the file without its extension.
    #[must_use]
    pub fn stem(&self) -> String {
        self.path.file_stem().unwrap_or_default().to_string_lossy().into_owned()
    }
}

/// Format of the path of a photometric file.
#[derive(Clone, Copy)]
pub(crate) struct Photometric;

impl Photometric {
    const TEXT: Text = Text("downlight.ies");
}

impl Format for Photometric {
    type Value = PhotometricFile;

    fn read<'a>(&self, reader: &mut Reader<'a>, node: &Node<'a>, name: &str) -> Option<PhotometricFile> {
        let text = Self::TEXT.read(reader, node, name)?;
        let path = reader.folder.join(text);
        match Photometry::read(&path) {
            Ok(contents) => Some(PhotometricFile { path, contents: Arc::new(contents) }),
            Err(error) => {
                let is_missing = matches!(
                    &error,
                    PhotometryError::Read { source, .. } if source.kind() == ErrorKind::NotFound
                );
                let similar = is_missing.then(|| similar_file(&path)).flatten();
                // Without the path, which the message has already.
                let why = match error {
                    PhotometryError::Read { source, .. } => source.to_string(),
                    PhotometryError::InFile { problem, .. } => problem.to_string(),
                    other => other.to_string(),
                };
                let message = format!("cannot read the photometric file {}: {why}", printable(&path));
                let help = "use an IES (LM-63) or EULUMDAT file; paths are relative to the folder of the pipeline file";
                reader.problem(node.text, message, path_help(node.text, similar.as_deref().unwrap_or(help)));
                None
            }
        }
    }

    fn write(&self, value: &PhotometricFile) -> String {
        quoted(&value.path.to_string_lossy())
    }

    fn describe(&self) -> String {
        "string".into()
    }

    fn example(&self) -> String {
        Self::TEXT.example()
    }
}
