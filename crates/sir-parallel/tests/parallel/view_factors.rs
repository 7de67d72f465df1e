//! View factors do not depend on the number of workers, and the stage can be stopped.

use sir_parallel::{Communicator, Executor, RunError, Start};
use sir_radiosity::{
    Accuracy, AnyOrder, Grouping, OneWorker, Receiver, Stage, StageTotals, ViewFactorLines,
    ViewFactorSettings, ViewFactorTask, ViewFactors,
};

use crate::jobs::{ROOM, executor};
use crate::observers::StopAfter;
use crate::ranks::run_ranks;

/// A target for the errors, which takes several rounds.
const SETTINGS: ViewFactorSettings =
    ViewFactorSettings { accuracy: Some(Accuracy { error: 5e-3, relative: 0.05 }), lines: u64::MAX, seed: 4 };

fn task(grouping: &Grouping) -> ViewFactorTask<'_> {
    ViewFactorTask { model: &ROOM.model, grouping, settings: SETTINGS }
}

/// Runs the stage without an executor.
fn by_hand(grouping: &Grouping) -> ViewFactors {
    let mut stage = ViewFactorLines::begin(task(grouping), (), &OneWorker).unwrap();
    let mut totals = StageTotals::default();
    let mut rounds = 0;
    loop {
        stage.trace(0, &mut AnyOrder, stage.round(), &mut totals);
        rounds += 1;
        if !stage.advance(&OneWorker) {
            assert!(rounds > 3);
            return stage.finish(totals, &OneWorker).unwrap();
        }
    }
}

fn count(grouping: &Grouping, executor: &mut Executor<'_>) -> Result<ViewFactors, RunError> {
    executor.run::<ViewFactorLines<'_>>(task(grouping), Start::Fresh(())).map(|run| run.outcome)
}

#[test]
fn any_number_of_workers_counts_the_same() {
    let grouping = Grouping::by_material(&ROOM.model.scene);
    let expected = by_hand(&grouping);
    // Some lines are blocked and some escape.
    for receiver in [Receiver::Blocked, Receiver::Escaped] {
        assert!((0..expected.len()).any(|i| expected.count(i, receiver) > 0));
    }
    for threads in [1, 3] {
        for ranks in [1, 2, 3] {
            let outcomes = run_ranks(ranks, |comm| count(&grouping, &mut executor(comm, threads)).unwrap());
            outcomes.iter().for_each(|factors| assert_eq!(factors, &expected, "{threads}, {ranks}"));
        }
    }
}

#[test]
fn all_ranks_stop_when_one_wants_to() {
    let grouping = Grouping::by_material(&ROOM.model.scene);
    let outcomes = run_ranks(2, |comm| {
        let observer = StopAfter(if comm.rank() == 1 { 2 } else { u32::MAX });
        count(&grouping, &mut executor(comm, 1).watched_by(observer)).unwrap_err()
    });
    for error in outcomes {
        let RunError::Interrupted { done, total } = error else { panic!("{error}") };
        assert!(done > 0 && done < total, "{done} of {total}");
    }
}
