//! Errors of writing, reading and comparing results.

use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

/// Error of writing, reading or comparing a file.
#[derive(Debug, Error)]
pub enum ViewError {
    /// The file system reports an error.
    #[error("cannot {what} {}: {source}", path.display())]
    Io {
        /// Operation: `read` or `write`.
        what: &'static str,
        /// Path of the file.
        path: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },
    /// A picture has no pixels, or more than its file format can hold.
    #[error("cannot make a picture of {width} × {height} pixels (each side must be from 1 to 65535)")]
    PictureSize {
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
    },
    /// A mesh exceeds the 4 GiB limit of a GLB file.
    #[error("{} would have {bytes} bytes (a GLB file cannot exceed 4 GiB); use fewer patches", path.display())]
    TooLarge {
        /// Path of the file.
        path: PathBuf,
        /// Size that the file would have \[bytes\].
        bytes: u64,
    },
    /// A file is not a per-patch table.
    #[error("{} is not a table of patches: {why}", path.display())]
    NotATable {
        /// Path of the file.
        path: PathBuf,
        /// The problem, and the expected contents.
        why: String,
    },
    /// A row of a table cannot be read.
    #[error("{}, row {row}, column {column}: {why}", path.display())]
    BadValue {
        /// Path of the file.
        path: PathBuf,
        /// Number of the row, from 1, without the header.
        row: usize,
        /// Name of the column.
        column: String,
        /// The problem.
        why: String,
    },
    /// Two tables do not describe the same patches.
    #[error(
        "the tables cannot be compared: {why}; both must be tables of the same parts of the same scene, such as its patches"
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
