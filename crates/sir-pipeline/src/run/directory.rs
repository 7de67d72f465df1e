//! Run directories.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use crate::error::Error;
use crate::plan::Pipeline;
use crate::progress::Progress;
use crate::run::group_file;
use crate::run::lock::{DirectoryLock, check_unused};
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

/// Creates and locks the requested run directory, and removes the report, the checkpoint and the light groups of an older
/// run in it.
pub(crate) fn make_given(
    directory: &Path,
    force: bool,
    progress: &dyn Progress,
) -> Result<DirectoryLock, Error> {
    fs::create_dir_all(directory).map_err(Error::directory(directory))?;
    let lock = DirectoryLock::acquire(directory, progress)?;
    check_empty(directory, force)?;
    for name in [REPORT, CHECKPOINT] {
        match fs::remove_file(directory.join(name)) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => {
                return Err(Error::not_writable(directory)(error));
            }
            _ => {}
        }
    }
    group_file::remove_all(directory).map_err(Error::not_writable(directory))?;
    Ok(lock)
}

/// Returns an error if another run uses the directory; if it holds a result, the checkpoint of an interrupted run or an
/// output, unless `force` is true; or if an output would replace an input. Writes nothing.
pub(crate) fn check_given(directory: &Path, force: bool, pipeline: &Pipeline) -> Result<(), Error> {
    check_unused(directory)?;
    check_empty(directory, force)?;
    let is_input =
        |path: &Path| pipeline.inputs().any(|input| same_file::is_same_file(input, path).unwrap_or(false));
    for path in pipeline.files().iter().map(|file| directory.join(file)).filter(|path| path.exists()) {
        if is_input(&path) {
            return Err(Error::OutputIsInput { path });
        }
        if !force {
            return Err(Error::OutputExists { path });
        }
    }
    Ok(())
}

/// Returns an error if the directory holds a result, or the checkpoint of an interrupted run, unless `force` is true.
pub(crate) fn check_empty(directory: &Path, force: bool) -> Result<(), Error> {
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
    use crate::progress::NoProgress;

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
        let make = |force| make_given(&directory, force, &NoProgress);
        make(false).unwrap();
        make(false).unwrap();
        fs::write(directory.join(REPORT), "{}").unwrap();
        assert!(matches!(make(false), Err(Error::Exists { .. })));
        make(true).unwrap();
        fs::write(directory.join(CHECKPOINT), "").unwrap();
        assert!(matches!(make(false), Err(Error::ExistsInterrupted { .. })));
        make(true).unwrap();
        assert_eq!(fs::read_dir(&directory).unwrap().count(), 0);
    }

    #[test]
    fn a_directory_in_use_is_not_replaced_even_by_force() {
        let base = tempfile::tempdir().unwrap();
        let _lock = make_given(base.path(), false, &NoProgress).unwrap();
        fs::write(base.path().join(CHECKPOINT), "").unwrap();
        fs::write(base.path().join("x.obj"), "").unwrap();
        let text = "(stages: [Load(path: \"x.obj\"), FirstShot(lines: 1)])";
        let pipeline = Pipeline::parse(text, &base.path().join("x.ron")).unwrap();
        for force in [false, true] {
            assert!(matches!(check_given(base.path(), force, &pipeline), Err(Error::InUse { .. })));
            assert!(matches!(make_given(base.path(), force, &NoProgress), Err(Error::InUse { .. })));
        }
        assert!(base.path().join(CHECKPOINT).exists());
    }
}
