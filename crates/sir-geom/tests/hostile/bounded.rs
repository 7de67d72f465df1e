//! Reading under bounds of time and memory.

use std::fs;
use std::path::Path;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use peak_alloc::PeakAlloc;
use sir_geom::{Built, LoadError, LoadOptions, load};

use crate::files::chain;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// Bytes that reading may take whatever the file.
const BASE: usize = 16 << 20;

/// Bytes that reading may take for each byte of the files. The dearest are indices of strips of glTF whose corners have all that they can
/// have, at 330 where lists have just grown; empty nodes, `{},`, take 180.
const PER_BYTE: usize = 400;

/// Time for a file, plus a second for each million bytes: far more than any needs, so that a busy machine does no harm.
const PATIENCE: Duration = Duration::from_secs(10);

/// The most characters of an error.
const LONGEST_ERROR: usize = 800;

static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());

/// Holds other tests back: each begins with this, before it makes its files, because memory is counted for all together.
pub(crate) fn alone() -> MutexGuard<'static, ()> {
    ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Reads `path`, whose files have `bytes` bytes in all, and checks time, memory and the text of an error.
pub(crate) fn load_within_bounds(path: &Path, bytes: usize) -> Result<Built, LoadError> {
    MEMORY.reset_peak_usage();
    let (before, start) = (MEMORY.current_usage(), Instant::now());
    let result = load(path, &LoadOptions::default());
    let (time, memory) = (start.elapsed(), MEMORY.peak_usage().saturating_sub(before));
    let patience = PATIENCE + Duration::from_micros(bytes as u64);
    assert!(time < patience, "{}: {time:?}", path.display());
    assert!(memory < BASE + PER_BYTE * bytes, "{}: {memory} bytes for a file of {bytes}", path.display());
    if let Err(error) = &result {
        let text = chain(error);
        assert!(text.chars().count() < LONGEST_ERROR && !text.chars().any(char::is_control), "{text:?}");
        let folder = path.parent().unwrap_or(path);
        assert!(text.contains(&*folder.to_string_lossy()), "no file is named: {text}");
    }
    result
}

/// Reads the first of some files, which lie in one folder.
pub(crate) fn load_hostile(files: &[(&str, &[u8])]) -> Result<Built, LoadError> {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path().join("scene");
    for (name, bytes) in files {
        fs::create_dir_all(folder.join(name).parent().unwrap()).unwrap();
        fs::write(folder.join(name), bytes).unwrap();
    }
    load_within_bounds(&folder.join(files[0].0), files.iter().map(|(_, bytes)| bytes.len()).sum())
}

/// The error of reading the first of some files; it has all the `words`.
pub(crate) fn refused(files: &[(&str, &[u8])], words: &[&str]) -> String {
    let text = match load_hostile(files) {
        Ok(built) => panic!("{} triangles, {:?}", built.scene.triangles().len(), built.warnings),
        Err(error) => chain(&error),
    };
    println!("{text}");
    assert!(words.iter().all(|word| text.contains(word)), "{words:?} are not all in: {text}");
    text
}
