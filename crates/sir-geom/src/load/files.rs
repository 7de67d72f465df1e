//! Access to the files of a scene, and safe display of text from them.

use std::fs;
use std::io;
use std::path::{Component, Path, PathBuf};

use crate::load::error::LoadError;

/// Maximum length of a file name in a reference \[bytes\].
const MAX_NAME_LENGTH: usize = 500;

/// Reads a regular file. Anything else is an error, because a pipe or a device may never end.
///
/// The error about an absent file names another one whose name differs in upper and lower case only: some systems do not
/// distinguish them.
pub(super) fn read(path: &Path) -> io::Result<Vec<u8>> {
    match fs::metadata(path) {
        Ok(metadata) if metadata.is_file() => fs::read(path),
        Ok(_) => Err(io::Error::new(io::ErrorKind::InvalidInput, "this is not a regular file")),
        Err(e) if e.kind() == io::ErrorKind::NotFound => Err(match in_other_case(path) {
            Some(name) => io::Error::new(
                e.kind(),
                format!("there is {name}, whose name differs in upper and lower case; rename it"),
            ),
            None => e,
        }),
        Err(e) => Err(e),
    }
}

/// Returns the first file in the folder of an absent file whose name differs in upper and lower case only.
fn in_other_case(path: &Path) -> Option<String> {
    let name = path.file_name()?.to_string_lossy().to_uppercase();
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let names = fs::read_dir(folder).ok()?.flatten().map(|e| e.file_name().to_string_lossy().into_owned());
    names.filter(|other| other.to_uppercase() == name).min().map(|name| shortened(&name, MAX_NAME_LENGTH))
}

/// Reads the scene file itself.
pub(super) fn read_scene(path: &Path) -> Result<Vec<u8>, LoadError> {
    read(path).map_err(|source| LoadError::Read { path: path.to_owned(), source })
}

/// Returns the path of the file `name` in the scene's folder or below it; `None` if the name leads elsewhere. A scene
/// from an untrusted source must not make its reader open unrelated files.
///
/// Every file has one path, however its name is written, so that its contents can be cached by path.
#[cfg(feature = "gltf")]
pub(super) fn beside(scene: &Path, name: &str) -> Option<PathBuf> {
    beside_path(scene, Path::new(name))
}

/// Does the same for a name that need not be UTF-8.
pub(super) fn beside_path(scene: &Path, name: &Path) -> Option<PathBuf> {
    // `Path` recognizes drive letters on some systems only.
    let drive = name.as_os_str().as_encoded_bytes().get(1) == Some(&b':');
    if drive || !is_name(&name.to_string_lossy()) {
        return None;
    }
    let mut plain = PathBuf::new();
    for part in name.components() {
        match part {
            Component::Normal(part) => plain.push(part),
            Component::CurDir => {}
            Component::ParentDir if plain.pop() => {}
            _ => return None,
        }
    }
    Some(scene.with_file_name(plain))
}

/// Returns true if a text can be the name of a file, and can be shown in an error message.
pub(super) fn is_name(text: &str) -> bool {
    !text.is_empty() && text.len() <= MAX_NAME_LENGTH && !text.contains(char::is_control)
}

/// Returns the start of a text from a file. Control characters are replaced, because they could manipulate a terminal.
pub(super) fn shortened(text: &str, characters: usize) -> String {
    let mut start: String =
        text.chars().take(characters).map(|c| if c.is_control() { '\u{fffd}' } else { c }).collect();
    if text.chars().nth(characters).is_some() {
        start.push('…');
    }
    start
}
