//! Formats of photometric files.

use serde::Deserialize;

/// Format of a photometric file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum FileKind {
    IesC,
    IesB,
    IesA,
    Eulumdat,
}
