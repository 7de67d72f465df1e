//! View factors are the same by any number of workers, and can be stopped.

use sir_parallel::{Communicator, RunError, view_factors};
use sir_radiosity::{Accuracy, Books, Grouping, Receiver, ViewFactorLines, ViewFactorSettings, ViewFactors};

use crate::jobs::{ROOM, crew};
use crate::observers::StopAfter;
use crate::ranks::run_ranks;

/// Until the errors are small, in several rounds.
const SETTINGS: ViewFactorSettings =
    ViewFactorSettings { accuracy: Some(Accuracy { error: 5e-3, relative: 0.05 }), lines: u64::MAX, seed: 4 };

/// Without any crew.
fn by_hand(grouping: &Grouping) -> ViewFactors {
    let mut stage = ViewFactorLines::new(&ROOM.model, grouping, SETTINGS).unwrap();
    let mut rounds = 0;
    loop {
        stage.trace(stage.lines(), &mut Books::default());
        rounds += 1;
        if !stage.advance() {
            assert!(rounds > 3);
            return stage.finish();
        }
    }
}

#[test]
fn any_number_of_workers_counts_the_same() {
    let grouping = Grouping::by_material(&ROOM.model.scene);
    let expected = by_hand(&grouping);
    // Something is blocked, something escapes, and all has one place.
    for receiver in [Receiver::Blocked, Receiver::Escaped] {
        assert!((0..expected.len()).any(|i| expected.count(i, receiver) > 0));
    }
    for threads in [1, 3] {
        for ranks in [1, 2, 3] {
            let outcomes = run_ranks(ranks, |comm| {
                view_factors(&ROOM.model, &grouping, SETTINGS, &mut crew(comm, threads)).unwrap()
            });
            outcomes.iter().for_each(|factors| assert_eq!(factors, &expected, "{threads}, {ranks}"));
        }
    }
}

#[test]
fn all_ranks_stop_when_one_wants_to() {
    let grouping = Grouping::by_material(&ROOM.model.scene);
    let outcomes = run_ranks(2, |comm| {
        let observer = StopAfter(if comm.rank() == 1 { 2 } else { u32::MAX });
        view_factors(&ROOM.model, &grouping, SETTINGS, &mut crew(comm, 1).watched_by(observer)).unwrap_err()
    });
    for error in outcomes {
        let RunError::Interrupted { done, total } = error else { panic!("{error}") };
        assert!(done > 0 && done < total, "{done} of {total}");
    }
}
