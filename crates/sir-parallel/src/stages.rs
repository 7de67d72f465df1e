//! The stages of the solver, run by a crew.

use std::ops::Range;

use sir_lines::{Domain, Focus, GlobalLines, LocalLines};
use sir_radiosity::{
    Batches, Books, FirstShot, FirstShotTally, Model, Multipath, MultipathSettings, SecondShot, Shot, Totals,
    Transported, Visitor,
};

use crate::checkpoint::Saved;
use crate::crew::{Crew, StageTime};
use crate::crew::{Position, Shift, Work, each};
use crate::error::RunError;
use crate::replicas::Replicas;

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

/// Local lines, and what they bring.
struct LocalWork<'s, 'm> {
    lines: &'s FirstShot<'m>,
    tally: FirstShotTally,
    /// What was brought before.
    before: Option<&'s mut Shot>,
}

impl Work for LocalWork<'_, '_> {
    fn trace(&self, thread: usize, lines: Range<u64>, books: &mut Books) {
        self.lines.trace(thread, lines, &self.tally, books);
    }

    fn visit(&mut self, visitor: &mut dyn Visitor) {
        if let Some(shot) = &mut self.before {
            shot.visit(visitor);
        }
        self.tally.visit(visitor);
    }
}

/// What is known of a stage of local lines when it begins or goes on.
#[derive(Default)]
struct LocalState {
    position: Position,
    tally: Option<FirstShotTally>,
}

impl LocalState {
    /// The beginning, or what was saved, with what was brought before.
    fn restored(
        model: &Model,
        mut before: Option<&mut Shot>,
        shift: &mut Shift<'_, '_>,
        saved: Option<Saved>,
    ) -> Result<Self, RunError> {
        let Some(saved) = saved else { return Ok(Self::default()) };
        let mut position = Position::default();
        let mut tally = FirstShotTally::to_restore(model, shift.threads());
        shift.restore(saved, &mut position, &mut |visitor| {
            if let Some(shot) = &mut before {
                shot.visit(visitor);
            }
            tally.visit(visitor);
        })?;
        Ok(Self { position, tally: Some(tally) })
    }

    /// Traces all lines; returns what they have brought.
    fn trace(
        self,
        lines: &FirstShot<'_>,
        before: Option<&mut Shot>,
        shift: &mut Shift<'_, '_>,
    ) -> Result<(FirstShotTally, Books), RunError> {
        let mut position = self.position;
        let tally = self.tally.unwrap_or_else(|| lines.tally(shift.threads()));
        let mut work = LocalWork { lines, tally, before };
        shift.trace(&mut work, &mut position, lines.lines())?;
        let LocalWork { mut tally, .. } = work;
        shift.add_up(|visitor| {
            position.books.visit(visitor);
            tally.visit(visitor);
        });
        Ok((tally, position.books))
    }
}

/// Adds to the numbers that tell a stage from others what tells its focus from others.
fn with_focus(mut identity: Vec<u64>, focus: Option<&Focus>) -> Vec<u64> {
    identity.extend(focus.iter().flat_map(|focus| focus.identity()));
    identity
}

/// Runs a first shot of some lines, maybe with a focus, or goes on with one that was saved.
///
/// # Errors
///
/// If nothing emits, a tally overflowed, the observer wants to stop, or a checkpoint cannot be saved or restored.
pub fn first_shot(
    model: &Model,
    lines: impl Into<LocalLines>,
    seed: u64,
    crew: &mut Crew<'_>,
    saved: Option<Saved>,
) -> Result<StageRun<Shot>, RunError> {
    let lines = lines.into();
    let identity = vec![1, model.mesh.side_count() as u64, lines.count, seed];
    let mut shift = Shift::begin(crew, lines.count, &with_focus(identity, lines.focus.as_ref()));
    let state = LocalState::restored(model, None, &mut shift, saved)?;
    let stage = FirstShot::new(model, lines, seed)?;
    let (tally, books) = state.trace(&stage, None, &mut shift)?;
    let outcome = stage.finish(tally, books)?;
    Ok(StageRun { outcome, time: shift.time(), batches: 1 })
}

/// Lets the brightest patches send what they reflect of a first shot along some local lines, with the focus of that shot, or goes on with a second shot
/// that was saved; `shot` is then not looked at.
///
/// # Errors
///
/// If a tally overflowed, the observer wants to stop, or a checkpoint cannot be saved or restored.
pub fn second_shot(
    model: &Model,
    mut shot: Shot,
    lines: impl Into<LocalLines>,
    seed: u64,
    crew: &mut Crew<'_>,
    saved: Option<Saved>,
) -> Result<StageRun<Shot>, RunError> {
    let lines = lines.into();
    let identity = vec![4, model.mesh.side_count() as u64, lines.count, seed];
    let mut shift = Shift::begin(crew, lines.count, &with_focus(identity, lines.focus.as_ref()));
    let state = LocalState::restored(model, Some(&mut shot), &mut shift, saved)?;
    // Which patches are bright follows from the first shot.
    let stage = SecondShot::new(model, &shot, lines, seed);
    let (tally, books) = state.trace(stage.lines(), Some(&mut shot), &mut shift)?;
    let outcome = stage.finish(shot, tally, books)?;
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

/// Transports the reflected light of a first shot along `lines` global lines in frozen batches, drawn `through` a domain or also a focus, or goes on with a transport
/// that was saved; `shot` is then not looked at.
///
/// # Errors
///
/// If a tally overflowed, the observer wants to stop, or a checkpoint cannot be saved or restored.
pub fn batches(
    model: &Model,
    shot: Shot,
    lines: u64,
    through: impl Into<GlobalLines>,
    seed: u64,
    crew: &mut Crew<'_>,
    saved: Option<Saved>,
) -> Result<StageRun<Transported>, RunError> {
    let through = through.into();
    let sides = model.mesh.side_count() as u64;
    let identity = vec![2, sides, lines, seed, identity_of(through.domain())];
    let mut shift = Shift::begin(crew, lines, &with_focus(identity, through.focus()));
    let mut stage = Batches::new(model, shot, lines, through, seed, shift.threads());
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
