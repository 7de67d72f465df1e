//! A stopped stage has the same outcome after it is resumed, by any number of ranks and threads.

use std::path::Path;
use std::time::Duration;

use sir_parallel::{Checkpoints, Communicator, Executor, RunError, Saved};
use tempfile::tempdir;

use crate::jobs::{FINE_ROOM, JOBS, Job, LINES, Outcome, ROOM, Room, executor};
use crate::observers::{Collect, StopAfter};
use crate::ranks::{Ranks, run_ranks};

/// Part of a run: its workers, and the number of progress reports after which one rank asks to stop.
#[derive(Clone, Copy, Debug)]
struct Leg {
    ranks: usize,
    threads: usize,
    looks: u32,
}

const fn leg(ranks: usize, threads: usize, looks: u32) -> Leg {
    Leg { ranks, threads, looks }
}

/// Returns a leg that runs until the end.
const fn last(ranks: usize, threads: usize) -> Leg {
    leg(ranks, threads, u32::MAX)
}

/// Returns the checkpoint from which a rank resumes.
fn saved(comm: &Ranks<'_>, path: &Path) -> Saved {
    if comm.is_first() { Saved::open(path).unwrap() } else { Saved::elsewhere() }
}

/// Returns checkpoint settings. Only the first rank writes: the path of the others does not exist.
fn checkpoints(comm: &Ranks<'_>, path: &Path, every: Duration) -> Checkpoints {
    let nowhere = Path::new("/nowhere/at/all");
    Checkpoints::new(if comm.is_first() { path } else { nowhere }.to_owned(), every)
}

/// Runs a stage leg by leg. Returns the outcome, which is that of all ranks, and the numbers of lines at the stops.
fn run(room: &Room, job: Job, legs: &[Leg]) -> (Outcome, Vec<u64>) {
    let folder = tempdir().unwrap();
    let path = folder.path().join("run.checkpoint");
    let mut stops = Vec::new();
    for (n, leg) in legs.iter().enumerate() {
        let what = format!("{job:?}, leg {n} of {legs:?}");
        let outcomes = run_ranks(leg.ranks, |comm| {
            let saved = (n > 0).then(|| saved(comm, &path));
            let mut checkpoints = checkpoints(comm, &path, Duration::MAX);
            // Any rank can ask to stop.
            let asks = comm.rank() == n % leg.ranks;
            let observer = Box::new(StopAfter(if asks { leg.looks } else { u32::MAX }));
            let mut executor =
                Executor { observer, checkpoints: Some(&mut checkpoints), ..executor(comm, leg.threads) };
            job.run(room, &mut executor, saved)
        });
        let mut ends = outcomes.into_iter().map(|outcome| match outcome {
            Ok(outcome) => Ok(outcome),
            // Random walks may follow the lines.
            Err(RunError::Interrupted { done, total }) if total >= LINES => Err(done),
            Err(error) => panic!("{what}: {error}"),
        });
        match ends.next().unwrap() {
            Ok(first) => {
                ends.for_each(|other| assert!(other.as_ref() == Ok(&first), "{what}: ranks differ"));
                return (first, stops);
            }
            Err(done) => {
                ends.for_each(|other| assert!(other == Err(done), "{what}: ranks differ"));
                assert!(stops.last().is_none_or(|&before| before <= done), "{what}: {done} after {stops:?}");
                stops.push(done);
            }
        }
    }
    panic!("{job:?} does not finish: {legs:?}, {stops:?}");
}

/// Stops a stage after several numbers of reports and resumes it with another executor.
fn assert_resumable(job: Job) {
    let expected = job.by_hand(&ROOM);
    let mut within = 0;
    for before in [(1, 1), (2, 3), (3, 1)] {
        for after in [(1, 2), (2, 1), (4, 2)] {
            for looks in 0..=2 {
                let legs = [leg(before.0, before.1, looks), last(after.0, after.1)];
                let (outcome, stops) = run(&ROOM, job, &legs);
                outcome.assert_is(&expected, &format!("{job:?}, {legs:?}, stopped after {stops:?}"));
                within += stops.iter().filter(|&&done| 0 < done && done < LINES).count();
            }
        }
    }
    assert!(within >= 9, "{job:?}: only {within} stops were in the middle");
}

/// Stops and resumes a stage many times.
fn assert_resumable_often(job: Job) {
    // Neither the numbers of workers nor those of reports follow a pattern.
    let legs = [
        leg(1, 1, 2),
        leg(3, 1, 1),
        leg(1, 2, 0),
        leg(2, 1, 1),
        leg(4, 1, 1),
        leg(2, 1, 0),
        leg(1, 3, 2),
        leg(1, 1, 1),
        leg(1, 1, 2),
        leg(3, 2, 3),
        last(2, 2),
    ];
    let (outcome, stops) = run(&ROOM, job, &legs);
    outcome.assert_is(&job.by_hand(&ROOM), &format!("{job:?}, stopped after {stops:?}"));
    assert!(stops.len() >= 5, "{job:?}: {stops:?}");
}

