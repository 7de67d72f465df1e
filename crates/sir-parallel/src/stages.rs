//! The stages of the solver, run by a crew.

use std::ops::Range;

use sir_lines::Domain;
use sir_radiosity::{
    Batches, Books, FirstShot, FirstShotTally, Model, Multipath, MultipathSettings, SecondShot, Shot, Totals,
    Transported, Visitor,
};

use crate::crew::{Position, Shift, Work, each};
use crate::replicas::Replicas;
use crate::{Crew, RunError, Saved, StageTime};

/// The outcome of a stage and how long it took.
#[derive(Clone, Debug)]
pub struct StageRun<T> {
    /// What the stage made: the same on all ranks.
    pub outcome: T,
    /// Wall-clock time.
    pub time: StageTime,
    /// Batches in which the lines were traced: 1 where what a line carries does not depend on other lines, and
    /// the number of replicas in multipath.
    pub batches: u64,
}

struct FirstShotWork<'m> {
    stage: FirstShot<'m>,
    tally: FirstShotTally,
}

impl Work for FirstShotWork<'_> {
    fn trace(&self, thread: usize, lines: Range<u64>, books: &mut Books) {
        self.stage.trace(thread, lines, &self.tally, books);
    }

    fn visit(&mut self, visitor: &mut dyn Visitor) {
        self.tally.visit(visitor);
    }
}

/// Runs a first shot of `lines` lines, or goes on with one that was saved.
///
/// # Errors
///
/// If nothing emits, a tally overflowed, the observer wants to stop, or a checkpoint cannot be saved or restored.
pub fn first_shot(
    model: &Model,
    lines: u64,
    seed: u64,
    crew: &mut Crew<'_>,
    saved: Option<Saved>,
) -> Result<StageRun<Shot>, RunError> {
    let mut shift = Shift::begin(crew, lines, &[1, model.mesh.side_count() as u64, lines, seed]);
    let stage = FirstShot::new(model, lines, seed)?;
    let mut work = FirstShotWork { tally: stage.tally(shift.threads()), stage };
    let mut position = Position::default();
    if let Some(saved) = saved {
        shift.restore(saved, &mut position, &mut |visitor| work.visit(visitor))?;
    }
    shift.trace(&mut work, &mut position, lines)?;
    shift.add_up(|visitor| {
        position.books.visit(visitor);
        work.visit(visitor);
    });
    let FirstShotWork { stage, tally } = work;
    let outcome = stage.finish(tally, position.books)?;
    Ok(StageRun { outcome, time: shift.time(), batches: 1 })
}

struct SecondShotWork<'m> {
    stage: SecondShot<'m>,
    tally: FirstShotTally,
}

impl Work for SecondShotWork<'_> {
    fn trace(&self, thread: usize, lines: Range<u64>, books: &mut Books) {
        self.stage.trace(thread, lines, &self.tally, books);
    }

    fn visit(&mut self, visitor: &mut dyn Visitor) {
        self.stage.visit(visitor);
        self.tally.visit(visitor);
    }
}

/// Lets the brightest patches send what they reflect of a first shot along `lines` local lines, or goes on with a second shot
/// that was saved; `shot` is then not looked at.
///
/// # Errors
///
/// If a tally overflowed, the observer wants to stop, or a checkpoint cannot be saved or restored.
pub fn second_shot(
    model: &Model,
    mut shot: Shot,
    lines: u64,
    seed: u64,
    crew: &mut Crew<'_>,
    saved: Option<Saved>,
) -> Result<StageRun<Shot>, RunError> {
    let mut shift = Shift::begin(crew, lines, &[4, model.mesh.side_count() as u64, lines, seed]);
    let mut position = Position::default();
    let threads = shift.threads();
    let work = |shot: Shot| {
        let stage = SecondShot::new(model, shot, lines, seed);
        SecondShotWork { tally: stage.tally(threads), stage }
    };
    let mut work = match saved {
        None => work(shot),
        Some(saved) => {
            let mut restored = None;
            shift.restore(saved, &mut position, &mut |visitor| {
                // Which patches are bright follows from the first shot.
                shot.visit(visitor);
                let mut work = work(shot.clone());
                work.tally.visit(visitor);
                restored = Some(work);
            })?;
            restored.unwrap_or_else(|| work(shot))
        }
    };
    let lines = work.stage.lines();
    shift.trace(&mut work, &mut position, lines)?;
    shift.add_up(|visitor| {
        position.books.visit(visitor);
        work.visit(visitor);
    });
    let SecondShotWork { stage, tally } = work;
    let outcome = stage.finish(tally, position.books)?;
    Ok(StageRun { outcome, time: shift.time(), batches: 1 })
}

