//! Remaining units of a round, and their distribution over ranks and threads.

use std::collections::VecDeque;
use std::ops::Range;
use std::sync::{Mutex, PoisonError};

use sir_radiosity::{Chain, Stage, StageTotals, Visitor, chain_units, share};

use crate::communicator::Communicator;
use crate::slices::{Control, Slices};
use crate::threads::{each, trace_blocks};

/// Units of a round that are still to be traced.
pub(crate) struct Remaining<C> {
    round: Range<u64>,
    lines_per_unit: u64,
    rank: u64,
    ranks: u64,
    units: Units<C>,
}

/// Remaining units of a round, by the order in which they must be traced.
enum Units<C> {
    /// Any order: the units from `next` on are left. Ranks trace equal shares of every slice, threads take blocks of
    /// them.
    AnyOrder { next: u64 },
    /// Chains. A chain belongs to the rank that is its number modulo the number of ranks. The threads of the rank take
    /// the waiting chains one after the other.
    Chains { count: u64, waiting: VecDeque<Task<C>> },
}

/// Unfinished chain of this rank. It has a state once it is started.
struct Task<C> {
    number: u64,
    units: Range<u64>,
    state: Option<C>,
}

impl<C> Task<C> {
    fn left(&self) -> u64 {
        self.units.end - self.units.start
    }
}

impl<C: Chain> Remaining<C> {
    /// Returns all units of the current round.
    pub(crate) fn of<S: Stage<Chain = C>>(stage: &S, comm: &dyn Communicator) -> Self {
        let (rank, ranks) = (comm.rank() as u64, comm.size() as u64);
        let round = stage.round();
        let units = match stage.chains() {
            0 => Units::AnyOrder { next: round.start },
            count => {
                let task = |number| Task { number, units: chain_units(&round, number, count), state: None };
                Units::Chains { count, waiting: (rank..count).step_by(ranks as usize).map(task).collect() }
            }
        };
        Self { round, lines_per_unit: stage.lines_per_unit(), rank, ranks, units }
    }

    /// Returns the number of units left on all ranks together. All ranks must call this.
    pub(crate) fn left(&self, slices: &mut Slices<'_, '_>) -> u64 {
        match &self.units {
            Units::AnyOrder { next } => self.round.end - next,
            Units::Chains { waiting, .. } => {
                let mut left = [waiting.iter().map(Task::left).sum::<u64>() as i64];
                slices.communicate(|comm| comm.sum(&mut left));
                left[0] as u64
            }
        }
    }

    /// Traces this rank's part of about `control.lines` lines of all ranks together. `left` is the number of units left
    /// on all ranks.
    pub(crate) fn trace<S: Stage<Chain = C>>(
        &mut self,
        stage: &S,
        control: &Control,
        left: u64,
        slices: &mut Slices<'_, '_>,
        totals: &mut StageTotals,
    ) {
        let threads = slices.threads().0.get();
        let (lines, weight) = (control.lines, self.lines_per_unit);
        match &mut self.units {
            Units::AnyOrder { next } => {
                // At least one unit for each thread, so that none is idle.
                let count = (lines / weight).max(control.workers).min(left);
                let mine = share(count, self.rank, self.ranks);
                let mine = *next + mine.start..*next + mine.end;
                let trace = |thread, units, totals: &mut StageTotals| {
                    stage.trace(thread, &mut stage.chain(0), units, totals);
                };
                *totals += slices.tracing(|| trace_blocks(threads, mine, weight, trace));
                *next += count;
                slices.traced(count * weight);
            }
            Units::Chains { waiting, .. } => {
                let quota = (lines / (control.workers * weight)).max(1);
                *totals += slices.tracing(|| trace_chains(stage, threads, waiting, quota));
                slices.traced(lines.min(left * weight));
            }
        }
    }

    /// Returns the number of units left in each chain, for the chains of all ranks.
    pub(crate) fn table(&self, slices: &mut Slices<'_, '_>) -> Vec<i64> {
        let Units::Chains { count, waiting } = &self.units else { return Vec::new() };
        let mut left = vec![0; *count as usize];
        for task in waiting {
            left[task.number as usize] = task.left() as i64;
        }
        slices.communicate(|comm| comm.sum(&mut left));
        left
    }

