//! Errors.

use std::io;
use std::path::PathBuf;

use thiserror::Error;

/// Reason why a photometric file cannot be read. Lines and columns are counted from 1.
#[derive(Debug, Error)]
pub enum PhotometryError {
    /// The file is absent, is not a regular file, or cannot be read.
    #[error("cannot read the photometric file {}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },
    /// The file was read, but its contents have a problem.
    #[error("{}: {problem}", path.display())]
    InFile {
        /// The file.
        path: PathBuf,
        /// The problem.
        problem: Box<PhotometryError>,
    },
    /// The contents are of no format that is supported.
    #[error(
        "this is neither an IES LM-63 nor a EULUMDAT file ({why}); get the file from its maker as .ies or .ldt"
    )]
    UnknownFormat {
        /// What is missing, or what the file seems to be instead.
        why: &'static str,
    },
    /// The file ends too early.
    #[error("the file ends in line {line} before {what}; it may be incomplete: get it again")]
    End {
        /// Last line.
        line: usize,
        /// What should follow.
        what: String,
    },
    /// A value is invalid.
    #[error(
        "line {line}, column {column}: {what} is \"{found}\" (expected {expected}); correct it, or export the file again"
    )]
    Value {
        /// Line.
        line: usize,
        /// Character of the line.
        column: usize,
        /// Meaning of the value.
        what: String,
        /// Value, shortened if it is long.
        found: String,
        /// What it should be.
        expected: &'static str,
    },
    /// Angles do not cover the range that the format demands.
    #[error(
        "the {what} go from {}° to {}° (expected {expected}); correct them, or export the file again",
        short(*first),
        short(*last)
    )]
    Angles {
        /// Kind of angles.
        what: &'static str,
        /// First angle \[°\].
        first: f64,
        /// Last angle \[°\].
        last: f64,
        /// Ranges that the format allows.
        expected: &'static str,
    },
    /// A problem with a list or a table that begins in a line.
    #[error("line {line}: {problem}")]
    FromLine {
        /// Number of the line in which the list or table begins, from 1.
        line: usize,
        /// The problem.
        problem: Box<PhotometryError>,
    },
    /// The file has fewer sets of lamps than the option asks for.
    #[error("the file has {count} sets of lamps, but set {wanted} was asked for; choose one of them")]
    LampSet {
        /// Number of sets.
        count: usize,
        /// Number of the set that was asked for, from 1.
        wanted: usize,
    },
    /// The table of intensities is invalid.
    #[error("{problem}; correct the file, or export it again")]
    Table {
        /// The problem.
        problem: TableError,
    },
    /// A tilt file was read, but its contents have a problem.
    #[error("the tilt file \"{name}\": {problem}")]
    TiltFile {
        /// Name of the tilt file, shortened if it is long.
        name: String,
        /// The problem.
        problem: Box<PhotometryError>,
    },
}

/// Returns a number for a message; a tiny one would have hundreds of digits.
fn short(number: f64) -> String {
    if number != 0.0 && number.abs() < 1e-6 { format!("{number:e}") } else { number.to_string() }
}

impl PhotometryError {
    /// Returns a function that adds the line in which a list or table begins.
    pub(crate) fn from_line(line: usize) -> impl Fn(Self) -> Self {
        move |problem| Self::FromLine { line, problem: Box::new(problem) }
    }
}

/// Reason that a table is no distribution of intensity.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum TableError {
    /// The numbers of angles and values do not fit together.
    #[error(
        "a table of {azimuths} planes and {polars} polar angles needs at least one plane, two angles, and a value for each \
         pair, but there are {values} values"
    )]
    Size {
        /// Number of planes.
        azimuths: usize,
        /// Number of polar angles.
        polars: usize,
        /// Number of values.
        values: usize,
    },
    /// A number is infinite or not a number, or the flux is.
    #[error("a number of the table is not finite, or its flux is not")]
    NotFinite,
    /// Angles do not ascend.
    #[error("the angles of the table do not ascend")]
    Order,
    /// Angles are outside of their range.
    #[error("the planes of the table span more than 360°, or its polar angles are outside of 0 to 180°")]
    Range,
    /// An intensity is negative.
    #[error("the intensity {value} cd is negative")]
    Negative {
        /// The intensity \[cd\].
        value: f64,
    },
    /// All intensities are zero.
    #[error("all intensities are zero")]
    Dark,
}
