//! Run directories.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use crate::error::Error;
use crate::run_files::{CHECKPOINT, REPORT};

/// Returns the name for runs of a pipeline: the stem of its file, or the name of its folder if the file is called
/// `pipeline`.
#[must_use]
pub fn run_name(pipeline: &Path) -> String {
    let stem = pipeline.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    if stem != "pipeline" {
        return if stem.is_empty() { "run".into() } else { stem };
    }
    let pipeline = absolute(pipeline);
    let folder = pipeline.parent().and_then(Path::file_name);
    folder.map_or(stem, |name| name.to_string_lossy().into_owned())
}

/// Returns the absolute path, or the path itself if the absolute one cannot be determined.
#[must_use]
pub fn absolute(path: &Path) -> PathBuf {
    std::path::absolute(path).unwrap_or_else(|_| path.to_owned())
}

/// Creates the requested run directory, and removes the report of an older run in it.
pub(crate) fn make_given(directory: &Path, force: bool) -> Result<(), Error> {
    check_given(directory, force)?;
    fs::create_dir_all(directory).map_err(Error::directory(directory))?;
    match fs::remove_file(directory.join(REPORT)) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(Error::directory(directory)(error)),
        _ => Ok(()),
    }
}

/// Returns an error if the directory holds a result, or the checkpoint of an interrupted run, unless `force` is true.
pub(crate) fn check_given(directory: &Path, force: bool) -> Result<(), Error> {
    if !force && directory.join(REPORT).exists() {
        return Err(Error::Exists { directory: directory.to_owned() });
    }
    if !force && directory.join(CHECKPOINT).exists() {
        return Err(Error::ExistsInterrupted { directory: directory.to_owned() });
    }
    Ok(())
}

/// Creates a new directory `base/name`, or `base/name-2`, `-3`, … if that exists already. Two runs that start at the
/// same time get different directories.
pub fn make_new(base: &Path, name: &str) -> Result<PathBuf, Error> {
    fs::create_dir_all(base).map_err(Error::directory(base))?;
    let mut number = 1u32;
    loop {
        let path = if number == 1 { base.join(name) } else { base.join(format!("{name}-{number}")) };
        match fs::create_dir(&path) {
            Ok(()) => return Ok(path),
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => number += 1,
            Err(error) => return Err(Error::directory(&path)(error)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_are_named_after_their_pipeline() {
        assert_eq!(run_name(Path::new("a/box.ron")), "box");
        assert_eq!(run_name(Path::new("rooms/attic/pipeline.ron")), "attic");
        assert_eq!(run_name(Path::new("pipeline.ron")), run_name(Path::new("./pipeline.ron")));
    }

    #[test]
    fn a_new_run_never_meets_an_old_one() {
        let base = tempfile::tempdir().unwrap();
        let names: Vec<_> = (0..3).map(|_| make_new(base.path(), "x").unwrap()).collect();
        assert_eq!(names, ["x", "x-2", "x-3"].map(|n| base.path().join(n)));
    }

    #[test]
    fn a_result_is_replaced_only_by_force() {
        let base = tempfile::tempdir().unwrap();
        let directory = base.path().join("deep/run");
        make_given(&directory, false).unwrap();
        make_given(&directory, false).unwrap();
        fs::write(directory.join(REPORT), "{}").unwrap();
        assert!(matches!(make_given(&directory, false), Err(Error::Exists { .. })));
        make_given(&directory, true).unwrap();
        assert!(!directory.join(REPORT).exists());
        fs::write(directory.join(CHECKPOINT), "").unwrap();
        assert!(matches!(make_given(&directory, false), Err(Error::ExistsInterrupted { .. })));
        make_given(&directory, true).unwrap();
    }
}
