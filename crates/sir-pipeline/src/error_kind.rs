//! What kinds of failure there are.

/// What kind of failure an error is. It decides what a program does next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ErrorKind {
    /// The request is wrong: a pipeline with mistakes, a directory that is taken, a run that cannot be resumed. The same request
    /// fails again.
    Usage,
    /// Something failed: a file, memory, a computation, another process.
    Failed,
    /// Someone asked to stop.
    Interrupted,
}
