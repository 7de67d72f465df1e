//! Ranks within one process: every rank is a thread that synchronizes with the others in a [`Meeting`].

use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;

use sir_parallel::Communicator;

/// Communicator of one of several ranks.
pub(crate) struct Ranks<'a> {
    rank: usize,
    size: usize,
    meeting: &'a Meeting,
}

/// State of the sums over all ranks.
#[derive(Default)]
struct Meeting {
    state: Mutex<State>,
    changed: Condvar,
}

#[derive(Default)]
struct State {
    /// Number of finished sums.
    round: u64,
    /// Number of ranks that have contributed to the next sum.
    arrived: usize,
    sums: Vec<i64>,
    /// Last finished sums. The next ones cannot be finished before all ranks have fetched these.
    outcome: Arc<Vec<i64>>,
    /// True if a rank has ended or panicked, so that an unfinished sum will never be finished.
    gone: bool,
}

/// Panic payload that ends a rank whose sum will never be finished. Nothing is printed: the reason is the end of
/// another rank.
struct Lost;

impl Meeting {
    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Communicator for Ranks<'_> {
    fn rank(&self) -> usize {
        self.rank
    }

    fn size(&self) -> usize {
        self.size
    }

    fn sum(&self, words: &mut [i64]) {
        let mut state = self.meeting.lock();
        if state.arrived == 0 {
            state.sums.clear();
            state.sums.extend_from_slice(words);
        } else {
            let counts = (state.sums.len(), words.len());
            assert_eq!(counts.0, counts.1, "ranks have brought different numbers of words");
            state.sums.iter_mut().zip(&*words).for_each(|(sum, word)| *sum = sum.wrapping_add(*word));
        }
        state.arrived += 1;
        let round = state.round;
        if state.arrived == self.size {
            state.outcome = Arc::new(std::mem::take(&mut state.sums));
            state.arrived = 0;
            state.round += 1;
            self.meeting.changed.notify_all();
        }
        while state.round == round {
            if state.gone {
                drop(state);
                resume_unwind(Box::new(Lost));
            }
            state = self.meeting.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
        let outcome = Arc::clone(&state.outcome);
        drop(state);
        words.copy_from_slice(&outcome);
    }
}

/// Runs `job` on this number of ranks, and returns the outcome of each. Panics if a rank panics, or if one ends while
/// another one waits for it.
#[track_caller]
pub(crate) fn run_ranks<T: Send>(size: usize, job: impl Fn(&Ranks<'_>) -> T + Sync) -> Vec<T> {
    let meeting = Meeting::default();
    let run = |rank: usize| {
        let outcome = catch_unwind(AssertUnwindSafe(|| job(&Ranks { rank, size, meeting: &meeting })));
        meeting.lock().gone = true;
        meeting.changed.notify_all();
        outcome
    };
    let run = &run;
    let outcomes: Vec<_> = thread::scope(|scope| {
        let ranks: Vec<_> = (0..size).map(|rank| scope.spawn(move || run(rank))).collect();
        ranks.into_iter().map(|rank| rank.join().unwrap()).collect()
    });
    let mut all = Vec::new();
    for outcome in outcomes {
        match outcome {
            Ok(outcome) => all.push(outcome),
            Err(reason) if reason.is::<Lost>() => {}
            Err(panic) => resume_unwind(panic),
        }
    }
    assert_eq!(all.len(), size, "ranks wait for others that have ended");
    all
}

#[test]
fn all_ranks_get_the_sums_of_every_round() {
    for size in [1, 2, 5] {
        let outcomes = run_ranks(size, |comm| {
            let round = |k: i64| {
                let mut words = vec![k, comm.rank() as i64, i64::MAX];
                comm.sum(&mut words);
                words
            };
            (0..100).map(round).collect::<Vec<_>>()
        });
        let n = size as i64;
        let sums = |k: i64| vec![n * k, n * (n - 1) / 2, i64::MAX.wrapping_mul(n)];
        let expected: Vec<_> = (0..100).map(sums).collect();
        outcomes.into_iter().for_each(|sums| assert_eq!(sums, expected));
    }
}

#[test]
fn what_the_first_rank_knows_reaches_all() {
    let outcomes = run_ranks(4, |comm| {
        let mut words = [comm.rank() as i64 + 7, -1 - comm.rank() as i64];
        comm.broadcast(&mut words);
        words
    });
    assert_eq!(outcomes, [[7, -1]; 4]);
}

#[test]
fn all_ranks_learn_which_was_the_first_to_fail() {
    for failing in [vec![], vec![0], vec![2], vec![3, 1]] {
        let outcomes = run_ranks(4, |comm| comm.first_failed(failing.contains(&comm.rank())));
        assert_eq!(outcomes, [failing.iter().min().copied(); 4]);
    }
}

#[test]
#[should_panic(expected = "ranks wait for others that have ended")]
fn nobody_waits_for_a_rank_that_has_ended() {
    run_ranks(3, |comm| {
        if comm.rank() != 1 {
            comm.sum(&mut [1]);
        }
    });
}

#[test]
#[should_panic(expected = "rank 1 says why")]
fn a_rank_that_panics_ends_all() {
    run_ranks(3, |comm| {
        assert_ne!(comm.rank(), 1, "rank 1 says why");
        comm.sum(&mut [1]);
    });
}

#[test]
#[should_panic(expected = "different numbers of words")]
fn ranks_must_bring_equally_many_numbers() {
    run_ranks(2, |comm| comm.sum(&mut vec![0; comm.rank()]));
}
