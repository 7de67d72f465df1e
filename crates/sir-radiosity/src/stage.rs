//! What every stage of lines has in common.
//!
//! A stage is a number of lines that are traced in *rounds*. The lines of a round may be shared among any number of
//! workers, since what they change are integers to which they only add. Between two rounds the stage looks at what the lines have
//! brought and decides about the next one. Whoever runs a stage cuts the ranges of lines, adds up what several processes
//! have, and saves the state; the stage knows nothing of this.

use std::ops::Range;

use crate::error::SolveError;
use crate::totals::StageTotals;
use crate::visitor::Visitor;

/// A stage of lines: a shot, a transport, a measurement.
///
/// The calls, in order: [`begin`](Self::begin) or [`restore`](Self::restore); then per round, until
/// [`advance`](Self::advance) returns false: [`trace`](Self::trace) for every unit of [`round`](Self::round),
/// [`visit_round`](Self::visit_round) to add up over processes, `advance`; in the end [`visit_end`](Self::visit_end) and
/// [`finish`](Self::finish). [`run_stage`] is the shortest program that does so.
pub trait Stage: Sync + Sized {
    /// What is asked for: the scene, the number of lines, the seed.
    type Settings;
    /// What the stage starts from: the outcome of the stage before it, or `()`.
    type Input;
    /// What the stage makes.
    type Outcome;
    /// State of a chain of lines: [`AnyOrder`] if what a line does never depends on other lines of the same round.
    type Chain: Chain;

    /// Returns numbers that tell this stage and its settings from all others, whose saved states it cannot restore.
    fn identity(settings: &Self::Settings) -> Vec<u64>;

    /// Prepares the first round.
    ///
    /// # Errors
    ///
    /// If there is nothing to trace, or the settings make no sense for the scene.
    fn begin(settings: Self::Settings, input: Self::Input, workers: &dyn Workers)
    -> Result<Self, SolveError>;

    /// Returns the stage with the state that [`visit`](Self::visit) has shown to the visitor who saved it.
    ///
    /// # Errors
    ///
    /// As [`begin`](Self::begin).
    fn restore(
        settings: Self::Settings,
        workers: &dyn Workers,
        visitor: &mut dyn Visitor,
    ) -> Result<Self, SolveError>;

    /// Returns the units of the current round: lines, or what [`lines_per_unit`](Self::lines_per_unit) says.
    fn round(&self) -> Range<u64>;

    /// Returns how many units there will be in all rounds, as far as that is known.
    fn expected(&self) -> u64 {
        self.round().end
    }

    /// Returns how many lines a unit is.
    fn lines_per_unit(&self) -> u64 {
        1
    }

    /// Returns into how many chains the units of a round are divided, as [`share`] divides them. The units of a chain are
    /// traced in order, with its state. 0 if any unit may be traced at any time.
    fn chains(&self) -> u64 {
        0
    }

    /// Returns the state of a chain before its first unit.
    fn chain(&self, number: u64) -> Self::Chain;

    /// Traces some units of the current round; `worker` is the number of the thread that does.
    fn trace(&self, worker: usize, chain: &mut Self::Chain, units: Range<u64>, totals: &mut StageTotals);

    /// Shows what the lines of this round have brought, as far as the next round depends on it.
    fn visit_round(&mut self, visitor: &mut dyn Visitor);

    /// Closes a round whose units are all traced and added up, and prepares the next one. Returns false if there is none.
    fn advance(&mut self, _workers: &dyn Workers) -> bool {
        false
    }

    /// Shows what only the outcome depends on, and no round.
    fn visit_end(&mut self, _visitor: &mut dyn Visitor) {}

    /// Shows the whole state, except that of the chains under way.
    fn visit(&mut self, visitor: &mut dyn Visitor);

    /// Returns how many rounds or chains the lines were traced in, for the report.
    fn batches(&self) -> u64 {
        1
    }

    /// Returns the outcome after the last round. `totals` are those of all workers.
    ///
    /// # Errors
    ///
    /// If a tally overflowed.
    fn finish(self, totals: StageTotals) -> Result<Self::Outcome, SolveError>;
}

/// State of a chain of lines, which are traced in order.
pub trait Chain: Send {
    /// Shows the state. The visitor is told that all workers hold it identically, and has to see to it that they do.
    fn visit(&mut self, visitor: &mut dyn Visitor);
}

/// The chain of a stage whose lines may be traced in any order: it has no state.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AnyOrder;

impl Chain for AnyOrder {
    fn visit(&mut self, _visitor: &mut dyn Visitor) {}
}

/// A job for one of the [`Workers`].
pub type Job<'a> = Box<dyn FnOnce() + Send + 'a>;

/// The threads of this process, for work that is not lines.
pub trait Workers: Sync {
    /// Returns how many there are: at least 1.
    fn count(&self) -> usize;

    /// Does all jobs, at the same time if there are several workers.
    fn run(&self, jobs: Vec<Job<'_>>);
}

/// The calling thread alone.
#[derive(Clone, Copy, Debug, Default)]
pub struct OneWorker;

impl Workers for OneWorker {
    fn count(&self) -> usize {
        1
    }

    fn run(&self, jobs: Vec<Job<'_>>) {
        jobs.into_iter().for_each(|job| job());
    }
}

/// Applies a function to all parts, one job each, and returns the results in order.
pub(crate) fn map_parts<P: Send, T: Send>(
    workers: &dyn Workers,
    parts: impl Iterator<Item = P>,
    function: impl Fn(P) -> T + Sync,
) -> Vec<T> {
    let mut parts: Vec<(Option<P>, Option<T>)> = parts.map(|part| (Some(part), None)).collect();
    let function = &function;
    let jobs = parts
        .iter_mut()
        .map(|(part, result)| -> Job<'_> { Box::new(move || *result = part.take().map(function)) });
    workers.run(jobs.collect());
    parts.into_iter().filter_map(|(_, result)| result).collect()
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
            return stage.finish(totals);
        }
    }
}

/// Returns the units of a round that belong to a chain.
#[must_use]
pub fn chain_units(round: &Range<u64>, number: u64, chains: u64) -> Range<u64> {
    let units = share(round.end - round.start, number, chains);
    round.start + units.start..round.start + units.end
}

/// Returns the part of `0..count` that belongs to one of several workers or chains. The parts follow each other and differ in
/// length by one at most.
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

    #[test]
    fn parts_keep_their_order() {
        let doubled = map_parts(&OneWorker, 0..7, |k| 2 * k);
        assert_eq!(doubled, [0, 2, 4, 6, 8, 10, 12]);
    }
}
