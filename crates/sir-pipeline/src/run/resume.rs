//! What a checkpoint says about its run, and whether the run can go on.

use std::fs;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use sir_parallel::{CheckpointError, Communicator, RunError, Saved};

use crate::error::Error;
use crate::fingerprint;
use crate::fingerprint::{Fingerprint, PROGRAM};
use crate::plan::Pipeline;
use crate::ranks::{agree, broadcast_text};
use crate::report::result::{FILE_NAME, Report};

/// Name of the checkpoint in a run directory. A finished run has none.
pub const CHECKPOINT: &str = "checkpoint";

/// What the checkpoint of a run says beside the state of its stage.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Head {
    /// Of everything that decides the result.
    pub(crate) fingerprint: String,
    /// The pipeline file, by its absolute path.
    pub(crate) pipeline: PathBuf,
    /// Number of the stage whose state this is. 0, which is no stage with lines, stands for a run that has only begun.
    pub(crate) stage: usize,
    /// In a `Repeat`: which repeat this is of, from 0,
    pub(crate) repeat: u64,
    /// and which of its stages.
    pub(crate) part: usize,
    /// What the stages before it did.
    pub(crate) report: Report,
}

impl Head {
    /// As one line of text.
    pub(crate) fn to_line(&self) -> String {
        // Serialising a tree of plain structs fails only for keys that are not text, of which there are none.
        serde_json::to_string(self).unwrap_or_default()
    }
}

fn refuse(directory: &Path, why: impl Into<String>) -> Error {
    Error::CannotResume { directory: directory.to_owned(), why: why.into() }
}

/// Opens the checkpoint of a run directory. The first rank reads, and tells the others.
pub(crate) fn open(directory: &Path, comm: &dyn Communicator) -> Result<(Saved, Head), Error> {
    let opened = if comm.is_first() { find(directory) } else { Ok(Saved::elsewhere()) };
    let saved = agree(comm, opened)?;
    let line = broadcast_text(comm, saved.head());
    let program = serde_json::from_str::<serde_json::Value>(&line)
        .ok()
        .and_then(|head| Some(head.get("report")?.get("program")?.as_str()?.to_owned()));
    let head = match program {
        Some(program) if program != PROGRAM => {
            Err(refuse(directory, format!("{program} wrote its checkpoint, but this is {PROGRAM}")))
        }
        _ => serde_json::from_str(&line)
            .map_err(|error| refuse(directory, format!("its checkpoint makes no sense ({error})"))),
    };
    Ok((saved, agree(comm, head)?))
}

fn find(directory: &Path) -> Result<Saved, Error> {
    let path = directory.join(CHECKPOINT);
    if !path.exists() {
        return Err(if directory.join(FILE_NAME).exists() {
            refuse(directory, "the run is finished: its result is there")
        } else if directory.is_dir() {
            refuse(directory, "it holds no checkpoint; start a new run")
        } else {
            refuse(directory, "there is no such directory")
        });
    }
    Saved::open(&path).map_err(|error| match error {
        // The error names the file; there is nothing to do but to start a new run.
        CheckpointError::Unfit { why, .. } => refuse(directory, format!("{why}; start a new run")),
        other => RunError::from(other).into(),
    })
}

/// The pipeline of the run, if its file still says what it said.
pub(crate) fn pipeline(directory: &Path, head: &Head) -> Result<Pipeline, Error> {
    let text = &head.report.pipeline.text;
    // If the file is gone, the checkpoint knows what it said.
    if fs::read_to_string(&head.pipeline).is_ok_and(|now| now != *text) {
        let file = head.pipeline.display();
        return Err(refuse(
            directory,
            format!("the pipeline {file} has changed; put it back, or start a new run"),
        ));
    }
    Ok(Pipeline::parse(text, &head.pipeline)?)
}

/// Whether the scene is still the same.
pub(crate) fn check_fingerprint(directory: &Path, head: &Head, now: Fingerprint) -> Result<(), Error> {
    if fingerprint::hex(now) == head.fingerprint {
        return Ok(());
    }
    let scene = &head.report.scene.path;
    Err(refuse(
        directory,
        format!(
            "the scene {scene} has changed; put it back, or start a new run (a file of points counts as part of it)"
        ),
    ))
}

/// Removes what was half written when the run was killed.
pub(crate) fn clean_up(directory: &Path) {
    let Ok(entries) = fs::read_dir(directory) else { return };
    for entry in entries.flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        let path = entry.path();
        if path.is_dir() {
            clean_up(&path);
        } else if name.starts_with('.') && name.ends_with(".part") {
            // If it cannot be removed, it does no harm.
            let _ = fs::remove_file(path);
        }
    }
}
