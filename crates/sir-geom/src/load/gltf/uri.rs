//! URIs in glTF files.

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use base64::Engine as _;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use percent_encoding::percent_decode_str;

use crate::load::files::{beside, is_name};

/// Target of a URI in a glTF file.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Reference {
    /// The data itself.
    Data(Vec<u8>),
    /// A file in the scene's folder or below it.
    File(PathBuf),
}

/// Resolves a URI of the glTF file `scene`: a `data:` URI, or a relative path with percent-encoded characters.
///
/// Programs write paths in different ways. The first of these readings that names a file is taken: without percent
/// encoding, as it is written, and without its query and fragment. Back slashes separate folders, unless a file has
/// them in its name. If there is no such file, the first reading is returned.
///
/// The error is the reason why the URI is not followed.
pub(super) fn resolve(scene: &Path, uri: &str) -> Result<Reference, &'static str> {
    if let Some(data) = data_of(uri) {
        return decode_data(data).map(Reference::Data);
    }
    // A colon before the first slash ends a scheme (RFC 3986, section 4.2); a drive letter looks the same.
    if let Some((scheme, _)) = uri.split(['/', '\\']).next().and_then(|first| first.split_once(':')) {
        return Err(match scheme.to_ascii_lowercase().as_str() {
            "http" | "https" => "it is an address on the web, and nothing is downloaded",
            _ => ABSOLUTE,
        });
    }
    let decoded = decode(uri)?;
    if !is_name(&decoded) {
        return Err("this cannot be the name of a file");
    }
    if decoded.starts_with(['/', '\\']) {
        return Err(ABSOLUTE);
    }
    let slashes = |text: &str| beside(scene, &text.replace('\\', "/"));
    let first = slashes(&decoded).ok_or("it leads outside the scene's folder")?;
    let plain = uri.split(['?', '#']).next().and_then(|path| decode(path).ok());
    let readings =
        [Some(first.clone()), slashes(uri), plain.and_then(|path| slashes(&path)), beside(scene, &decoded)];
    Ok(Reference::File(readings.into_iter().flatten().find(|path| path.is_file()).unwrap_or(first)))
}

/// Reason why an absolute path or another kind of address is not followed.
const ABSOLUTE: &str =
    "it is an absolute path or address; only paths relative to the scene's folder are followed";

/// Returns true if a URI has its data in itself.
pub(super) fn is_data(uri: &str) -> bool {
    data_of(uri).is_some()
}

/// Returns what follows `data:`, in any case; `None` if the URI is no data URI.
fn data_of(uri: &str) -> Option<&str> {
    let (scheme, data) = uri.trim_start().split_once(':')?;
    scheme.eq_ignore_ascii_case("data").then_some(data)
}

/// Resolves percent-encoded characters.
fn decode(uri: &str) -> Result<Cow<'_, str>, &'static str> {
    percent_decode_str(uri).decode_utf8().map_err(|_| "it is not UTF-8 text")
}

