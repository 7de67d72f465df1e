//! Kinds of errors.

/// Kind of an error. It decides how a program reacts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ErrorKind {
    /// Wrong request: an invalid pipeline, an occupied directory, a run that cannot be resumed. The same request fails
    /// again.
    Usage,
    /// Failure of a file, of memory, of a computation or of another process.
    Failed,
    /// Stop on request.
    Interrupted,
}
