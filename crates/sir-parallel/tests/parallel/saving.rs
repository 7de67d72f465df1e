//! Contents of checkpoint files, and errors while they are written.

use std::error::Error;
use std::fs;
use std::path::Path;
use std::time::Duration;

use sir_parallel::{CheckpointError, Checkpoints, Communicator, Executor, RunError, Saved, SingleProcess};
use tempfile::tempdir;

use crate::jobs::{JOBS, Job, Outcome, ROOM, executor};
use crate::observers::StopAfter;
use crate::ranks::run_ranks;

/// Runs a stage until it has reported its progress `looks` times, and saves it.
fn stop(
    job: Job,
    comm: &dyn Communicator,
    checkpoints: &mut Checkpoints,
    looks: u32,
) -> Result<Outcome, RunError> {
    let mut executor =
        Executor { checkpoints: Some(checkpoints), ..executor(comm, 1).watched_by(StopAfter(looks)) };
    job.run(&ROOM, &mut executor, None)
}

/// Fails unless the message names the file, and states that an earlier checkpoint can still be used exactly if there is
/// one.
#[track_caller]
fn assert_not_written(end: Result<Outcome, RunError>, file: &Path) {
    let Err(RunError::Checkpoint(error)) = end else { panic!("no checkpoint error") };
    let CheckpointError::Write { path, .. } = &error else { panic!("{error:?}") };
    assert_eq!(path, file);
    let message = error.to_string();
    assert!(message.contains(file.to_str().unwrap()), "{message}");
    assert_eq!(message.contains("still intact"), file.exists(), "{message}");
    assert!(error.source().is_some());
}

fn names(folder: &Path) -> Vec<String> {
    let name = |entry: std::io::Result<fs::DirEntry>| entry.unwrap().file_name().into_string().unwrap();
    let mut names: Vec<_> = fs::read_dir(folder).unwrap().map(name).collect();
    names.sort();
    names
}

#[test]
fn the_head_comes_back_as_it_was() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("run.checkpoint");
    let long = "long".repeat(20_000);
    for head in ["", "{\"stage\": \"first shot\", \"seed\": 3}", "Wände, 壁, 🏠", " \tx\r ", " ", &long] {
        let mut checkpoints = Checkpoints::new(path.clone(), Duration::MAX);
        checkpoints.set_head(head.to_owned());
        checkpoints.save_start(&SingleProcess).unwrap();
        assert_eq!(Saved::open(&path).unwrap().head(), head);
        for job in JOBS {
            assert!(stop(job, &SingleProcess, &mut checkpoints, 1).is_err());
            assert_eq!(Saved::open(&path).unwrap().head(), head, "{job:?}");
        }
    }
    assert_eq!(Saved::elsewhere().head(), "");
}

#[test]
fn a_new_head_replaces_the_old_one_at_the_next_save() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("run.checkpoint");
    let mut checkpoints = Checkpoints::new(path.clone(), Duration::MAX);
    checkpoints.set_head("first".into());
    checkpoints.save_start(&SingleProcess).unwrap();
    checkpoints.set_head("second".into());
    assert_eq!(Saved::open(&path).unwrap().head(), "first");
    checkpoints.save_start(&SingleProcess).unwrap();
    assert_eq!(Saved::open(&path).unwrap().head(), "second");
}

/// Only the checkpoint is left in its folder. A partial file of a killed run is overwritten.
#[test]
fn there_is_only_one_file() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("run.checkpoint");
    fs::write(folder.path().join("run.checkpoint.part"), [b'x'; 1_000_000]).unwrap();
    for looks in [0, 1, 2] {
        let mut checkpoints = Checkpoints::new(path.clone(), Duration::ZERO);
        assert!(stop(Job::Batches, &SingleProcess, &mut checkpoints, looks).is_err());
        assert_eq!(names(folder.path()), ["run.checkpoint"]);
        assert!(Saved::open(&path).is_ok());
    }
}

