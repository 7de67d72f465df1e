//! Reading a photometric file: access to it, and recognition of its format.

use std::fs;
use std::io;
use std::path::{Component, Path, PathBuf};

use crate::error::PhotometryError;
use crate::photometry::Photometry;
use crate::text::decode;
use crate::{eulumdat, ies};

/// Maximum size of a file \[bytes\]. Real ones have less than a megabyte.
const MAX_SIZE: u64 = 64 << 20;

/// Options of the readers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PhotometryOptions {
    /// Index of the set of lamps, from 0, whose flux scales the intensities of EULUMDAT. IES files have one set only, and
    /// ignore it.
    pub lamp_set: usize,
}

impl Photometry {
    /// Reads an IES LM-63 or EULUMDAT file. Its contents decide the format; a file that is neither is read as EULUMDAT if its
    /// name ends in `.ldt`, so that the error says what is wrong with it. A file with tilt
    /// factors that it names must be in its folder or below it.
    ///
    /// # Errors
    ///
    /// If the file cannot be read, has no known format, is incomplete, or has an invalid value. The message names the file,
    /// and the line and column where that helps.
    pub fn read(path: &Path) -> Result<Self, PhotometryError> {
        Self::read_with(path, PhotometryOptions::default())
    }

    /// Does the same with options.
    ///
    /// # Errors
    ///
    /// As above, and if the file has fewer sets of lamps than the options ask for.
    pub fn read_with(path: &Path, options: PhotometryOptions) -> Result<Self, PhotometryError> {
        let bytes =
            contents(path).map_err(|source| PhotometryError::Read { path: path.to_owned(), source })?;
        let tilt_file = |name: &str| match beside(path, name) {
            Some(path) => contents(&path),
            None => Err(io::Error::other("it is not in the folder of the file")),
        };
        let is_ldt = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("ldt"));
        parse(&bytes, options, is_ldt, tilt_file)
            .map_err(|problem| PhotometryError::InFile { path: path.to_owned(), problem: Box::new(problem) })
    }

    /// Reads the contents of an IES LM-63 or EULUMDAT file. If they name a file with tilt factors, a warning says that it was
    /// not read.
    ///
    /// # Errors
    ///
    /// If the contents have no known format, are incomplete, or have an invalid value.
    pub fn parse(bytes: &[u8]) -> Result<Self, PhotometryError> {
        let tilt_file = |_: &str| Err(io::Error::other("other files are not read"));
        Self::parse_with(bytes, PhotometryOptions::default(), tilt_file)
    }

    /// Does the same with options, and a function that returns the contents of the file with tilt factors of a name.
    ///
    /// # Errors
    ///
    /// As above, and if there are fewer sets of lamps than the options ask for, or the tilt factors are invalid.
    pub fn parse_with(
        bytes: &[u8],
        options: PhotometryOptions,
        tilt_file: impl FnMut(&str) -> io::Result<Vec<u8>>,
    ) -> Result<Self, PhotometryError> {
        parse(bytes, options, false, tilt_file)
    }
}

/// Reads the contents of a file. `is_ldt` is true if its name is that of a EULUMDAT file.
fn parse(
    bytes: &[u8],
    options: PhotometryOptions,
    is_ldt: bool,
    mut tilt_file: impl FnMut(&str) -> io::Result<Vec<u8>>,
) -> Result<Photometry, PhotometryError> {
    let text = decode(bytes);
    if text.lines().any(|line| ies::tilt_value(line).is_some()) {
        return ies::read(&text, &mut tilt_file);
    }
    let start = text.trim_start();
    let may_be_eulumdat = is_ldt && !start.is_empty() && !start.starts_with(['<', '{']);
    if may_be_eulumdat || eulumdat::is_eulumdat(&text) {
        return eulumdat::read(&text, options.lamp_set);
    }
    let why = match start.get(..3).map(str::to_ascii_uppercase).as_deref() {
        _ if start.is_empty() => "it is empty",
        _ if start.starts_with(['<', '{']) => "it seems to be XML or JSON, which is not supported",
        Some("IES") => "the line \"TILT=\" of IES LM-63 is missing",
        _ => "there is no line \"TILT=\" of IES LM-63, and lines 2 to 4 are not the indicators of EULUMDAT",
    };
    Err(PhotometryError::UnknownFormat { why })
}

/// Reads a regular file. Anything else is an error, because a pipe or a device may never end.
fn contents(path: &Path) -> io::Result<Vec<u8>> {
    let metadata = fs::metadata(path)?;
    if metadata.is_dir() {
        return Err(io::Error::new(io::ErrorKind::IsADirectory, "this is a folder, not a file"));
    }
    if !metadata.is_file() {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "this is not a regular file"));
    }
    if metadata.len() > MAX_SIZE {
        return Err(io::Error::new(
            io::ErrorKind::InvalidInput,
            format!("it has more than {MAX_SIZE} bytes"),
        ));
    }
    fs::read(path)
}

/// Returns the path of the file `name` in the folder of another one or below it; `None` if the name leads elsewhere. A file
/// from an untrusted source must not make its reader open unrelated files.
fn beside(file: &Path, name: &str) -> Option<PathBuf> {
    // Files from DOS have its separators.
    let name = name.replace('\\', "/");
    if name.is_empty() || name.contains(|c: char| c.is_control() || c == ':') {
        return None;
    }
    let mut plain = PathBuf::new();
    for part in Path::new(&name).components() {
        match part {
            Component::Normal(part) => plain.push(part),
            Component::CurDir => {}
            Component::ParentDir if plain.pop() => {}
            _ => return None,
        }
    }
    plain.file_name()?;
    Some(file.with_file_name(plain))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tilt_files_are_in_the_folder() {
        let beside = |name: &str| beside(Path::new("lamps/a.ies"), name);
        assert_eq!(beside("t.tlt").unwrap(), Path::new("lamps/t.tlt"));
        assert_eq!(beside("tilts\\t.tlt").unwrap(), Path::new("lamps/tilts/t.tlt"));
        for name in ["", ".", "../t.tlt", "a/../../t", "/etc/passwd", "C:t.tlt", "C:\\t.tlt", "a\u{0}b"] {
            assert_eq!(beside(name), None, "{name:?}");
        }
    }
}
