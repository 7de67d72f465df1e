//! File names in OBJ and MTL files.

use std::path::{Path, PathBuf};

use crate::load::files::beside_path;

/// Returns the path of a file that `scene` names; `None` if it is not in the scene's folder or below it. On Unix, names
/// are bytes in any encoding; elsewhere, they must be UTF-8.
///
/// Programs on Windows write `\` between folders. On other systems, it may also be a part of a name, or of a character
/// in some encodings of Chinese and Japanese, so the name as it is written comes first.
pub(super) fn find(scene: &Path, name: &[u8]) -> Option<PathBuf> {
    let name = unquoted(name);
    let as_written = || beside_path(scene, &path(name)).filter(|path| path.is_file());
    let found = if name.contains(&b'\\') { as_written() } else { None };
    let slashes: Vec<u8> = name.iter().map(|&byte| if byte == b'\\' { b'/' } else { byte }).collect();
    found.or_else(|| beside_path(scene, &path(&slashes)))
}

/// Returns a name without the quotes around it.
pub(super) fn unquoted(mut name: &[u8]) -> &[u8] {
    while let [b'"', rest @ ..] | [rest @ .., b'"'] = name {
        name = rest;
    }
    name
}

#[cfg(unix)]
fn path(name: &[u8]) -> PathBuf {
    use std::os::unix::ffi::OsStrExt as _;
    std::ffi::OsStr::from_bytes(name).into()
}

#[cfg(not(unix))]
fn path(name: &[u8]) -> PathBuf {
    crate::load::obj::text::shown(name).into()
}
