//! Metadata of a checkpoint, and checks that its run can be resumed.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use sir_parallel::{CheckpointError, Communicator, RunError, Saved};
use sir_view::is_partial_file;

use crate::error::Error;
use crate::fingerprint;
use crate::fingerprint::{Fingerprint, PROGRAM};
use crate::plan::Pipeline;
use crate::progress::Progress;
use crate::ranks::{agree, broadcast_text};
use crate::report::result::Report;
use crate::run::lock::{DirectoryLock, check_unused};
use crate::run::split::Split;
use crate::run_files::{CHECKPOINT, REPORT};

/// Metadata of a checkpoint, in addition to the state of its stage.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Head {
    /// Fingerprint of everything that determines the result.
    pub(crate) fingerprint: String,
    /// Absolute path of the pipeline file.
    pub(crate) pipeline: PathBuf,
    /// Number of the saved stage. 0, which is not a stage with lines, means that the run has not reached one.
    pub(crate) stage: usize,
    /// Number of the repeat in a `Repeat`, from 0.
    pub(crate) repeat: u64,
    /// Number of the stage in a `Repeat` or `Solve`, from 0.
    pub(crate) part: usize,
    /// Lines of the stages of a `Solve`, after its pilot.
    #[serde(default)]
    pub(crate) split: Option<Split>,
    /// Number of the light group that is computed, from 0; the number of groups if all are.
    #[serde(default)]
    pub(crate) group: usize,
    /// Report of the stages before the saved one.
    pub(crate) report: Report,
}

impl Head {
    /// Returns the metadata of a run that has not begun.
    pub(crate) fn start(fingerprint: String, pipeline: PathBuf, report: Report) -> Self {
        Self { fingerprint, pipeline, stage: 0, repeat: 0, part: 0, split: None, group: 0, report }
    }

    /// Resets the position to before the first stage with lines.
    pub(crate) fn rewind(&mut self) {
        (self.stage, self.repeat, self.part, self.split) = (0, 0, 0, None);
    }

    /// Returns the metadata as one line of JSON.
    pub(crate) fn to_line(&self) -> String {
        // Serializing a tree of plain structs fails only for keys that are not strings; there are none.
        serde_json::to_string(self).unwrap_or_default()
    }
}

fn refuse(directory: &Path, why: impl Into<String>) -> Error {
    Error::CannotResume { directory: directory.to_owned(), why: why.into() }
}

/// Locks a run directory and opens its checkpoint. Rank 0 reads it and broadcasts the metadata.
pub(crate) fn open(
    directory: &Path,
    comm: &dyn Communicator,
    progress: &dyn Progress,
) -> Result<(Option<DirectoryLock>, Saved, Head), Error> {
    let opened = if comm.is_first() {
        find(directory, progress).map(|(lock, saved)| (Some(lock), saved))
    } else {
        Ok((None, Saved::elsewhere()))
    };
    let (lock, saved) = agree(comm, opened)?;
    let line = broadcast_text(comm, saved.head());
    let program = serde_json::from_str::<serde_json::Value>(&line)
        .ok()
        .and_then(|head| Some(head.get("report")?.get("program")?.as_str()?.to_owned()));
    let head = match program {
        Some(program) if program != PROGRAM => {
            let why = format!(
                "{program} wrote its checkpoint, but this is {PROGRAM}; use that version, or start a new run"
            );
            Err(refuse(directory, why))
        }
        _ => serde_json::from_str(&line).map_err(|error| {
            refuse(directory, format!("its checkpoint is invalid ({error}); start a new run"))
        }),
    };
    Ok((lock, saved, agree(comm, head)?))
}

fn find(directory: &Path, progress: &dyn Progress) -> Result<(DirectoryLock, Saved), Error> {
    let cannot_lock = |error| match error {
        Error::InUse { .. } => refuse(directory, "it is in use by another run; wait until that run ends"),
        Error::NotWritable { source, .. } => {
            let why = format!(
                "no file can be written to its directory ({source}); allow it, or resume a copy of it"
            );
            refuse(directory, why)
        }
        other => other,
    };
    // First, because a run has no checkpoint at its very beginning, and none any more at its end.
    check_unused(directory).map_err(cannot_lock)?;
    let path = directory.join(CHECKPOINT);
    if !path.exists() {
        return Err(if directory.join(REPORT).exists() {
            refuse(directory, "the run is finished; see its result.json")
        } else if directory.is_dir() {
            refuse(directory, "it holds no checkpoint; start a new run")
        } else {
            refuse(directory, "there is no such directory")
        });
    }
    let lock = DirectoryLock::acquire(directory, progress).map_err(cannot_lock)?;
    let saved = Saved::open(&path).map_err(|error| match error {
        // The error of this crate names the directory. The only remedy is a new run.
        CheckpointError::Unfit { why, .. } => refuse(directory, format!("{why}; start a new run")),
        other => RunError::from(other).into(),
    });
    Ok((lock, saved?))
}