#[test]
fn a_first_shot_goes_on_after_a_stop() {
    assert_resumable(Job::FirstShot);
    assert_resumable(Job::FocusedShot);
}

#[test]
fn shadow_rays_go_on_after_a_stop() {
    assert_resumable(Job::ShadowRays);
}

#[test]
fn batches_go_on_after_a_stop() {
    assert_resumable(Job::Batches);
    assert_resumable(Job::FocusedBatches);
}

#[test]
fn one_replica_goes_on_after_a_stop() {
    assert_resumable(Job::Multipath { replicas: 1, tail: LINES / 10 });
}

#[test]
fn replicas_go_on_after_a_stop() {
    assert_resumable(Job::Multipath { replicas: 3, tail: 0 });
    assert_resumable(Job::Multipath { replicas: 8, tail: LINES / 5 });
}

#[test]
fn every_stage_may_be_stopped_again_and_again() {
    JOBS.into_iter().for_each(assert_resumable_often);
}

/// Stops a run in every batch. Near the end little power is left, which random walks send on.
#[test]
fn batches_go_on_from_any_batch() {
    let expected = Job::Batches.by_hand(&ROOM);
    assert!(expected.batches > 10, "{} batches", expected.batches);
    for looks in 1.. {
        let legs = [leg(1 + looks as usize % 3, 1, looks), last(1 + looks as usize % 2, 2)];
        let (outcome, stops) = run(&ROOM, Job::Batches, &legs);
        outcome.assert_is(&expected, &format!("{legs:?}, stopped after {stops:?}"));
        if stops.is_empty() {
            break;
        }
    }
}

/// A state is saved and restored in chunks of 16,384 sides.
#[test]
fn a_state_of_several_chunks_goes_on_after_a_stop() {
    for job in [Job::FirstShot, Job::Batches, Job::Multipath { replicas: 3, tail: 0 }] {
        let (outcome, stops) = run(&FINE_ROOM, job, &[leg(2, 1, 2), leg(1, 2, 1), last(3, 1)]);
        outcome.assert_is(&job.by_hand(&FINE_ROOM), &format!("{job:?}, stopped after {stops:?}"));
        assert!(stops.iter().any(|&done| 0 < done && done < LINES), "{job:?}: {stops:?}");
    }
}

/// Resumes from every checkpoint of a run, since a killed run can leave any of them behind.
fn assert_saved_at_every_look(job: Job) {
    let expected = job.by_hand(&ROOM);
    let folder = tempdir().unwrap();
    let path = folder.path().join("run.checkpoint");
    let outcomes = run_ranks(2, |comm| {
        let mut copies = Vec::new();
        let mut checkpoints = checkpoints(comm, &path, Duration::ZERO);
        let mut executor = Executor { checkpoints: Some(&mut checkpoints), ..executor(comm, 2) };
        if comm.is_first() {
            executor.observer = Box::new(Collect { checkpoint: &path, copies: &mut copies });
        }
        let outcome = job.run(&ROOM, &mut executor, None).unwrap();
        drop(executor);
        (outcome, copies)
    });
    for (rank, (outcome, _)) in outcomes.iter().enumerate() {
        outcome.assert_is(&expected, &format!("{job:?}, saved at every look, rank {rank}"));
    }
    let copies = outcomes.into_iter().next().unwrap().1;
    assert!(copies.len() >= 2, "{job:?}: {copies:?}");
    for (k, (done, copy)) in copies.iter().chain([&(LINES, path)]).enumerate() {
        let (ranks, threads) = [(1, 1), (3, 1), (1, 3)][k % 3];
        let resumed =
            run_ranks(ranks, |comm| job.run(&ROOM, &mut executor(comm, threads), Some(saved(comm, copy))));
        for outcome in resumed {
            outcome.unwrap().assert_is(&expected, &format!("{job:?}, copy {k}, of before line {done}"));
        }
    }
}

#[test]
fn every_checkpoint_of_a_first_shot_is_good() {
    assert_saved_at_every_look(Job::FirstShot);
}

#[test]
fn every_checkpoint_of_batches_is_good() {
    assert_saved_at_every_look(Job::Batches);
}

#[test]
fn every_checkpoint_of_multipath_is_good() {
    assert_saved_at_every_look(Job::Multipath { replicas: 1, tail: 0 });
    assert_saved_at_every_look(Job::Multipath { replicas: 8, tail: LINES / 5 });
}

#[test]
fn a_stop_without_checkpoints_is_only_a_stop() {
    for job in JOBS {
        let outcomes = run_ranks(2, |comm| {
            let mut executor = executor(comm, 1).watched_by(StopAfter(1));
            job.run(&ROOM, &mut executor, None).map(|_| ())
        });
        let stopped = |end: &Result<(), RunError>| matches!(end, Err(RunError::Interrupted { .. }));
        assert!(outcomes.iter().all(stopped), "{job:?}: {outcomes:?}");
    }
}
