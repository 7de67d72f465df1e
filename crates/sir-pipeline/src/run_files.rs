//! Names of the files that a run keeps for itself in its directory. Outputs cannot have them.

/// Name of the report.
pub const REPORT: &str = "result.json";

/// Name of the checkpoint.
pub const CHECKPOINT: &str = "checkpoint";

/// Name of the lock file, which exists while a run uses the directory.
pub(crate) const LOCK: &str = ".lock";

/// Names that outputs cannot have.
pub(crate) const RESERVED: [&str; 3] = [REPORT, CHECKPOINT, LOCK];
