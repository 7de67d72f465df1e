//! URIs in glTF files.

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
/// The error is the reason why the URI is not followed.
pub(super) fn resolve(scene: &Path, uri: &str) -> Result<Reference, &'static str> {
    if let Some(data) = uri.strip_prefix("data:") {
        return decode_data(data).map(Reference::Data);
    }
    // A colon before the first slash ends a scheme (RFC 3986, section 4.2); a drive letter looks the same.
    if uri.split('/').next().is_some_and(|first| first.contains(':')) {
        return Err("only relative paths and data URIs are followed");
    }
    let decoded = percent_decode_str(uri).decode_utf8().map_err(|_| "it is not UTF-8 text")?;
    if !is_name(&decoded) {
        return Err("this cannot be the name of a file");
    }
    let path = (!decoded.contains('\\')).then(|| beside(scene, &decoded)).flatten();
    path.map(Reference::File).ok_or("it leads outside the scene's folder")
}

/// Decodes the bytes of a data URI without its scheme: `[media type][;base64],DATA` (RFC 2397).
fn decode_data(data: &str) -> Result<Vec<u8>, &'static str> {
    // Exporters disagree about padding.
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
