//! Reading of files within limits of time and memory.

use std::fs;
use std::path::Path;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use peak_alloc::PeakAlloc;
use sir_geom::{Built, LoadError, LoadOptions, load};

use crate::files::chain;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// Memory allowed for any file \[bytes\].
const BASE: usize = 16 << 20;

/// Memory allowed per byte of the files. The most expensive are indices of glTF strips whose corners have all possible
/// values, at 330 bytes when lists have just grown; empty nodes, `{},`, take 180.
const PER_BYTE: usize = 400;

/// Time allowed for a file, plus a second per million bytes: far more than any needs, so that a busy machine does no
/// harm.
const MAX_TIME: Duration = Duration::from_secs(10);

/// Maximum length of an error message \[characters\].
const MAX_ERROR_LENGTH: usize = 800;

static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());

/// Blocks other tests. Every test starts with this call, before it creates its files, because memory is counted for the
/// whole process.
pub(crate) fn alone() -> MutexGuard<'static, ()> {
    ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Reads `path`, whose files have `bytes` bytes in total, and checks time, memory and the text of an error.
pub(crate) fn load_within_bounds(path: &Path, bytes: usize) -> Result<Built, LoadError> {
    MEMORY.reset_peak_usage();
    let (before, start) = (MEMORY.current_usage(), Instant::now());
    let result = load(path, &LoadOptions::default());
    let (time, memory) = (start.elapsed(), MEMORY.peak_usage().saturating_sub(before));
    let max_time = MAX_TIME + Duration::from_micros(bytes as u64);
    assert!(time < max_time, "{}: {time:?}", path.display());
    assert!(memory < BASE + PER_BYTE * bytes, "{}: {memory} bytes for a file of {bytes}", path.display());
    if let Err(error) = &result {
        let text = chain(error);
        assert!(text.chars().count() < MAX_ERROR_LENGTH && !text.chars().any(char::is_control), "{text:?}");
        let folder = path.parent().unwrap_or(path);
        assert!(text.contains(&*folder.to_string_lossy()), "the error does not name its file: {text}");
    }
    result
}

/// Reads the first of some files, which are put in one folder.
pub(crate) fn load_hostile(files: &[(&str, &[u8])]) -> Result<Built, LoadError> {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path().join("scene");
    for (name, bytes) in files {
        fs::create_dir_all(folder.join(name).parent().unwrap()).unwrap();
        fs::write(folder.join(name), bytes).unwrap();
    }
    load_within_bounds(&folder.join(files[0].0), files.iter().map(|(_, bytes)| bytes.len()).sum())
}

/// Returns the error of reading the first of some files, and checks that it contains all `words`.
pub(crate) fn refused(files: &[(&str, &[u8])], words: &[&str]) -> String {
    let text = match load_hostile(files) {
        Ok(built) => panic!("{} triangles, {:?}", built.scene.triangles().len(), built.warnings),
        Err(error) => chain(&error),
    };
    println!("{text}");
    assert!(words.iter().all(|word| text.contains(word)), "{words:?} are not all in: {text}");
    text
}
