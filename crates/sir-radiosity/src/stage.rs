//! The interface of all stages of lines.
//!
//! A stage is a number of lines that are traced in *rounds*. The lines of a round may be shared among any number of
//! workers, because they change only integers, and only by adding to them. Between two rounds the stage evaluates what
//! the lines have brought and decides about the next round. The caller divides the ranges of lines, adds up the tallies
//! of several processes, and saves the state. The stage knows nothing of this.

use std::ops::Range;

use crate::error::SolveError;
use crate::totals::StageTotals;
use crate::visitor::Visitor;
use crate::workers::{OneWorker, Workers};

/// A stage of lines: a shot, a transport, a measurement.
///
/// The order of the calls is: [`begin`](Self::begin) or [`restore`](Self::restore); then, in each round, until
/// [`advance`](Self::advance) returns false: [`trace`](Self::trace) for every unit of [`round`](Self::round),
/// [`visit_round`](Self::visit_round) to add up over processes, `advance`; finally [`visit_end`](Self::visit_end) and
/// [`finish`](Self::finish). [`run_stage`] is the shortest program that does so.
pub trait Stage: Sync + Sized {
    /// Parameters of the stage: the scene, the number of lines, the seed.
    type Settings;
    /// Starting point of the stage: the outcome of the stage before it, or `()`.
    type Input;
    /// Result of the stage.
    type Outcome;
    /// State of a chain of lines: [`AnyOrder`] if a line never depends on other lines of the same round.
    type Chain: Chain;

    /// Returns numbers that identify this stage and its settings. Saved states of other stages or settings cannot be
    /// restored.
    fn identity(settings: &Self::Settings) -> Vec<u64>;

    /// Prepares the first round.
    ///
    /// # Errors
    ///
    /// If there is nothing to trace, or the settings are invalid for the scene.
    fn begin(settings: Self::Settings, input: Self::Input, workers: &dyn Workers)
    -> Result<Self, SolveError>;

    /// Restores a stage from the state that [`visit`](Self::visit) passed to the visitor that saved it.
    ///
    /// # Errors
    ///
    /// As [`begin`](Self::begin).
    fn restore(
        settings: Self::Settings,
        workers: &dyn Workers,
        visitor: &mut dyn Visitor,
    ) -> Result<Self, SolveError>;

    /// Returns the units of the current round: lines, or groups of [`lines_per_unit`](Self::lines_per_unit) lines.
    fn round(&self) -> Range<u64>;

    /// Returns the expected number of units in all rounds, as far as it is known.
    fn expected(&self) -> u64 {
        self.round().end
    }

    /// Returns the number of lines per unit.
    fn lines_per_unit(&self) -> u64 {
        1
    }

    /// Returns the number of chains into which the units of a round are divided, as [`share`] divides them; 0 if any
    /// unit may be traced at any time. The units of a chain are traced in order, with its state.
    fn chains(&self) -> u64 {
        0
    }

    /// Returns the state of a chain before its first unit.
    fn chain(&self, number: u64) -> Self::Chain;

    /// Traces some units of the current round. `worker` is the number of the calling thread.
    fn trace(&self, worker: usize, chain: &mut Self::Chain, units: Range<u64>, totals: &mut StageTotals);

    /// Visits the part of the tallies of this round on which the next round depends.
    fn visit_round(&mut self, visitor: &mut dyn Visitor);

    /// Closes a round whose units are all traced and added up, and prepares the next one. Returns false if there is
    /// none.
    fn advance(&mut self, _workers: &dyn Workers) -> bool {
        false
    }

    /// Visits the part of the state on which only the outcome depends, and no round.
    fn visit_end(&mut self, _visitor: &mut dyn Visitor) {}

    /// Visits the whole state, except that of unfinished chains.
    fn visit(&mut self, visitor: &mut dyn Visitor);

    /// Returns the number of rounds or chains in which the lines were traced, for the report.
    fn batches(&self) -> u64 {
        1
    }

    /// Returns the outcome after the last round. `totals` are those of all workers.
    ///
    /// # Errors
    ///
    /// If a tally overflowed.
    fn finish(self, totals: StageTotals, workers: &dyn Workers) -> Result<Self::Outcome, SolveError>;
}

/// State of a chain of lines, which are traced in order.
pub trait Chain: Send {
    /// Visits the state, as numbers that every worker holds identically. The visitor must ensure that they do.
    fn visit(&mut self, visitor: &mut dyn Visitor);
}

/// The chain of a stage whose lines may be traced in any order. It has no state.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AnyOrder;

impl Chain for AnyOrder {
    fn visit(&mut self, _visitor: &mut dyn Visitor) {}
}

/// Runs a stage from its beginning to its end on the calling thread.
///
/// # Errors
///
/// As [`Stage::begin`] and [`Stage::finish`].
pub fn run_stage<S: Stage>(settings: S::Settings, input: S::Input) -> Result<S::Outcome, SolveError> {
    let mut stage = S::begin(settings, input, &OneWorker)?;
    let mut totals = StageTotals::default();
    loop {
        let round = stage.round();
        match stage.chains() {
            0 => stage.trace(0, &mut stage.chain(0), round, &mut totals),
            chains => {
                for number in 0..chains {
                    let units = chain_units(&round, number, chains);
                    stage.trace(0, &mut stage.chain(number), units, &mut totals);
                }
            }
        }
        if !stage.advance(&OneWorker) {
            return stage.finish(totals, &OneWorker);
        }
    }
}

/// Returns the units of a round that belong to a chain.
#[must_use]
pub fn chain_units(round: &Range<u64>, number: u64, chains: u64) -> Range<u64> {
    let units = share(round.end - round.start, number, chains);
    round.start + units.start..round.start + units.end
}

/// Returns the part of `0..count` that belongs to one of several workers or chains. The parts are consecutive and their
/// lengths differ by at most one.
#[must_use]
pub fn share(count: u64, part: u64, parts: u64) -> Range<u64> {
    let start = |p: u64| (u128::from(count) * u128::from(p) / u128::from(parts)) as u64;
    start(part)..start(part + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_cover_the_range_evenly() {
        for lines in [0, 1, 7, 1000, u64::MAX] {
            for workers in [1, 2, 3, 64] {
                let mut next = 0;
                for w in 0..workers {
                    let part = share(lines, w, workers);
                    assert_eq!(part.start, next);
                    assert!((part.end - part.start).abs_diff(lines / workers) <= 1);
                    next = part.end;
                }
                assert_eq!(next, lines);
            }
        }
    }
}
