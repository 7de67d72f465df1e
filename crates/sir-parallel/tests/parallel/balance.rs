//! Power is conserved, and every line is traced exactly once.

use sir_radiosity::{Balance, Quanta};

use crate::jobs::{JOBS, Job, LINES, Outcome, ROOM, executor};
use crate::ranks::run_ranks;

/// Returns the outcome on two ranks with two threads each.
fn outcome(job: Job) -> Outcome {
    run_ranks(2, |comm| job.run(&ROOM, &mut executor(comm, 2), None).unwrap()).swap_remove(0)
}

fn wide(q: Quanta) -> [i128; 3] {
    q.0.map(i128::from)
}

#[test]
fn what_is_emitted_is_absorbed_or_blocked_or_escapes_or_is_unshot() {
    for job in JOBS {
        let Outcome { balance, .. } = outcome(job);
        let Balance { emitted, absorbed, blocked, escaped, unshot } = balance;
        for band in 0..3 {
            let parts = [absorbed, blocked, escaped, unshot].map(|q| wide(q)[band]);
            assert_eq!(wide(emitted)[band], parts.iter().sum::<i128>(), "{job:?}: {balance:?}");
        }
        assert!(balance.closes());
        // Otherwise the scene would not cover all cases.
        let ends = [emitted, absorbed, escaped];
        assert!(ends.iter().all(|q| q.0.iter().all(|&q| q > 0)), "{job:?}: {balance:?}");
        assert_ne!(unshot, Quanta::ZERO, "{job:?}");
        // Light from outside is blocked by the backs of walls, reflected light by the back of the lamp.
        assert_ne!(blocked, Quanta::ZERO, "{job:?}: {balance:?}");
    }
}

#[test]
fn batches_emit_what_the_first_shot_has_left_unshot() {
    assert_eq!(outcome(Job::Batches).balance.emitted, ROOM.shot.balance.unshot);
}

#[test]
fn all_lines_are_traced_once() {
    for job in JOBS {
        let Outcome { counts, .. } = outcome(job);
        assert_eq!(counts.lines, LINES, "{job:?}");
        // No line through the hull of the room misses it; some local lines do.
        let some =
            if matches!(job, Job::FirstShot | Job::FocusedShot | Job::SecondShot) { 1..LINES } else { 0..1 };
        assert!(some.contains(&counts.empty) && counts.crossings > 0, "{job:?}: {counts:?}");
    }
}

/// Received power is either absorbed or reflected, up to one rounding per crossing and the corrections at the end of a
/// stage.
#[test]
fn what_is_received_is_absorbed_or_reflected() {
    for job in JOBS {
        let Outcome { received, balance, counts, .. } = outcome(job);
        let mut absorbed = [0.0; 3];
        ROOM.model.mesh.for_each_side(|triangle, _, _, side| {
            let reflectance = ROOM.model.scene.material(triangle).reflectance;
            let before = match job {
                Job::FirstShot | Job::FocusedShot => Quanta::ZERO,
                _ => ROOM.shot.received.power[side.index()],
            };
            let new = received.power[side.index()] - before;
            let kept = |band: usize| new.0[band] as f64 * (1.0 - reflectance[band]);
            absorbed.iter_mut().enumerate().for_each(|(band, sum)| *sum += kept(band));
        });
        for (band, absorbed) in absorbed.into_iter().enumerate() {
            let difference = absorbed - balance.absorbed.0[band] as f64;
            // At the end of batches the ratio estimator is applied. Surfaces that absorb more may then have received
            // slightly more.
            let corrected =
                if matches!(job, Job::Batches | Job::FocusedBatches) { 1e-2 * absorbed } else { 0.0 };
            let rounding = 4.0 * counts.crossings as f64 + corrected;
            assert!(difference.abs() <= rounding, "{job:?}: {difference}, {absorbed}");
        }
    }
}
