//! Reading of the file and its buffers.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use ::gltf::json::Root;

use crate::load::error::LoadError;
use crate::load::files;
use crate::load::gltf::document::{self, Document};
use crate::load::gltf::uri::{self, Reference};

/// Reads the document, and the binary chunk if the file is a GLB that has one.
pub(super) fn open(path: &Path) -> Result<(Document, Option<Vec<u8>>), LoadError> {
    let (json, binary) = read(path)?;
    Ok((document::parse(path, &json)?, binary))
}

/// Reads the text of the document, and the binary chunk if the file is a GLB that has one.
pub(super) fn read(path: &Path) -> Result<(Vec<u8>, Option<Vec<u8>>), LoadError> {
    let invalid = |what: &str| LoadError::Gltf { path: path.to_owned(), what: what.to_owned() };
    let bytes = files::read_scene(path)?;
    let (json, binary) = match &bytes[..] {
        [] => return Err(invalid("the file is empty")),
        [b'g', b'l', b'T', b'F', 1, 0, 0, 0, ..] => {
            return Err(LoadError::GltfVersion { path: path.to_owned(), version: "1.0".to_owned() });
        }
        [b'g', b'l', b'T', b'F', ..] => split_glb(&bytes).map_err(invalid)?,
        // JSON should have no byte order mark; readers may ignore one (RFC 8259, section 8.1).
        [0xef, 0xbb, 0xbf, text @ ..] => (text, None),
        [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => {
            return Err(invalid("its text is in UTF-16, but must be in UTF-8"));
        }
        text if text.starts_with(b"version https://git-lfs") => {
            return Err(invalid("it is a pointer of Git LFS; `git lfs pull` gets the file itself"));
        }
        text => (text, None),
    };
    Ok((json.to_vec(), binary.map(<[u8]>::to_vec)))
}

/// Splits a GLB into the JSON chunk and the binary chunk (glTF 2.0 specification, section 4.4). Further data are
/// ignored.
fn split_glb(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), &'static str> {
    let word = |at: usize| bytes.get(at..at + 4).and_then(|b| b.try_into().ok()).map(u32::from_le_bytes);
    if word(4) != Some(2) {
        return Err("the version of its GLB header is not 2");
    }
    let end = word(8).map(|length| length as usize).filter(|&length| length <= bytes.len());
    let end = end.ok_or("the file is shorter than its GLB header states; it is truncated")?;
    let chunk = |at: usize, kind: &[u8; 4]| {
        let start = at + 8;
        let length = word(at)? as usize;
        (bytes.get(at + 4..start)? == kind && start <= end && length <= end - start)
            .then(|| &bytes[start..start + length])
    };
    let json = chunk(12, b"JSON").ok_or("its first GLB chunk is not a complete JSON chunk")?;
    let next = 20 + json.len();
    let binary = chunk(next, b"BIN\0");
    if binary.is_none() && bytes.get(next + 4..next + 8) == Some(b"BIN\0") {
        return Err("its binary GLB chunk is truncated");
    }
    Ok((json, binary))
}

/// Reads the bytes of all buffers of a document. A buffer with neither a URI nor the binary chunk is empty, which is an
/// error only if something refers to it. A file that several buffers share is in memory once.
pub(super) fn buffers(
    path: &Path,
    root: &Root,
    mut binary: Option<Vec<u8>>,
) -> Result<Vec<Rc<Vec<u8>>>, LoadError> {
    let mut read: BTreeMap<PathBuf, Rc<Vec<u8>>> = BTreeMap::new();
    let mut buffers = Vec::with_capacity(root.buffers.len());
    for (i, buffer) in root.buffers.iter().enumerate() {
        let element = || format!("buffer {i}");
        let found = match &buffer.uri {
            Some(uri) => match resolve(path, uri, element)? {
                Reference::Data(bytes) => Some(Rc::new(bytes)),
                Reference::File(file) => match read.get(&file) {
                    Some(bytes) => Some(Rc::clone(bytes)),
                    None => {
                        let bytes = Rc::new(read_file(path, &file, element)?);
                        read.insert(file, Rc::clone(&bytes));
                        Some(bytes)
                    }
                },
            },
            None if i == 0 => binary.take().map(Rc::new),
            None => None,
        };
        let Some(bytes) = found else {
            buffers.push(Rc::default());
            continue;
        };
        if (bytes.len() as u64) < buffer.byte_length.0 {
            let (length, real) = (buffer.byte_length.0, bytes.len());
            let what = format!("buffer {i} should have {length} bytes, but there are {real}");
            return Err(LoadError::Gltf { path: path.to_owned(), what });
        }
        buffers.push(bytes);
    }
    Ok(buffers)
}

/// Resolves a URI of the file. `element` names the part of the file that has it.
pub(super) fn resolve(path: &Path, uri: &str, element: impl Fn() -> String) -> Result<Reference, LoadError> {
    uri::resolve(path, uri).map_err(|why| LoadError::Reference {
        path: path.to_owned(),
        element: element(),
        uri: files::shortened(uri, 60),
        why: why.to_owned(),
    })
}

/// Reads a file that an element of the scene refers to.
fn read_file(scene: &Path, file: &Path, element: impl Fn() -> String) -> Result<Vec<u8>, LoadError> {
    files::read(file).map_err(|source| LoadError::Missing {
        scene: scene.to_owned(),
        element: element(),
        path: file.to_owned(),
        source,
    })
}

#[cfg(test)]
mod tests {
    use super::split_glb;

    fn glb(chunks: &[(&[u8; 4], &[u8])]) -> Vec<u8> {
        let mut body = Vec::new();
        for (kind, data) in chunks {
            body.extend((data.len() as u32).to_le_bytes());
            body.extend(*kind);
            body.extend(*data);
        }
        [&b"glTF"[..], &2u32.to_le_bytes(), &(12 + body.len() as u32).to_le_bytes(), &body].concat()
    }

    #[test]
    fn chunks_are_found_and_anything_cut_off_is_noticed() {
        let whole = glb(&[(b"JSON", b"{}  "), (b"BIN\0", b"1234"), (b"MORE", b"x")]);
        assert_eq!(split_glb(&whole), Ok((&b"{}  "[..], Some(&b"1234"[..]))));
        assert_eq!(split_glb(&glb(&[(b"JSON", b"{}")])), Ok((&b"{}"[..], None)));
        assert_eq!(split_glb(&glb(&[(b"JSON", b"{}"), (b"MORE", b"x")])), Ok((&b"{}"[..], None)));
        for length in 4..whole.len() {
            assert!(split_glb(&whole[..length]).is_err(), "{length} bytes");
        }
        for bad in [glb(&[(b"BIN\0", b"1234")]), glb(&[])] {
            assert!(split_glb(&bad).is_err());
        }
        let mut tiny = whole.clone();
        tiny[8..12].copy_from_slice(&5u32.to_le_bytes());
        assert!(split_glb(&tiny).is_err());
        let mut huge_chunk = whole;
        huge_chunk[12..16].copy_from_slice(&u32::MAX.to_le_bytes());
        assert!(split_glb(&huge_chunk).is_err());
    }
}
