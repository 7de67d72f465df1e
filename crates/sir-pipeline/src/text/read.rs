//! Reading a pipeline file.

use std::io::Read as _;
use std::path::Path;

use crate::error::Error;
use crate::plan::pipeline::Pipeline;
use crate::text::decode;
use crate::text::diagnostic::{Diagnostic, Diagnostics};

/// The most bytes of a pipeline file. Thousands of outputs fit in.
const LONGEST: u64 = 1 << 18;

impl Pipeline {
    /// Reads the pipeline file `path`.
    ///
    /// # Errors
    ///
    /// All problems of the file, or why it cannot be read.
    pub fn read(path: &Path) -> Result<Self, Error> {
        let mut bytes = Vec::new();
        // Also what never ends can be given as a file.
        std::fs::File::open(path)
            .and_then(|file| file.take(LONGEST + 1).read_to_end(&mut bytes))
            .map_err(|source| Error::ReadPipeline { path: path.to_owned(), source })?;
        if bytes.len() as u64 > LONGEST {
            return Err(Error::LongPipeline { path: path.to_owned(), most: LONGEST });
        }
        let text = String::from_utf8(bytes).map_err(|_| Error::NotText { path: path.to_owned() })?;
        Ok(Self::parse(&text, path)?)
    }

    /// Reads the text of a pipeline file. Paths in it are relative to the folder of `path`.
    ///
    /// # Errors
    ///
    /// All problems of the text, each with its place and what to write instead. A missing input file is one.
    pub fn parse(text: &str, path: &Path) -> Result<Self, Diagnostics> {
        decode::decode(text, path)
    }

    /// Problems of this pipeline, ready to be shown.
    #[must_use]
    pub fn diagnostics(&self, problems: Vec<Diagnostic>) -> Diagnostics {
        Diagnostics::new(&self.path, &self.text, problems)
    }
}
