//! Results do not depend on the number of workers.

use std::num::NonZeroUsize;

use sir_parallel::{Communicator, Executor};

use crate::jobs::{FINE_ROOM, JOBS, Job, LINES, ROOM, Room, executor};
use crate::observers::Dawdle;
use crate::ranks::run_ranks;

const THREADS: [usize; 4] = [1, 2, 3, 7];
const RANKS: [usize; 4] = [1, 2, 3, 4];

fn assert_same_bits(job: Job) {
    let expected = job.by_hand(&ROOM);
    for threads in THREADS {
        for ranks in RANKS {
            let outcomes =
                run_ranks(ranks, |comm| job.run(&ROOM, &mut executor(comm, threads), None).unwrap());
            for (rank, outcome) in outcomes.iter().enumerate() {
                outcome.assert_is(&expected, &format!("{job:?}, {threads} threads, rank {rank} of {ranks}"));
            }
        }
    }
}

#[test]
fn a_first_shot_is_the_same_by_any_number_of_workers() {
    assert_same_bits(Job::FirstShot);
    assert_same_bits(Job::FocusedShot);
}

#[test]
fn shadow_rays_are_the_same_by_any_number_of_workers() {
    assert_same_bits(Job::ShadowRays);
}

#[test]
fn batches_are_the_same_by_any_number_of_workers() {
    assert_same_bits(Job::Batches);
    assert_same_bits(Job::FocusedBatches);
}

#[test]
fn multipath_is_the_same_by_any_number_of_workers() {
    JOBS.into_iter().filter(|job| matches!(job, Job::Multipath { .. })).for_each(assert_same_bits);
}

#[test]
fn a_process_by_itself_gets_the_same_as_ranks() {
    for job in JOBS {
        let mut executor = Executor::new(NonZeroUsize::new(2).unwrap());
        let outcome = job.run(&ROOM, &mut executor, None).unwrap();
        outcome.assert_is(&job.by_hand(&ROOM), &format!("{job:?}"));
    }
}

/// The length of a slice depends on the time of the previous one, and each rank has its own clock.
#[test]
fn ranks_agree_on_the_next_lines_however_fast_each_of_them_is() {
    for job in [Job::FirstShot, Job::Batches, Job::Multipath { replicas: 3, tail: 0 }] {
        let expected = job.by_hand(&ROOM);
        for slow in [0, 1] {
            let outcomes = run_ranks(2, |comm| {
                let observer = Dawdle(if comm.rank() == slow { 2 } else { 0 });
                job.run(&ROOM, &mut executor(comm, 1).watched_by(observer), None).unwrap()
            });
            for outcome in outcomes {
                outcome.assert_is(&expected, &format!("{job:?}, rank {slow} is slow"));
            }
        }
    }
}

/// Some replicas have no lines, or some workers no replica.
#[test]
fn replicas_may_be_more_than_lines_and_fewer_than_workers() {
    for replicas in [2, 40, LINES + 10] {
        let job = Job::Multipath { replicas, tail: 7 };
        let expected = job.by_hand(&ROOM);
        for (ranks, threads) in [(4, 7), (3, 1)] {
            for outcome in
                run_ranks(ranks, |comm| job.run(&ROOM, &mut executor(comm, threads), None).unwrap())
            {
                outcome.assert_is(&expected, &format!("{job:?}, {ranks} ranks with {threads} threads"));
            }
        }
    }
}

#[test]
fn sides_may_be_fewer_than_threads() {
    let room = Room::new(1);
    for job in [Job::FirstShot, Job::Batches, Job::Multipath { replicas: 3, tail: 0 }] {
        let expected = job.by_hand(&room);
        for outcome in run_ranks(2, |comm| job.run(&room, &mut executor(comm, 50), None).unwrap()) {
            outcome.assert_is(&expected, &format!("{job:?}"));
        }
    }
}

/// Counters are communicated in chunks of 16,384 sides.
#[test]
fn sides_may_be_more_than_are_handed_over_at_a_time() {
    for job in [Job::FirstShot, Job::Batches, Job::Multipath { replicas: 3, tail: 0 }] {
        let expected = job.by_hand(&FINE_ROOM);
        for outcome in run_ranks(3, |comm| job.run(&FINE_ROOM, &mut executor(comm, 2), None).unwrap()) {
            outcome.assert_is(&expected, &format!("{job:?}"));
        }
    }
}
