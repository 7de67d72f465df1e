//! Metadata of a checkpoint, and checks that its run can be resumed.

use std::fs;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use sir_parallel::{CheckpointError, Communicator, RunError, Saved};

use crate::error::Error;
use crate::fingerprint;
use crate::fingerprint::{Fingerprint, PROGRAM};
use crate::plan::Pipeline;
use crate::ranks::{agree, broadcast_text};
use crate::report::result::Report;
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
    /// Number of the stage in a `Repeat`, from 0.
    pub(crate) part: usize,
    /// Report of the stages before the saved one.
    pub(crate) report: Report,
}

impl Head {
    /// Returns the metadata as one line of JSON.
    pub(crate) fn to_line(&self) -> String {
        // Serializing a tree of plain structs fails only for keys that are not strings; there are none.
        serde_json::to_string(self).unwrap_or_default()
    }
}

fn refuse(directory: &Path, why: impl Into<String>) -> Error {
    Error::CannotResume { directory: directory.to_owned(), why: why.into() }
}

/// Opens the checkpoint of a run directory. Rank 0 reads it and broadcasts the metadata.
pub(crate) fn open(directory: &Path, comm: &dyn Communicator) -> Result<(Saved, Head), Error> {
    let opened = if comm.is_first() { find(directory) } else { Ok(Saved::elsewhere()) };
    let saved = agree(comm, opened)?;
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
    Ok((saved, agree(comm, head)?))
}

fn find(directory: &Path) -> Result<Saved, Error> {
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
    Saved::open(&path).map_err(|error| match error {
        // The error of this crate names the directory. The only remedy is a new run.
        CheckpointError::Unfit { why, .. } => refuse(directory, format!("{why}; start a new run")),
        other => RunError::from(other).into(),
    })
}

/// Returns the pipeline of the run, or an error if its file has changed.
pub(crate) fn pipeline(directory: &Path, head: &Head) -> Result<Pipeline, Error> {
    let text = &head.report.pipeline.text;
    // If the file no longer exists, the text in the checkpoint is used.
    if fs::read_to_string(&head.pipeline).is_ok_and(|now| now != *text) {
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
            "the scene {scene} has changed; restore it, or start a new run (its cameras and names and files of points are part \
             of the scene)"
        ),
    ))
}

/// Removes partially written files of a run that was killed.
pub(crate) fn clean_up(directory: &Path) {
    let Ok(entries) = fs::read_dir(directory) else { return };
    for entry in entries.flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        let path = entry.path();
        if path.is_dir() {
            clean_up(&path);
        } else if name.starts_with('.') && name.ends_with(".part") {
            // A file that cannot be removed is harmless.
            let _ = fs::remove_file(path);
        }
    }
}
