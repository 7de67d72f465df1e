//! Atomic writing of files.

use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use crate::error::ViewError;

/// Writes a file atomically: writes a temporary file in the same folder and renames it when it is complete and on disk.
///
/// No reader ever sees a partial file, and an older file of that name stays until the new one replaces it.
///
/// # Errors
///
/// If the file cannot be written, or `write` fails. The temporary file is then removed.
pub fn write_atomically(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
) -> Result<(), ViewError> {
    let temporary = temporary_name(path).map_err(ViewError::writing(path))?;
    let result = fill(&temporary, write).and_then(|()| fs::rename(&temporary, path));
    result.map_err(|error| {
        // An error of the clean-up is ignored, because the first error is more informative.
        let _ = fs::remove_file(&temporary);
        ViewError::writing(path)(error)
    })
}

fn fill(path: &Path, write: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>) -> io::Result<()> {
    let mut file = BufWriter::new(File::create(path)?);
    write(&mut file)?;
    file.flush()?;
    file.get_ref().sync_all()
}

/// Returns a hidden name in the same folder, hence on the same file system. The name contains the process ID, so that
/// two processes do not write to the same file.
fn temporary_name(path: &Path) -> io::Result<PathBuf> {
    let name = path
        .file_name()
        .ok_or_else(|| io::Error::new(io::ErrorKind::InvalidInput, "the path has no file name"))?;
    let mut hidden = OsString::from(".");
    hidden.push(name);
    hidden.push(format!(".{}.part", std::process::id()));
    Ok(path.with_file_name(hidden))
}

/// Returns true if a file of this name can only be an unfinished file of a process that was killed while
/// [`write_atomically`] wrote it.
#[must_use]
pub fn is_partial_file(name: &str) -> bool {
    let inner = name.strip_prefix('.').and_then(|name| name.strip_suffix(".part"));
    let process = inner.and_then(|inner| inner.rsplit_once('.'));
    process.is_some_and(|(name, id)| {
        !name.is_empty() && !id.is_empty() && id.bytes().all(|b| b.is_ascii_digit())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(dir: &Path) -> Vec<String> {
        let mut names: Vec<String> =
            fs::read_dir(dir).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn a_failure_leaves_the_old_file_and_nothing_else() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("a.txt");
        write_atomically(&path, |f| f.write_all(b"old")).unwrap();
        let error = write_atomically(&path, |f| {
            f.write_all(b"half of the new")?;
            Err(io::Error::other("disk on fire"))
        })
        .unwrap_err()
        .to_string();
        assert!(error.contains("a.txt") && error.contains("disk on fire"), "{error}");
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(names(dir.path()), ["a.txt"]);
        write_atomically(&path, |f| f.write_all(b"new")).unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"new");
    }

    #[test]
    fn unfinished_files_are_told_from_others() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("a.txt");
        write_atomically(&path, |_| {
            assert!(names(dir.path()).iter().all(|name| is_partial_file(name)));
            Ok(())
        })
        .unwrap();
        for other in ["a.txt", ".a.txt.part", ".a.12x.part", "a.txt.1.part", "..1.part", ".1.part", ".part"] {
            assert!(!is_partial_file(other), "{other}");
        }
    }

    #[test]
    fn a_missing_folder_is_named() {
        let dir = tempfile::tempdir().unwrap();
        let error = write_atomically(&dir.path().join("no/such/file"), |_| Ok(())).unwrap_err();
        assert!(error.to_string().contains("no/such/file"), "{error}");
    }
}
