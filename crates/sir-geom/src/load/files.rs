//! Bytes from files, and from the references in scene files.

use std::fs;
use std::io;
use std::path::{Component, Path, PathBuf};

use base64::Engine as _;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use percent_encoding::percent_decode_str;

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
fn is_name(text: &str) -> bool {
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

/// What a URI in a glTF file stands for.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Reference {
    /// The data itself.
    Data(Vec<u8>),
    /// A file beside the scene, or in a folder beside it.
    File(PathBuf),
}

/// Resolves a URI of the glTF file `scene`: a `data:` URI, or a relative path with percent-encoded characters.
///
/// The error says why it is not followed.
pub(super) fn resolve(scene: &Path, uri: &str) -> Result<Reference, &'static str> {
    if let Some(data) = uri.strip_prefix("data:") {
        return decode_data(data).map(Reference::Data);
    }
    // A colon before the first slash ends a scheme (RFC 3986, section 4.2); a drive letter looks like one.
    if uri.split('/').next().is_some_and(|first| first.contains(':')) {
        return Err("only relative paths and data URIs are followed");
    }
    let decoded = percent_decode_str(uri).decode_utf8().map_err(|_| "it is not UTF-8 text")?;
    if !is_name(&decoded) {
        return Err("this cannot be the name of a file");
    }
    let path = (!decoded.contains('\\')).then(|| beside(scene, &decoded)).flatten();
    path.map(Reference::File).ok_or("it leads out of the scene's folder")
}

/// The bytes of a data URI without its scheme: `[media type][;base64],DATA` (RFC 2397).
fn decode_data(data: &str) -> Result<Vec<u8>, &'static str> {
    // Exporters disagree about the padding at the end.
    const BASE64: GeneralPurpose = GeneralPurpose::new(
        &base64::alphabet::STANDARD,
        GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
    );
    let (head, body) = data.split_once(',').ok_or("a data URI needs a comma before its data")?;
    if head.ends_with(";base64") {
        BASE64.decode(body).map_err(|_| "its data is not valid base64")
    } else {
        Ok(percent_decode_str(body).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn references_stay_in_the_folder_of_the_scene() {
        let scene = Path::new("folder/room.gltf");
        let file = |p: &str| Ok(Reference::File(PathBuf::from(p)));
        assert_eq!(resolve(scene, "a%20b.bin"), file("folder/a b.bin"));
        assert_eq!(resolve(scene, "./textures/wood.png"), file("folder/./textures/wood.png"));
        assert_eq!(resolve(scene, "folder/a:b.bin"), file("folder/folder/a:b.bin"));
        assert_eq!(resolve(scene, "data:;base64,AQID"), Ok(Reference::Data(vec![1, 2, 3])));
        assert_eq!(resolve(scene, "data:a/b;base64,AQ=="), Ok(Reference::Data(vec![1])));
        assert_eq!(resolve(scene, "data:,%01x"), Ok(Reference::Data(vec![1, b'x'])));
        for bad in [
            "",
            "/etc/passwd",
            "../up.bin",
            "a/../../up.bin",
            "%2e%2e/up.bin",
            "%2Fetc/passwd",
            "..\\up.bin",
            "C:\\a.bin",
            "file:///a.bin",
            "http://x/a.bin",
            "a%00.bin",
            "%ff.bin",
            "data:base64 without a comma",
            "data:;base64,not*base64",
        ] {
            assert!(resolve(scene, bad).is_err(), "{bad}");
        }
    }
}
