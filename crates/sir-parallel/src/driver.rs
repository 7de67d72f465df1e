//! Driver that runs any stage with an executor, from the start or from a checkpoint.

use sir_radiosity::{SolveError, Stage, StageTotals};

use crate::checkpoint::Saved;
use crate::error::{CheckpointError, RunError};
use crate::executor::Executor;
use crate::remaining::Remaining;
use crate::slices::Slices;
use crate::time::StageTime;

/// Starting point of a stage.
#[derive(Debug)]
pub enum Start<I> {
    /// Input of the stage: the outcome of the previous stage, or `()`.
    Fresh(I),
    /// Checkpoint of the same stage, which holds everything that the stage needs.
    Resumed(Saved),
}

/// Outcome of a stage, with its run time.
#[derive(Clone, Debug)]
pub struct StageRun<T> {
    /// Outcome of the stage, the same on all ranks.
    pub outcome: T,
    /// Wall-clock time.
    pub time: StageTime,
    /// Number of batches or replicas in which the lines were traced; 1 if lines are independent of each other.
    pub batches: u64,
}

/// State of a running stage on this rank.
struct State<S: Stage> {
    stage: S,
    remaining: Remaining<S::Chain>,
    /// Totals of this rank.
    totals: StageTotals,
}

impl Executor<'_> {
    /// Runs a stage. The outcome is the same on all ranks, and for any number of ranks and threads.
    ///
    /// # Errors
    ///
    /// If the stage cannot begin, a tally overflows, the observer asks to stop, or a checkpoint cannot be saved or
    /// restored.
    pub fn run<S: Stage>(
        &mut self,
        settings: S::Settings,
        start: Start<S::Input>,
    ) -> Result<StageRun<S::Outcome>, RunError> {
        let slices = &mut Slices::begin(self, &S::identity(&settings));
        let mut state = match start {
            Start::Fresh(input) => State::<S>::begin(settings, input, slices)?,
            Start::Resumed(saved) => State::restore(settings, saved, slices)?,
        };
        loop {
            state.trace_round(slices)?;
            if !state.next_round(slices) {
                return state.finish(slices);
            }
        }
    }
}

impl<S: Stage> State<S> {
    fn begin(settings: S::Settings, input: S::Input, slices: &Slices<'_, '_>) -> Result<Self, SolveError> {
        let stage = S::begin(settings, input, &slices.threads())?;
        let remaining = Remaining::of(&stage, slices.comm());
        Ok(Self { stage, remaining, totals: StageTotals::default() })
    }

    fn restore(settings: S::Settings, saved: Saved, slices: &mut Slices<'_, '_>) -> Result<Self, RunError> {
        let (threads, comm) = (slices.threads(), slices.comm());
        let restored = slices.restore(saved, |visitor| {
            let mut totals = StageTotals::default();
            totals.visit(visitor);
            let stage = S::restore(settings, &threads, visitor)?;
            let mut remaining = Remaining::of(&stage, comm);
            remaining.restore(&stage, visitor);
            Ok::<_, SolveError>(Self { stage, remaining, totals })
        })?;
        Ok(restored?)
    }

    /// Returns the number of lines done and the expected total, if `left` units of this round are left.
    fn progress(&self, left: u64) -> (u64, u64) {
        let weight = self.stage.lines_per_unit();
        let done = self.stage.round().end - left;
        (done.saturating_mul(weight), self.stage.expected().saturating_mul(weight))
    }

    /// Traces the remaining units of the round.
    fn trace_round(&mut self, slices: &mut Slices<'_, '_>) -> Result<(), RunError> {
        let mut left = self.remaining.left(slices);
        while left > 0 {
            let control = slices.agree();
            if control.save {
                self.save(slices)?;
            }
            if control.stop {
                let (done, total) = self.progress(left);
                return Err(RunError::Interrupted { done, total });
            }
            self.remaining.trace(&self.stage, &control, left, slices, &mut self.totals);
            left = self.remaining.left(slices);
            let (done, total) = self.progress(left);
            slices.progress(done, total);
        }
        if self.stage.round().end >= self.stage.expected() && slices.is_due_at_end() {
            self.save(slices)?;
        }
        Ok(())
    }

    /// Sums the tallies of the round over all ranks and advances to the next round. Returns false if there is none.
    fn next_round(&mut self, slices: &mut Slices<'_, '_>) -> bool {
        slices.add_up(|visitor| self.stage.visit_round(visitor));
        let another = self.stage.advance(&slices.threads());
        if another {
            self.remaining = Remaining::of(&self.stage, slices.comm());
        }
        another
    }

    fn save(&mut self, slices: &mut Slices<'_, '_>) -> Result<(), CheckpointError> {
        let table = self.remaining.table(slices);
        let Self { stage, remaining, totals } = self;
        let mut totals = *totals;
        slices.save(&mut |visitor| {
            totals.visit(visitor);
            stage.visit(visitor);
            remaining.save(stage, &table, visitor);
        })
    }

    fn finish(mut self, slices: &mut Slices<'_, '_>) -> Result<StageRun<S::Outcome>, RunError> {
        slices.add_up(|visitor| {
            self.totals.visit(visitor);
            self.stage.visit_end(visitor);
        });
        let batches = self.stage.batches();
        let outcome = self.stage.finish(self.totals, &slices.threads())?;
        Ok(StageRun { outcome, time: slices.time(), batches })
    }
}
