//! Checkpoints that cannot be resumed are rejected with a message that names the file and the reason.

use std::error::Error;
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::time::Duration;

use sha2::{Digest, Sha256};
use sir_lines::Domain;
use sir_parallel::{CheckpointError, Checkpoints, Communicator, Executor, RunError, Saved, SingleProcess};
use tempfile::{TempDir, tempdir};

use crate::jobs::{Job, ROOM, Room, executor};
use crate::observers::StopAfter;
use crate::ranks::run_ranks;

const MULTIPATH: Job = Job::Multipath { replicas: 3, tail: 0 };

/// Returns a folder with the checkpoint of a stopped stage.
fn stopped(room: &Room, job: Job) -> (TempDir, PathBuf) {
    let folder = tempdir().unwrap();
    let path = folder.path().join("run.checkpoint");
    let mut checkpoints = Checkpoints::new(path.clone(), Duration::MAX);
    checkpoints.set_head("a head".into());
    let mut executor = Executor {
        checkpoints: Some(&mut checkpoints),
        ..executor(&SingleProcess, 1).watched_by(StopAfter(2))
    };
    let end = job.run(room, &mut executor, None).map(|_| ());
    assert!(matches!(end, Err(RunError::Interrupted { .. })), "{job:?}: {end:?}");
    (folder, path)
}

/// Fails unless the error names the file and the reason.
#[track_caller]
fn assert_unfit(error: &CheckpointError, file: &Path, reason: &str) {
    let CheckpointError::Unfit { path, why } = error else { panic!("{error:?}") };
    assert_eq!(path, file);
    assert!(why.contains(reason), "{why}");
    let message = error.to_string();
    assert!(message.contains(file.to_str().unwrap()) && message.contains(reason), "{message}");
}

#[track_caller]
fn assert_not_opened(file: &Path, reason: &str) {
    assert_unfit(&Saved::open(file).unwrap_err(), file, reason);
}

/// Fails unless the checkpoint can be opened but is rejected by the stage.
#[track_caller]
fn assert_not_taken(room: &Room, job: Job, file: &Path) {
    let saved = Saved::open(file).unwrap();
    match job.run(room, &mut executor(&SingleProcess, 1), Some(saved)).map(|_| ()) {
        Err(RunError::Checkpoint(error)) => assert_unfit(&error, file, "another stage, scene or pipeline"),
        other => panic!("{job:?} takes {}: {other:?}", file.display()),
    }
}

#[test]
fn a_truncated_checkpoint_is_refused() {
    let (_folder, path) = stopped(&ROOM, Job::FirstShot);
    let whole = fs::read(&path).unwrap();
    for length in [whole.len() - 1, whole.len() - 8, whole.len() - 32, whole.len() / 2, 60, 40] {
        fs::write(&path, &whole[..length]).unwrap();
        assert_not_opened(&path, "damaged");
    }
    fs::write(&path, &whole[..31]).unwrap();
    assert_not_opened(&path, "too short");
    fs::write(&path, [&whole[..], &[0]].concat()).unwrap();
    assert_not_opened(&path, "damaged");
    fs::write(&path, &whole).unwrap();
    assert!(Saved::open(&path).is_ok());
}

#[test]
fn a_checkpoint_with_a_flipped_bit_is_refused() {
    let (_folder, path) = stopped(&ROOM, Job::Batches);
    let whole = fs::read(&path).unwrap();
    // In the head, in the state, and in the hash.
    let head = "SIR checkpoint 4\n".len();
    for place in
        [head + 1, whole.len() / 3, whole.len() / 2, whole.len() - 33, whole.len() - 32, whole.len() - 1]
    {
        let mut bytes = whole.clone();
        bytes[place] ^= 4;
        fs::write(&path, bytes).unwrap();
        assert_not_opened(&path, "damaged");
    }
}

#[test]
fn a_file_of_another_kind_is_refused() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("other");
    let text = b"{\"format\": \"something else\", \"and\": \"longer than a hash\"}\n".repeat(9);
    let picture = [&b"\x89PNG\r\n\x1a\n"[..], &[0xFF; 500]].concat();
    for content in [text, picture, vec![b'S'; 1000], b"SIR".repeat(20), vec![b'\n'; 64]] {
        fs::write(&path, content).unwrap();
        assert_not_opened(&path, "the checkpoint does not begin with \"SIR checkpoint 4\"");
    }
}