    /// Passes the remaining units to a visitor that saves them. `table` has the number of units left in each chain.
    pub(crate) fn save<S: Stage<Chain = C>>(&mut self, stage: &S, table: &[i64], visitor: &mut dyn Visitor) {
        match &mut self.units {
            Units::AnyOrder { next } => visitor.same(&mut [*next as i64]),
            Units::Chains { count, waiting } => {
                visitor.same(&mut table.to_vec());
                for number in under_way(table, &self.round, *count) {
                    // All ranks take part. The ranks that do not own the chain add zeros.
                    let mine = waiting.iter_mut().find(|task| task.number == number);
                    match mine.and_then(|task| task.state.as_mut()) {
                        Some(state) => state.visit(&mut AsSum { visitor, mine: true }),
                        None => stage.chain(number).visit(&mut AsSum { visitor, mine: false }),
                    }
                }
            }
        }
    }

    /// Restores the remaining units of a checkpoint.
    pub(crate) fn restore<S: Stage<Chain = C>>(&mut self, stage: &S, visitor: &mut dyn Visitor) {
        match &mut self.units {
            Units::AnyOrder { next } => {
                let mut word = [*next as i64];
                visitor.same(&mut word);
                *next = (word[0] as u64).clamp(self.round.start, self.round.end);
            }
            Units::Chains { count, waiting } => {
                let mut table = vec![0; *count as usize];
                visitor.same(&mut table);
                let mut first = Vec::new();
                for number in under_way(&table, &self.round, *count) {
                    let mut state = stage.chain(number);
                    state.visit(visitor);
                    if number % self.ranks == self.rank {
                        let units = chain_units(&self.round, number, *count);
                        let start = units.end - table[number as usize] as u64;
                        first.push(Task { number, units: start..units.end, state: Some(state) });
                    }
                }
                let untouched = |task: &Task<C>| {
                    let left = table[task.number as usize];
                    left > 0 && left as u64 == task.left()
                };
                waiting.retain(untouched);
                first.into_iter().rev().for_each(|task| waiting.push_front(task));
            }
        }
    }
}

/// Returns the numbers of the chains that are started but not done.
fn under_way(left: &[i64], round: &Range<u64>, count: u64) -> Vec<u64> {
    let length = |number: u64| {
        let units = chain_units(round, number, count);
        (units.end - units.start) as i64
    };
    (0..count).filter(|&number| (1..length(number)).contains(&left[number as usize])).collect()
}

/// Traces up to `quota` units on every thread, from one or several chains.
fn trace_chains<S: Stage>(
    stage: &S,
    threads: usize,
    waiting: &mut VecDeque<Task<S::Chain>>,
    quota: u64,
) -> StageTotals {
    let threads = threads.min(waiting.len());
    let queue = Mutex::new(std::mem::take(waiting));
    let take = || queue.lock().unwrap_or_else(PoisonError::into_inner).pop_front();
    let work = |thread| {
        let (mut totals, mut left) = (StageTotals::default(), quota);
        while let Some(Task { number, units, state }) = take() {
            let mut state = state.unwrap_or_else(|| stage.chain(number));
            let now = units.start..units.end.min(units.start.saturating_add(left));
            let units = now.end..units.end;
            left -= now.end - now.start;
            stage.trace(thread, &mut state, now, &mut totals);
            if !units.is_empty() {
                return (totals, Some(Task { number, units, state: Some(state) }));
            }
            if left == 0 {
                break;
            }
        }
        (totals, None)
    };
    let outcomes = each(0..threads, work);
    *waiting = queue.into_inner().unwrap_or_else(PoisonError::into_inner);
    let mut totals = StageTotals::default();
    for (part, task) in outcomes.into_iter().rev() {
        totals += part;
        task.into_iter().for_each(|task| waiting.push_front(task));
    }
    totals
}

/// Visitor that passes on the numbers of one rank as a sum over all ranks.
struct AsSum<'a> {
    visitor: &'a mut dyn Visitor,
    mine: bool,
}

impl Visitor for AsSum<'_> {
    fn sum(&mut self, words: &mut [i64]) {
        if !self.mine {
            words.fill(0);
        }
        self.visitor.sum(words);
    }

    fn same(&mut self, words: &mut [i64]) {
        self.sum(words);
    }
}