/// Several runs can save at the same time to files of one folder whose names differ only in the extension.
#[test]
fn checkpoints_with_similar_names_do_not_mix() {
    let folder = tempdir().unwrap();
    let paths = ["run.1", "run.2", "run.part"].map(|name| folder.path().join(name));
    std::thread::scope(|scope| {
        for path in &paths {
            scope.spawn(|| {
                let mut checkpoints = Checkpoints::new(path.clone(), Duration::ZERO);
                checkpoints.set_head(path.to_str().unwrap().to_owned());
                for _ in 0..20 {
                    checkpoints.save_start(&SingleProcess).unwrap();
                    assert_eq!(Saved::open(path).unwrap().head(), path.to_str().unwrap());
                }
            });
        }
    });
    assert_eq!(names(folder.path()), ["run.1", "run.2", "run.part"]);
}

#[test]
fn a_folder_that_does_not_exist_is_reported() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("missing/run.checkpoint");
    let error = Checkpoints::new(path.clone(), Duration::MAX).save_start(&SingleProcess).unwrap_err();
    assert!(matches!(&error, CheckpointError::Write { path: named, .. } if *named == path), "{error:?}");
    for job in JOBS {
        let end = stop(job, &SingleProcess, &mut Checkpoints::new(path.clone(), Duration::MAX), 1);
        assert_not_written(end, &path);
    }
}

#[test]
fn only_the_first_rank_writes() {
    let folder = tempdir().unwrap();
    let path = |rank: usize| folder.path().join(format!("{rank}.checkpoint"));
    run_ranks(3, |comm| {
        Checkpoints::new(path(comm.rank()), Duration::MAX).save_start(comm).unwrap();
        assert_eq!(names(folder.path()), ["0.checkpoint"]);
        let end = stop(Job::Batches, comm, &mut Checkpoints::new(path(comm.rank()), Duration::ZERO), 1);
        assert!(matches!(end, Err(RunError::Interrupted { .. })));
    });
    assert_eq!(names(folder.path()), ["0.checkpoint"]);
}

/// A folder is in the place of the new file, so that the file cannot be created.
#[test]
fn the_file_before_stays_whole_if_a_new_one_cannot_be_made() {
    for job in JOBS {
        let folder = tempdir().unwrap();
        let path = folder.path().join("run.checkpoint");
        let mut checkpoints = Checkpoints::new(path.clone(), Duration::MAX);
        assert!(stop(job, &SingleProcess, &mut checkpoints, 1).is_err());
        let before = fs::read(&path).unwrap();

        fs::create_dir(folder.path().join("run.checkpoint.part")).unwrap();
        assert_not_written(stop(job, &SingleProcess, &mut checkpoints, 2), &path);
        assert!(fs::read(&path).unwrap() == before, "{job:?}");
        let saved = Saved::open(&path).unwrap();
        let outcome = job.run(&ROOM, &mut executor(&SingleProcess, 2), Some(saved)).unwrap();
        outcome.assert_is(&job.by_hand(&ROOM), &format!("{job:?}"));
    }
}

/// The device `/dev/full` accepts no byte, so that writing fails while the ranks are summing their state.
#[test]
#[cfg(target_os = "linux")]
fn the_file_before_stays_whole_if_the_disk_is_full() {
    for job in JOBS {
        let folder = tempdir().unwrap();
        let path = folder.path().join("run.checkpoint");
        assert!(stop(job, &SingleProcess, &mut Checkpoints::new(path.clone(), Duration::MAX), 1).is_err());
        let before = fs::read(&path).unwrap();

        for every in [Duration::MAX, Duration::ZERO] {
            std::os::unix::fs::symlink("/dev/full", folder.path().join("run.checkpoint.part")).unwrap();
            let ends = run_ranks(3, |comm| stop(job, comm, &mut Checkpoints::new(path.clone(), every), 1));
            let mut ends = ends.into_iter();
            assert_not_written(ends.next().unwrap(), &path);
            for end in ends {
                let told = matches!(end, Err(RunError::Checkpoint(CheckpointError::Elsewhere { rank: 0 })));
                assert!(told, "{job:?}: {:?}", end.err());
            }
            assert_eq!(names(folder.path()), ["run.checkpoint"]);
            assert!(fs::read(&path).unwrap() == before, "{job:?}");
        }
    }
}