#[test]
fn a_checkpoint_with_another_layout_is_refused() {
    let (_folder, path) = stopped(&ROOM, Job::FirstShot);
    let mut bytes = fs::read(&path).unwrap();
    bytes.truncate(bytes.len() - 32);
    bytes["SIR checkpoint ".len()] = b'9';
    let hash = Sha256::digest(&bytes);
    fs::write(&path, [&bytes[..], &hash[..]].concat()).unwrap();
    assert_not_opened(&path, "another version may have written it");
}

#[test]
fn an_empty_file_is_refused() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("empty");
    fs::write(&path, []).unwrap();
    assert_not_opened(&path, "too short");
}

#[test]
fn a_missing_checkpoint_cannot_be_read() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("missing");
    let error = Saved::open(&path).unwrap_err();
    let CheckpointError::Read { path: named, source } = &error else { panic!("{error:?}") };
    assert_eq!((named, source.kind()), (&path, ErrorKind::NotFound));
    assert!(error.to_string().contains(path.to_str().unwrap()), "{error}");
    assert!(error.source().is_some());
}

#[test]
fn a_checkpoint_of_another_stage_is_refused() {
    let jobs = [Job::FirstShot, Job::FocusedShot, Job::Batches, Job::FocusedBatches, MULTIPATH];
    for saved in jobs {
        let (_folder, path) = stopped(&ROOM, saved);
        for job in jobs {
            if format!("{job:?}") != format!("{saved:?}") {
                assert_not_taken(&ROOM, job, &path);
            }
        }
    }
}

#[test]
fn a_checkpoint_of_another_number_of_replicas_is_refused() {
    let (_folder, path) = stopped(&ROOM, MULTIPATH);
    for replicas in [1, 2, 4, 8] {
        assert_not_taken(&ROOM, Job::Multipath { replicas, tail: 0 }, &path);
    }
}

#[test]
fn a_checkpoint_of_another_scene_is_refused() {
    let (finer, coarser) = (Room::new(1000), Room::new(100));
    for job in [Job::FirstShot, Job::Batches, MULTIPATH] {
        let (_folder, path) = stopped(&ROOM, job);
        assert_not_taken(&finer, job, &path);
        assert_not_taken(&coarser, job, &path);
    }
}

#[test]
fn a_checkpoint_of_another_domain_is_refused() {
    let mut room = Room::new(400);
    room.domain = Domain::Sphere(room.model.scene.bounding_sphere());
    for job in [Job::Batches, MULTIPATH] {
        let (_folder, path) = stopped(&room, job);
        assert_not_taken(&ROOM, job, &path);
    }
}

/// An initial checkpoint has only a head. The caller must not pass it to a stage.
#[test]
fn a_checkpoint_without_a_state_is_refused_by_stages() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("run.checkpoint");
    Checkpoints::new(path.clone(), Duration::MAX).save_start(&SingleProcess).unwrap();
    for job in [Job::FirstShot, Job::Batches, MULTIPATH] {
        assert_not_taken(&ROOM, job, &path);
    }
}

/// The first rank returns the reason, the others the number of that rank. No rank waits forever.
#[test]
fn a_refusal_reaches_all_ranks() {
    for (there, jobs) in [
        (Job::FirstShot, [Job::Batches, MULTIPATH]),
        (Job::Batches, [Job::FirstShot, MULTIPATH]),
        (MULTIPATH, [Job::Batches, Job::Multipath { replicas: 2, tail: 0 }]),
    ] {
        let (_folder, path) = stopped(&ROOM, there);
        for job in jobs {
            let ends = run_ranks(3, |comm| {
                let saved = if comm.is_first() { Saved::open(&path).unwrap() } else { Saved::elsewhere() };
                job.run(&ROOM, &mut executor(comm, 2), Some(saved)).map(|_| ())
            });
            let [Err(RunError::Checkpoint(first)), others @ ..] = &ends[..] else {
                panic!("{job:?}: {ends:?}")
            };
            assert_unfit(first, &path, "another stage, scene or pipeline");
            for end in others {
                let elsewhere = CheckpointError::Elsewhere { rank: 0 }.to_string();
                assert_eq!(end.as_ref().unwrap_err().to_string(), elsewhere, "{job:?}");
            }
        }
    }
}

/// A rejected file is not changed.
#[test]
fn a_checkpoint_that_was_refused_by_one_stage_can_be_resumed_by_another() {
    let (_folder, path) = stopped(&ROOM, Job::FirstShot);
    assert_not_taken(&ROOM, Job::Batches, &path);
    let saved = Saved::open(&path).unwrap();
    let outcome = Job::FirstShot.run(&ROOM, &mut executor(&SingleProcess, 1), Some(saved)).unwrap();
    outcome.assert_is(&Job::FirstShot.by_hand(&ROOM), "after a refusal");
}
