//! Locks of run directories, so that no two runs write to the same one.

use std::fs;
use std::fs::{File, OpenOptions, TryLockError};
use std::io;
use std::path::{Path, PathBuf};

use crate::error::Error;
use crate::progress::Progress;
use crate::run_files::LOCK;

/// Lock of a run directory, held until it is dropped. The operating system releases it, too, when the process ends in
/// any way.
#[derive(Debug)]
pub(crate) struct DirectoryLock {
    path: PathBuf,
    /// The lock is that of this open file.
    _file: File,
}

impl DirectoryLock {
    /// Locks an existing directory. If its file system has no locks, warns about it and goes on.
    ///
    /// # Errors
    ///
    /// If another run holds the lock, or no file can be written to the directory.
    pub(crate) fn acquire(directory: &Path, progress: &dyn Progress) -> Result<Self, Error> {
        let path = directory.join(LOCK);
        loop {
            let file = open(&path, true).map_err(Error::not_writable(directory))?;
            match file.try_lock() {
                Ok(()) if !is_at(&file, &path) => {
                    // A run that ended in between has removed this file. Another run may have made a new one.
                    continue;
                }
                Ok(()) => {}
                Err(TryLockError::WouldBlock) => {
                    return Err(Error::InUse { directory: directory.to_owned() });
                }
                Err(TryLockError::Error(error)) => progress.warn(&[format!(
                    "{} cannot be locked ({error}); start no second run there before this one ends",
                    directory.display()
                )]),
            }
            return Ok(Self { path, _file: file });
        }
    }
}

impl Drop for DirectoryLock {
    fn drop(&mut self) {
        // Before the lock is released. A file that stays is harmless, because it is not locked.
        let _ = fs::remove_file(&self.path);
    }
}

/// Returns an error if a run uses the directory. Writes nothing.
pub(crate) fn check_unused(directory: &Path) -> Result<(), Error> {
    let locked = |file: File| matches!(file.try_lock(), Err(TryLockError::WouldBlock));
    if open(&directory.join(LOCK), false).is_ok_and(locked) {
        return Err(Error::InUse { directory: directory.to_owned() });
    }
    Ok(())
}

/// Opens a lock file for writing, because network file systems lock only such files.
fn open(path: &Path, create: bool) -> io::Result<File> {
    OpenOptions::new().write(true).create(create).truncate(false).open(path)
}

/// Returns true if this open file still has this path.
fn is_at(file: &File, path: &Path) -> bool {
    let same = || -> io::Result<bool> {
        Ok(same_file::Handle::from_file(file.try_clone()?)? == same_file::Handle::from_path(path)?)
    };
    same().unwrap_or(false)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::progress::NoProgress;

    #[test]
    fn a_directory_has_one_run_at_a_time() {
        let folder = tempfile::tempdir().unwrap();
        let acquire = || DirectoryLock::acquire(folder.path(), &NoProgress);
        let lock = acquire().unwrap();
        assert!(matches!(acquire(), Err(Error::InUse { .. })));
        assert!(matches!(check_unused(folder.path()), Err(Error::InUse { .. })));
        drop(lock);
        assert!(check_unused(folder.path()).is_ok());
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0, "a run leaves no lock behind");
        // A killed run leaves an unlocked file.
        fs::write(folder.path().join(LOCK), "").unwrap();
        assert!(check_unused(folder.path()).is_ok());
        drop(acquire().unwrap());
    }

    #[test]
    fn a_lock_of_a_removed_file_does_not_count() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(LOCK);
        let file = open(&path, true).unwrap();
        assert!(is_at(&file, &path));
        fs::remove_file(&path).unwrap();
        assert!(!is_at(&file, &path));
        drop(open(&path, true).unwrap());
        assert!(!is_at(&file, &path), "a new file has the same name");
    }

    #[test]
    fn many_runs_at_once_take_turns() {
        use std::sync::atomic::{AtomicU32, Ordering::SeqCst};
        let folder = tempfile::tempdir().unwrap();
        let (users, turns) = (AtomicU32::new(0), AtomicU32::new(0));
        std::thread::scope(|scope| {
            for _ in 0..4 {
                scope.spawn(|| {
                    while turns.load(SeqCst) < 200 {
                        let Ok(lock) = DirectoryLock::acquire(folder.path(), &NoProgress) else { continue };
                        assert_eq!(users.fetch_add(1, SeqCst), 0, "two runs hold the lock");
                        turns.fetch_add(1, SeqCst);
                        users.fetch_sub(1, SeqCst);
                        drop(lock);
                    }
                });
            }
        });
    }
}
