//! Back slashes in paths, as on Windows. In RON, they begin special characters.

use std::path::Path;

/// Hint about paths with back slashes.
pub(crate) const SLASHES: &str =
    "write `/` in paths, also on Windows: a back slash begins a special character";

/// Returns the hint for a path that cannot be used, as it is written in the file: what to do about its back slashes, or
/// else `help`.
pub(crate) fn path_help<'a>(written: &str, help: &'a str) -> &'a str {
    if written.contains('\\') { SLASHES } else { help }
}

/// Returns a path for a message. Control characters, such as those of back slashes, are replaced.
pub(crate) fn printable(path: &Path) -> String {
    path.display().to_string().replace(char::is_control, "\u{fffd}")
}
