//! Checkpoints: files with the state of a run, from which it can be resumed.
//!
//! A file consists of a line of text with the version of its layout, a line with the *head*, whose content is up to the
//! caller, the state of a stage as 64-bit little-endian integers, and the SHA-256 of all of this. It does not contain
//! the numbers of threads and ranks, because no state depends on them.

use std::fs::File;
use std::io::{self, BufRead, BufReader, BufWriter, Read, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use sha2::{Digest, Sha256};
use sir_radiosity::Visitor;

use crate::communicator::Communicator;
use crate::error::CheckpointError;

/// First line of a checkpoint: the file type and the version of its layout.
const MAGIC: &str = "SIR checkpoint 4";

/// Age of the last checkpoint from which on another one is saved at the end of a stage.
const END_INTERVAL: Duration = Duration::from_secs(30);

/// Length of a SHA-256, in bytes.
const HASH: usize = 32;

/// Settings for saving the state of a run: file, interval, and head.
#[derive(Clone, Debug)]
pub struct Checkpoints {
    path: PathBuf,
    every: Duration,
    head: String,
    last: Instant,
}

/// Opened and verified checkpoint, read up to the state of its stage.
#[derive(Debug)]
pub struct Saved {
    path: PathBuf,
    head: String,
    words: Option<BufReader<io::Take<File>>>,
}

impl Checkpoints {
    /// Returns settings for saving to this file; `every` is the time from one checkpoint to the next.
    #[must_use]
    pub fn new(path: PathBuf, every: Duration) -> Self {
        Self { path, every, head: String::new(), last: Instant::now() }
    }

    /// Sets the head of the next checkpoints: a text without line breaks.
    pub fn set_head(&mut self, head: String) {
        debug_assert!(!head.contains('\n'));
        self.head = head;
    }

    /// Writes an initial checkpoint without the state of a stage. Only the first rank writes.
    ///
    /// # Errors
    ///
    /// If the file cannot be written.
    pub fn save_start(&mut self, comm: &dyn Communicator) -> Result<(), CheckpointError> {
        self.save(comm, &[], &mut |_| {})
    }

    /// Removes the checkpoint, which a finished run does not need, and the partial file that a killed run may have
    /// left.
    pub fn remove(&self) {
        for path in [&self.path, &self.part()] {
            // The files often do not exist, and a file that cannot be removed is harmless.
            let _ = std::fs::remove_file(path);
        }
    }

    /// Returns the path to which a checkpoint is written until it is complete.
    fn part(&self) -> PathBuf {
        // Appended instead of replacing the extension: `run.1` and `run.2` may be saved at the same time.
        let mut part = self.path.clone().into_os_string();
        part.push(".part");
        part.into()
    }

    /// Returns true if the state should be saved now.
    pub(crate) fn are_due(&self) -> bool {
        self.last.elapsed() >= self.every
    }

    /// Returns true if the state should be saved now, at the end of a stage.
    pub(crate) fn are_due_at_end(&self) -> bool {
        self.last.elapsed() >= self.every.min(END_INTERVAL)
    }

    /// Saves the state that `visit` passes to its visitor, of the stage with this identity. All ranks take part; the
    /// first one writes. If it fails, all ranks return an error.
    pub(crate) fn save(
        &mut self,
        comm: &dyn Communicator,
        identity: &[i64],
        visit: &mut dyn FnMut(&mut dyn Visitor),
    ) -> Result<(), CheckpointError> {
        let part = self.part();
        // A failure is kept until the end, because the other ranks still wait for the sums.
        let writer = comm.is_first().then(|| Writer::create(&part, &self.head));
        let mut saver = Saver { comm, writer, words: Vec::new() };
        saver.same(&mut identity.to_vec());
        visit(&mut saver);
        let written = match saver.writer {
            Some(writer) => writer.and_then(Writer::finish).and_then(|()| replace(&part, &self.path)),
            None => Ok(()),
        };
        self.last = Instant::now();
        let written = written.map_err(|source| {
            let _ = std::fs::remove_file(&part);
            CheckpointError::Write { path: self.path.clone(), earlier: self.path.exists(), source }
        });
        agree(comm, written)
    }
}

/// Replaces an old file by a new one.
fn replace(new: &Path, old: &Path) -> io::Result<()> {
    std::fs::rename(new, old)?;
    // The new name is on disk only once its folder is synced. Not all systems support this.
    if let Some(folder) = old.parent().and_then(|folder| File::open(folder).ok()) {
        let _ = folder.sync_all();
    }
    Ok(())
}

/// Returns an error on all ranks if one of them failed.
fn agree<T>(comm: &dyn Communicator, outcome: Result<T, CheckpointError>) -> Result<T, CheckpointError> {
    match comm.first_failed(outcome.is_err()) {
        Some(rank) if outcome.is_ok() => Err(CheckpointError::Elsewhere { rank }),
        _ => outcome,
    }
}

/// New file and the hash of its content so far.
struct Writer {
    file: BufWriter<File>,
    hash: Sha256,
}

impl Writer {
    fn create(path: &Path, head: &str) -> io::Result<Self> {
        let mut writer = Self { file: BufWriter::new(File::create(path)?), hash: Sha256::new() };
        writer.write(format!("{MAGIC}\n{head}\n").as_bytes())?;
        Ok(writer)
    }

    fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.hash.update(bytes);
        self.file.write_all(bytes)
    }

    /// Appends the hash and syncs the file to disk.
    fn finish(self) -> io::Result<()> {
        let Self { mut file, hash } = self;
        file.write_all(&hash.finalize())?;
        file.into_inner().map_err(io::IntoInnerError::into_error)?.sync_all()
    }
}