/// A number that tells the domains of one scene apart: their surface, to the last bit.
fn identity_of(domain: &Domain) -> u64 {
    domain.surface().to_bits()
}

impl Work for Batches<'_> {
    fn trace(&self, thread: usize, lines: Range<u64>, books: &mut Books) {
        self.trace(thread, lines, books);
    }

    fn visit(&mut self, visitor: &mut dyn Visitor) {
        self.visit(visitor);
    }
}

/// Transports the reflected light of a first shot along `lines` global lines in frozen batches, or goes on with a transport
/// that was saved; `shot` is then not looked at.
///
/// # Errors
///
/// If a tally overflowed, the observer wants to stop, or a checkpoint cannot be saved or restored.
pub fn batches(
    model: &Model,
    shot: Shot,
    lines: u64,
    domain: Domain,
    seed: u64,
    crew: &mut Crew<'_>,
    saved: Option<Saved>,
) -> Result<StageRun<Transported>, RunError> {
    let mut shift =
        Shift::begin(crew, lines, &[2, model.mesh.side_count() as u64, lines, seed, identity_of(&domain)]);
    let mut stage = Batches::new(model, shot, lines, domain, seed, shift.threads());
    let mut position = Position::default();
    let open = |stage: &mut Batches<'_>, shift: &mut Shift<'_, '_>| {
        each(stage.parts(shift.threads()), |mut part| part.open());
    };
    match saved {
        None => open(&mut stage, &mut shift),
        Some(saved) => shift.restore(saved, &mut position, &mut |visitor| stage.visit(visitor))?,
    }
    loop {
        let end = stage.lines().end;
        shift.trace(&mut stage, &mut position, end)?;
        shift.add_up(|visitor| stage.visit_batch(visitor));
        let mut totals = Totals::default();
        let parts = stage.parts(shift.threads());
        each(parts, |mut part| part.close()).into_iter().for_each(|part| totals += part);
        if !stage.advance(totals) {
            break;
        }
        open(&mut stage, &mut shift);
    }
    shift.add_up(|visitor| {
        position.books.visit(visitor);
        stage.visit_squares(visitor);
    });
    let batches = stage.number() + 1;
    let outcome = stage.finish(position.books)?;
    Ok(StageRun { outcome, time: shift.time(), batches })
}

/// Transports the reflected light of a first shot by multipath in replicas, or goes on with a transport that was saved;
/// `shot` is then not looked at. Each thread works on one replica at a time.
///
/// # Errors
///
/// If a tally overflowed, the observer wants to stop, or a checkpoint cannot be saved or restored.
pub fn multipath(
    model: &Model,
    shot: Shot,
    settings: MultipathSettings,
    seed: u64,
    crew: &mut Crew<'_>,
    saved: Option<Saved>,
) -> Result<StageRun<Transported>, RunError> {
    let MultipathSettings { lines, tail, replicas: batches, .. } = settings;
    let domain = identity_of(&settings.domain);
    let identity = [3, model.mesh.side_count() as u64, lines, seed, tail, batches, domain];
    let mut shift = Shift::begin(crew, lines, &identity);
    let stage = Multipath::new(model, shot, settings.clone(), seed, shift.threads());
    let mut replicas = Replicas::new(stage, settings, shift.comm());
    if let Some(saved) = saved {
        replicas.restore(saved, &mut shift)?;
    }
    replicas.run(&mut shift)?;
    let outcome = replicas.finish(&mut shift)?;
    Ok(StageRun { outcome, time: shift.time(), batches })
}
