//! What can go wrong when results are written and read back.

use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

/// Why a file cannot be written, read or compared.
#[derive(Debug, Error)]
pub enum ViewError {
    /// The file system refuses.
    #[error("cannot {what} {}: {source}", path.display())]
    Io {
        /// `read` or `write`.
        what: &'static str,
        /// The file.
        path: PathBuf,
        /// The reason that the system gives.
        source: io::Error,
    },
    /// A picture has no pixels, or more than its file format can hold.
    #[error("a picture of {width} × {height} pixels cannot be made (each side must be from 1 to 65535)")]
    PictureSize {
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
    },
    /// A mesh does not fit the 4 GiB of a GLB file.
    #[error("{} would have {bytes} bytes, but a GLB file cannot exceed 4 GiB: use fewer patches", path.display())]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// The size it would have.
        bytes: u64,
    },
    /// A file is not a per-patch table.
    #[error("{} is not a table of patches: {why}", path.display())]
    NotATable {
        /// The file.
        path: PathBuf,
        /// What is wrong with it, and what was expected.
        why: String,
    },
    /// A row of a table cannot be read.
    #[error("{}, row {row}, column {column}: {why}", path.display())]
    BadValue {
        /// The file.
        path: PathBuf,
        /// Number of the row, from 1, not counting the header.
        row: usize,
        /// Name of the column.
        column: String,
        /// What is wrong there.
        why: String,
    },
    /// Two tables do not describe the same patches.
    #[error(
        "the tables cannot be compared: {why}; both must be of the same scene, cut into the same patches"
    )]
    Mismatch {
        /// The first difference.
        why: String,
    },
}

impl ViewError {
    pub(crate) fn reading(path: &Path) -> impl FnOnce(io::Error) -> Self {
        move |source| Self::Io { what: "read", path: path.to_owned(), source }
    }

    pub(crate) fn writing(path: &Path) -> impl FnOnce(io::Error) -> Self {
        move |source| Self::Io { what: "write", path: path.to_owned(), source }
    }
}