/// Visitor that saves the sums of a state over all ranks, without changing the state.
struct Saver<'a> {
    comm: &'a dyn Communicator,
    /// Writer of the first rank, or its first error; `None` on other ranks.
    writer: Option<io::Result<Writer>>,
    words: Vec<i64>,
}

impl Visitor for Saver<'_> {
    fn sum(&mut self, words: &mut [i64]) {
        let mut sums = std::mem::take(&mut self.words);
        sums.clear();
        sums.extend_from_slice(words);
        self.comm.sum(&mut sums);
        self.same(&mut sums);
        self.words = sums;
    }

    fn same(&mut self, words: &mut [i64]) {
        if let Some(Ok(writer)) = &mut self.writer {
            let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
            if let Err(error) = writer.write(&bytes) {
                self.writer = Some(Err(error));
            }
        }
    }
}

impl Saved {
    /// Opens a checkpoint, verifies its hash, and reads its head.
    ///
    /// # Errors
    ///
    /// If the file cannot be read, is damaged, or has another layout.
    pub fn open(path: &Path) -> Result<Self, CheckpointError> {
        let unfit = |why: &str| CheckpointError::Unfit { path: path.to_owned(), why: why.into() };
        let read = |source| CheckpointError::Read { path: path.to_owned(), source };
        let length = std::fs::metadata(path).map_err(read)?.len();
        let Some(content) = length.checked_sub(HASH as u64) else {
            return Err(unfit("the checkpoint is too short"));
        };

        let mut file = BufReader::new(File::open(path).map_err(read)?);
        let mut first = String::new();
        let known = file.by_ref().take(64).read_line(&mut first).is_ok() && first.trim_end() == MAGIC;
        if !known {
            return Err(unfit(&format!(
                "the checkpoint does not begin with \"{MAGIC}\"; another version may have written it"
            )));
        }
        let mut file = File::open(path).map_err(read)?;
        let mut hash = Sha256::new();
        io::copy(&mut Read::by_ref(&mut file).take(content), &mut HashWriter(&mut hash)).map_err(read)?;
        let mut expected = [0; HASH];
        file.read_exact(&mut expected).map_err(read)?;
        if *hash.finalize() != expected {
            return Err(unfit("the checkpoint is damaged"));
        }

        let mut words = BufReader::new(File::open(path).map_err(read)?.take(content));
        let (mut first, mut head) = (String::new(), String::new());
        words.read_line(&mut first).and_then(|_| words.read_line(&mut head)).map_err(read)?;
        head.pop();
        Ok(Self { path: path.to_owned(), head, words: Some(words) })
    }

    /// Returns the placeholder for ranks other than the first, which reads the checkpoint for all.
    #[must_use]
    pub fn elsewhere() -> Self {
        Self { path: PathBuf::new(), head: String::new(), words: None }
    }

    /// Returns the head that the caller had set.
    #[must_use]
    pub fn head(&self) -> &str {
        &self.head
    }

    /// Restores the state that `visit` passes to its visitor, if it is of the stage with this identity, and returns the
    /// result of `visit`. All ranks take part; the first one reads.
    pub(crate) fn restore<T>(
        self,
        comm: &dyn Communicator,
        identity: &[i64],
        visit: impl FnOnce(&mut dyn Visitor) -> T,
    ) -> Result<T, CheckpointError> {
        let mut restorer = Restorer { comm, words: self.words, outcome: Ok(()) };
        let mut found = identity.to_vec();
        restorer.same(&mut found);
        let visited = (found == identity).then(|| visit(&mut restorer));
        let left = restorer.words.as_mut().map_or(Ok(0), |words| words.read(&mut [0]));
        let outcome = match (visited, restorer.outcome, left) {
            (Some(visited), Ok(()), Ok(0)) => Ok(visited),
            (_, Err(source), _) | (.., Err(source)) if source.kind() != io::ErrorKind::UnexpectedEof => {
                Err(CheckpointError::Read { path: self.path, source })
            }
            _ if !comm.is_first() => Err(CheckpointError::Elsewhere { rank: 0 }),
            _ => {
                let why = "the checkpoint belongs to another stage, scene or pipeline".into();
                Err(CheckpointError::Unfit { path: self.path, why })
            }
        };
        agree(comm, outcome)
    }
}

struct HashWriter<'a>(&'a mut Sha256);

impl Write for HashWriter<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.update(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Visitor that restores a saved state: sums on the first rank, identical numbers on all ranks.
struct Restorer<'a> {
    comm: &'a dyn Communicator,
    /// Reader of the first rank; `None` on other ranks.
    words: Option<BufReader<io::Take<File>>>,
    outcome: io::Result<()>,
}

impl Visitor for Restorer<'_> {
    fn sum(&mut self, words: &mut [i64]) {
        words.fill(0);
        if let (Some(reader), Ok(())) = (&mut self.words, &self.outcome) {
            for word in words {
                let mut bytes = [0; 8];
                match reader.read_exact(&mut bytes) {
                    Ok(()) => *word = i64::from_le_bytes(bytes),
                    Err(error) => {
                        self.outcome = Err(error);
                        break;
                    }
                }
            }
        }
    }

    fn same(&mut self, words: &mut [i64]) {
        self.sum(words);
        self.comm.broadcast(words);
    }
}
