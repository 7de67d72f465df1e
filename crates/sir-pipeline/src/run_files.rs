//! Names of the files that a run keeps for itself in its directory. Outputs cannot have them.

/// Name of the report.
pub const REPORT: &str = "result.json";

/// Name of the checkpoint.
pub const CHECKPOINT: &str = "checkpoint";
