//! Files of scenes, and what may be shown of them.

use std::fs;
use std::io;
use std::path::{Component, Path, PathBuf};

use crate::load::error::LoadError;

/// The most bytes of a name in a reference.
const LONGEST_NAME: usize = 500;

/// Reads a regular file: a pipe or a device, which may never end, is an error.
pub(super) fn read(path: &Path) -> io::Result<Vec<u8>> {
    if fs::metadata(path)?.is_file() {
        fs::read(path)
    } else {
        Err(io::Error::new(io::ErrorKind::InvalidInput, "this is not a regular file"))
    }
}

/// Reads the scene file itself.
pub(super) fn read_scene(path: &Path) -> Result<Vec<u8>, LoadError> {
    read(path).map_err(|source| LoadError::Read { path: path.to_owned(), source })
}

/// The file `name` beside the scene, or in a folder beside it; `None` if the name leads elsewhere: a scene from
/// somebody else must not make its reader open files that have nothing to do with it.
///
/// One file has one path, however its name is written, so that what is read can be remembered.
pub(super) fn beside(scene: &Path, name: &str) -> Option<PathBuf> {
    // A drive letter is one on some systems only.
    let drive = name.as_bytes().get(1) == Some(&b':');
    let is_inside = |part| matches!(part, Component::Normal(_) | Component::CurDir);
    let path = Path::new(name);
    (is_name(name) && !drive && path.components().all(is_inside)).then(|| {
        let plain: PathBuf = path.components().filter(|part| *part != Component::CurDir).collect();
        scene.with_file_name(plain)
    })
}

/// Whether a text can be the name of a file: error messages show it.
pub(super) fn is_name(text: &str) -> bool {
    !text.is_empty() && text.len() <= LONGEST_NAME && !text.contains(char::is_control)
}

/// The start of a text from a file, without what would play tricks on a terminal.
pub(super) fn shortened(text: &str, characters: usize) -> String {
    let mut start: String =
        text.chars().take(characters).map(|c| if c.is_control() { '\u{fffd}' } else { c }).collect();
    if text.chars().nth(characters).is_some() {
        start.push('…');
    }
    start
}