/// Decodes the bytes of a data URI without its scheme: `[media type][;base64],DATA` (RFC 2397).
///
/// Programs break lines in base64, encode its special characters, use its alphabet for URLs, and disagree about padding.
fn decode_data(data: &str) -> Result<Vec<u8>, &'static str> {
    const BASE64: GeneralPurpose = GeneralPurpose::new(
        &base64::alphabet::STANDARD,
        GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
    );
    let (head, body) = data.split_once(',').ok_or("a data URI needs a comma before its data")?;
    let bytes = percent_decode_str(body);
    let is_base64 = head.rsplit(';').next().is_some_and(|last| last.trim().eq_ignore_ascii_case("base64"));
    if !is_base64 {
        return Ok(bytes.collect());
    }
    let digits = bytes.filter(|byte| !byte.is_ascii_whitespace()).map(|byte| match byte {
        b'-' => b'+',
        b'_' => b'/',
        other => other,
    });
    BASE64.decode(digits.collect::<Vec<u8>>()).map_err(|_| "its data is not valid base64")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(path: &str) -> Result<Reference, &'static str> {
        Ok(Reference::File(PathBuf::from(path)))
    }

    #[test]
    fn references_stay_in_the_folder_of_the_scene() {
        let scene = Path::new("folder/room.gltf");
        assert_eq!(resolve(scene, "a%20b.bin"), file("folder/a b.bin"));
        assert_eq!(resolve(scene, "./textures/wood.png"), file("folder/textures/wood.png"));
        assert_eq!(resolve(scene, "textures\\wood.png"), file("folder/textures/wood.png"));
        assert_eq!(resolve(scene, "textures/../wood.png"), file("folder/wood.png"));
        assert_eq!(resolve(scene, "folder/a:b.bin"), file("folder/folder/a:b.bin"));
        for (bad, why) in [
            ("", "cannot be the name"),
            ("/etc/passwd", "absolute path"),
            ("\\\\server\\a.bin", "absolute path"),
            ("../up.bin", "outside the scene's folder"),
            ("..\\up.bin", "outside the scene's folder"),
            ("a/../../up.bin", "outside the scene's folder"),
            ("%2e%2e/up.bin", "outside the scene's folder"),
            ("%2e%2e%5cup.bin", "outside the scene's folder"),
            ("%2Fetc/passwd", "absolute path"),
            ("C:\\a.bin", "absolute path"),
            ("file:///a.bin", "absolute path"),
            ("HTTPS://x/a.bin", "on the web"),
            ("a%00.bin", "cannot be the name"),
            ("%ff.bin", "not UTF-8"),
            ("data:base64 without a comma", "needs a comma"),
            ("data:;base64,not*base64", "not valid base64"),
        ] {
            let found = resolve(scene, bad).unwrap_err();
            assert!(found.contains(why), "{bad}: {found}");
        }
    }

    #[test]
    fn the_first_reading_that_is_a_file_counts() {
        let folder = tempfile::tempdir().unwrap();
        let (scene, at) = (folder.path().join("room.gltf"), |name: &str| folder.path().join(name));
        for name in ["a%20b.bin", "both c.bin", "both%20c.bin", "d#1.bin", "e.bin", "f?.bin"] {
            std::fs::write(at(name), "").unwrap();
        }
        for (uri, name) in [
            ("a%20b.bin", "a%20b.bin"),
            ("a%2520b.bin", "a%20b.bin"),
            ("both%20c.bin", "both c.bin"),
            ("d#1.bin", "d#1.bin"),
            ("d%231.bin", "d#1.bin"),
            ("d%231.bin?v=2", "d#1.bin"),
            ("e.bin?v=2", "e.bin"),
            ("e.bin#x", "e.bin"),
            ("f?.bin", "f?.bin"),
            ("absent%20.bin?v=2", "absent .bin?v=2"),
        ] {
            assert_eq!(resolve(&scene, uri), Ok(Reference::File(at(name))), "{uri}");
        }
        // Programs that know no back slashes leave them in the names of unpacked files.
        if cfg!(unix) {
            std::fs::write(at("textures\\wood.png"), "").unwrap();
            assert_eq!(resolve(&scene, "textures\\wood.png"), Ok(Reference::File(at("textures\\wood.png"))));
        }
    }

    #[test]
    fn data_are_read_as_programs_write_them() {
        for (uri, expected) in [
            ("data:;base64,AQID", &[1, 2, 3][..]),
            ("data:a/b;base64,AQ==", &[1]),
            ("DATA:a/b;BASE64,AQ==", &[1]),
            (" data:;base64,AQ==", &[1]),
            ("data:a/b;charset=utf-8;base64,+/+/", &[0xfb, 0xff, 0xbf]),
            ("data:;base64,-_-_", &[0xfb, 0xff, 0xbf]),
            ("data:;base64,%2B%2f%2B%2F", &[0xfb, 0xff, 0xbf]),
            ("data:;base64,AQ%3D%3D", &[1]),
            ("data:;base64,AQ\r\nID\n", &[1, 2, 3]),
            ("data:;base64,AQ%0AID", &[1, 2, 3]),
            ("data:,%01x", &[1, b'x']),
            // Without a semicolon, this would be a media type, which has a slash.
            ("data:base64,AQID", &[1, 2, 3]),
        ] {
            assert_eq!(resolve(Path::new("room.gltf"), uri), Ok(Reference::Data(expected.to_vec())), "{uri}");
        }
    }
}