/// Returns the pipeline of the run, or an error if its file has changed.
pub(crate) fn pipeline(directory: &Path, head: &Head) -> Result<Pipeline, Error> {
    let text = &head.report.pipeline.text;
    // If the file no longer exists, the text in the checkpoint is used.
    if fs::read(&head.pipeline).is_ok_and(|now| sir_geom::utf8_text(now) != text.as_bytes()) {
        let file = head.pipeline.display();
        return Err(refuse(
            directory,
            format!("the pipeline {file} has changed; restore it, or start a new run"),
        ));
    }
    Ok(Pipeline::parse(text, &head.pipeline)?)
}

/// Returns an error if the scene has changed since the checkpoint.
pub(crate) fn check_fingerprint(directory: &Path, head: &Head, now: Fingerprint) -> Result<(), Error> {
    if fingerprint::hex(now) == head.fingerprint {
        return Ok(());
    }
    let scene = &head.report.scene.path;
    Err(refuse(
        directory,
        format!(
            "the scene {scene} has changed; restore it, or start a new run (cameras, names of materials and \
             files of points count as part of it)"
        ),
    ))
}

/// Removes partially written files of a run that was killed. Removes nothing that is not in the directory: neither links
/// nor what they lead to.
pub(crate) fn clean_up(directory: &Path, pipeline: &Pipeline) {
    let Ok(directory) = directory.canonicalize() else { return };
    let folders =
        pipeline.files().into_iter().filter_map(|file| directory.join(file).parent()?.canonicalize().ok());
    let folders: BTreeSet<PathBuf> = folders.chain([directory.clone()]).collect();
    for folder in folders.iter().filter(|folder| folder.starts_with(&directory)) {
        let Ok(entries) = fs::read_dir(folder) else { continue };
        for entry in entries.flatten().filter(|entry| entry.file_type().is_ok_and(|kind| kind.is_file())) {
            if is_partial_file(&entry.file_name().to_string_lossy()) {
                // A file that cannot be removed is harmless.
                let _ = fs::remove_file(entry.path());
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::progress::NoProgress;
    use sir_parallel::{Checkpoints, SingleProcess};
    use std::time::Duration;

    #[test]
    fn a_checkpoint_of_another_build_of_the_same_version_is_refused() {
        let run = tempfile::tempdir().unwrap();
        let mut checkpoints = Checkpoints::new(run.path().join(CHECKPOINT), Duration::ZERO);
        let other = format!("sir {} (sources 000000000000)", env!("CARGO_PKG_VERSION"));
        checkpoints.set_head(serde_json::json!({"report": {"program": other}}).to_string());
        checkpoints.save_start(&SingleProcess).unwrap();
        let refused = open(run.path(), &SingleProcess, &NoProgress).unwrap_err();
        let Error::CannotResume { why, .. } = refused else { panic!("{refused}") };
        assert_eq!(
            why,
            format!(
                "{other} wrote its checkpoint, but this is {PROGRAM}; use that version, or start a new run"
            )
        );
    }

    #[cfg(unix)]
    #[test]
    fn only_partial_files_of_the_run_itself_are_removed() {
        let (run, other) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
        fs::write(run.path().join("scene.obj"), "").unwrap();
        let text = r#"(stages: [Load(path: "scene.obj"), FirstShot(lines: 1), Save([
            Image(path: "view.png"), Image(path: "inside/view.png"), Image(path: "outside/view.png")])])"#;
        let pipeline = Pipeline::parse(text, &run.path().join("x.ron")).unwrap();
        let inside = run.path().join("inside");
        fs::create_dir(&inside).unwrap();
        fs::create_dir(run.path().join("unused")).unwrap();
        std::os::unix::fs::symlink(other.path(), run.path().join("outside")).unwrap();
        let partial = ".view.png.123.part";
        let removed =
            [run.path().join(partial), inside.join(partial), run.path().join(".result.json.7.part")];
        let kept = [
            other.path().join(partial),
            run.path().join("unused").join(partial),
            run.path().join(".download.part"),
            run.path().join("view.png"),
        ];
        removed.iter().chain(&kept).for_each(|path| fs::write(path, "").unwrap());
        let link = run.path().join(".link.png.1.part");
        std::os::unix::fs::symlink(other.path().join(partial), &link).unwrap();
        clean_up(run.path(), &pipeline);
        assert!(removed.iter().all(|path| !path.exists()));
        assert!(kept.iter().all(|path| path.exists()) && link.is_symlink());
    }
}
