//! Output of the report's files.

use std::io::Write as _;
use std::path::Path;

use crate::error::StudyError;

/// Writes a text file atomically: whole or not at all.
pub(crate) fn write_file(path: &Path, text: &str) -> Result<(), StudyError> {
    sir_view::write_atomically(path, |file| file.write_all(text.as_bytes()))?;
    Ok(())
}
