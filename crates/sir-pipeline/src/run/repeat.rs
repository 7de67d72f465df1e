//! The stage `Repeat`: runs its stages repeatedly. The result is the mean.

use std::time::{Duration, Instant};

use sir_lines::seed_of_repeat;
use sir_parallel::{Checkpoints, Communicator, Saved, StageTime};
use sir_radiosity::{FocusSides, Model, PowerUnit, RepeatedTotals, Repeats, Solution, Visitor};

use crate::error::Error;
use crate::format::duration;
use crate::format::grouped;
use crate::plan::{Repeat, Until};
use crate::progress::PAUSE;
use crate::ranks::agree;
use crate::report::light::relative_error;
use crate::report::lines::Facts;
use crate::report::result::{
    DomainReport, ErrorsFrom, ErrorsReport, LightReport, LinesReport, StageReport, Time,
};
use crate::run::execute::Run;
use crate::run::lighting::{Done, Lighting};
use crate::run::reach::{dark_warning, few_lines_warning};
use crate::run::stages::unshot_warning;

impl Run<'_> {
    /// Runs a `Repeat`, or resumes one at `saved`, the state of a stage in a repeat. Returns the report and the mean.
    pub(crate) fn repeat(
        &mut self,
        number: usize,
        settings: &Repeat,
        checkpoints: &mut Checkpoints,
        mut saved: Option<Saved>,
    ) -> Result<(StageReport, Solution), Error> {
        let model = &self.prepared.model;
        let mut lighting = Lighting::new(self.prepared);
        let inside = &self.prepared.inside;
        let mut repeats = Repeating::new(settings, model);
        let (mut repeat, mut first) =
            if saved.is_some() { (self.head.repeat, self.head.part) } else { (0, 0) };
        let mut last_message = Instant::now();
        let lines = settings.stages.iter().map(|stage| stage.action.lines()).sum();
        self.progress.note(&format!("Repeat: {} lines each time", grouped(lines)));
        loop {
            let seed = seed_of_repeat(self.head.report.seed, repeat);
            for (part, stage) in settings.stages.iter().enumerate().skip(first) {
                self.begin(number, (repeat, part), checkpoints);
                let title = format!("{}: {}", repeats.title(), stage.action.name());
                let mut executor = self.executor(checkpoints);
                executor.observer =
                    Box::new(self.progress.part(&title, stage.action.lines(), &self.options.stop));
                executor.prior = Some(Box::new(|visitor| repeats.visit(visitor)));
                let done = lighting.run(&stage.action, seed, &mut executor, saved.take());
                drop(executor);
                if let Some(done) = agree(self.comm, done.map_err(Error::from))? {
                    repeats.add(part, done);
                }
            }
            if let Some(received) = lighting.received() {
                repeats.sums.add(received);
            }
            if !repeats.wants_more(model, inside, self.comm) {
                break;
            }
            (repeat, first) = (repeat + 1, 0);
            if last_message.elapsed() >= PAUSE {
                last_message = Instant::now();
                self.progress.note(&repeats.title());
            }
        }
        let (report, solution) = repeats.finish(model, inside);
        self.progress.note(&format!("Repeat: {} times in {}", repeat + 1, duration(report.time.seconds)));
        for (stage, report) in settings.stages.iter().zip(&report.stages) {
            if let Some(lines) = &report.lines {
                self.warn(unshot_warning(&stage.action, lines));
                self.warn(dark_warning(&stage.action, lines));
                self.warn(few_lines_warning(self.prepared, lines, &solution));
            }
        }
        self.warn(missed_target_warning(settings, &report));
        Ok((report, solution))
    }
}

/// Sums over all repeats so far. A checkpoint has them in addition to the state of the current stage.
struct Repeating<'a> {
    settings: &'a Repeat,
    sums: Repeats,
    parts: Vec<StageSums>,
    /// Size of a quantum, after a stage has run.
    unit: Option<PowerUnit>,
    /// Relative error of the mean in the worst band, if that is the target.
    error: Option<f64>,
    /// Time spent before `since`.
    spent: Duration,
    since: Instant,
}

/// Sums of one stage over all repeats so far.
#[derive(Clone, Default)]
struct StageSums {
    totals: RepeatedTotals,
    batches: u64,
    time: StageTime,
    domain: Option<DomainReport>,
}

impl<'a> Repeating<'a> {
    fn new(settings: &'a Repeat, model: &Model) -> Self {
        Self {
            settings,
            sums: Repeats::new(model.mesh.side_count()),
            parts: vec![StageSums::default(); settings.stages.len()],
            unit: None,
            error: None,
            spent: Duration::ZERO,
            since: Instant::now(),
        }
    }

    /// Visits the state that a resumed run needs.
    fn visit(&mut self, visitor: &mut dyn Visitor) {
        let mut time = [self.elapsed().as_micros() as i64];
        visitor.same(&mut time);
        (self.spent, self.since) = (Duration::from_micros(time[0] as u64), Instant::now());
        self.sums.visit(visitor);
        for StageSums { totals, batches, time, .. } in &mut self.parts {
            totals.visit(visitor);
            let mut word = [*batches as i64];
            visitor.same(&mut word);
            *batches = word[0] as u64;
            time.visit(visitor);
        }
    }

    /// Returns the time of the whole `Repeat` so far, including that before it was resumed.
    fn elapsed(&self) -> Duration {
        self.spent + self.since.elapsed()
    }

    /// Adds the outcome of a stage of a repeat.
    fn add(&mut self, part: usize, done: Done) {
        let Done { facts: Facts { balance, counts, batches, extrapolated, domain }, unit, time } = done;
        self.unit = Some(unit);
        let part = &mut self.parts[part];
        part.totals.add(&balance, counts, extrapolated);
        part.batches += batches;
        part.time += time;
        part.domain = domain;
    }

    /// Returns true if another repeat should run. Rank 0 decides, because clocks differ.
    fn wants_more(&mut self, model: &Model, inside: &FocusSides, comm: &dyn Communicator) -> bool {
        if let Until::RelativeError(_) = self.settings.until {
            let (_, solution) = self.mean(model);
            self.error = Some(relative_error(model, inside, &solution).into_iter().fold(0.0, f64::max));
        }
        let done = self.sums.count();
        let wanted = self.settings.until.wants_more(done, self.error, self.elapsed().as_secs_f64());
        let allowed = self.settings.at_most.is_none_or(|most| done < most);
        let mut decision = [i64::from(wanted && allowed)];
        comm.broadcast(&mut decision);
        decision[0] > 0
    }

    /// Returns the mean of all repeats: the hash of its tallies, and the light.
    fn mean(&self, model: &Model) -> (String, Solution) {
        let mean = self.sums.mean();
        let unit = self.unit.unwrap_or_else(|| PowerUnit::for_total(1.0, 0.0));
        (mean.hash(), Solution::new(model, &mean, unit))
    }

    /// Returns the expected total number of repeats, if it can be estimated.
    fn expected_repeats(&self) -> Option<f64> {
        let done = self.sums.count() as f64;
        let (error, seconds) = (self.error, self.elapsed().as_secs_f64());
        let wanted = match self.settings.until {
            Until::Times(times) => Some(times as f64),
            // The error falls with the square root of the number of repeats.
            Until::RelativeError(target) => {
                error.map(|error| (done * (error / target) * (error / target)).ceil())
            }
            Until::Seconds(budget) => (done > 0.0).then(|| (done * budget / seconds).floor()),
        };
        let most = self.settings.at_most.map_or(f64::INFINITY, |most| most as f64);
        wanted.map(|wanted| wanted.max(done + 1.0).min(most))
    }

    /// Returns the title of the current repeat: its number, the error and its target, and the remaining time.
    fn title(&self) -> String {
        let done = self.sums.count();
        let mut title = format!("Repeat {}", done + 1);
        let expected = self.expected_repeats();
        if let (Until::Times(_), Some(times)) = (self.settings.until, expected) {
            title += &format!(" of {times}");
        }
        if let (Until::RelativeError(target), Some(error)) = (self.settings.until, self.error) {
            title += &format!(", relative error {:.3} % (target {} %)", 100.0 * error, 100.0 * target);
        }
        if let (Some(expected), 1..) = (expected, done) {
            let spent = self.elapsed().as_secs_f64();
            title += &format!(", {} left", duration((expected / done as f64 - 1.0).max(0.0) * spent));
        }
        title
    }

    /// Returns the report and the mean.
    fn finish(self, model: &Model, inside: &FocusSides) -> (StageReport, Solution) {
        let (hash, solution) = self.mean(model);
        let (count, total) = (self.sums.count(), self.elapsed());
        let Self { settings, sums, parts, unit, .. } = self;
        let unit = unit.unwrap_or_else(|| PowerUnit::for_total(1.0, 0.0));
        let lines = parts.iter().map(|part| part.totals.counts().lines).sum();
        let (from, samples) =
            if sums.have_spread() { (ErrorsFrom::Spread, count) } else { (ErrorsFrom::Lines, lines) };
        let mut time = StageTime { total, ..StageTime::default() };
        let mut report = StageReport::of("Repeat", Time::of(0.0));
        for (stage, StageSums { totals, batches, time: spent, domain }) in settings.stages.iter().zip(parts) {
            time.tracing += spent.tracing;
            time.communication += spent.communication;
            let (balance, counts, extrapolated) =
                (totals.mean_balance(count), totals.counts(), totals.mean_extrapolated(count));
            let facts = Facts { balance, counts, batches, extrapolated, domain };
            let mut part = StageReport::of(stage.action.name(), Time::of_lines(spent, counts.lines));
            part.lines = Some(LinesReport::new(facts, unit));
            report.stages.push(part);
        }
        report.repeats = Some(count);
        report.light = Some(LightReport::new(model, inside, &solution, ErrorsReport { from, samples }, hash));
        report.time = Time::of_lines(time, lines);
        (report, solution)
    }
}

impl Until {
    /// Returns true if another repeat should run after `done` repeats, at least one, which took `seconds` and whose
    /// mean has the relative error `error`.
    fn wants_more(self, done: u64, error: Option<f64>, seconds: f64) -> bool {
        match self {
            Self::Times(times) => done < times,
            Self::RelativeError(target) => error.is_some_and(|error| error > target),
            Self::Seconds(budget) => seconds + seconds / done.max(1) as f64 <= budget,
        }
    }
}

/// Returns a warning if the target was not reached.
fn missed_target_warning(settings: &Repeat, report: &StageReport) -> Vec<String> {
    let repeats = report.repeats.unwrap_or_default();
    let error =
        report.light.as_ref().map_or(0.0, |light| light.relative_error.into_iter().fold(0.0, f64::max));
    match settings.until {
        Until::Times(times) if repeats < times => {
            vec![format!("`at_most` limited `Repeat` to {repeats} of {times} repeats")]
        }
        Until::RelativeError(target) if error > target => {
            let wanted = (repeats as f64 * (error / target) * (error / target)).ceil();
            vec![format!(
                "after {repeats} repeats the relative error is {:.3} %, not {} %; increase `at_most` to about {wanted}, or give \
                 the stages more lines",
                100.0 * error,
                100.0 * target
            )]
        }
        Until::Seconds(budget) if repeats == 1 && report.time.seconds > budget => {
            let took = duration(report.time.seconds);
            vec![format!(
                "a single repeat took {took}, more than the limit of {}; give the stages fewer lines",
                duration(budget)
            )]
        }
        _ => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_repeat_that_would_end_too_late_is_not_begun() {
        let budget = Until::Seconds(60.0);
        // Five repeats of ten seconds each; a sixth would end just in time.
        assert!(budget.wants_more(5, None, 50.0));
        assert!(!budget.wants_more(5, None, 50.1));
        assert!(!budget.wants_more(1, None, 31.0));
    }

    #[test]
    fn a_target_is_met_when_it_is_reached() {
        let target = Until::RelativeError(0.01);
        assert!(target.wants_more(3, Some(0.0101), 1.0) && !target.wants_more(3, Some(0.01), 1.0));
        assert!(Until::Times(3).wants_more(2, None, 1.0) && !Until::Times(3).wants_more(3, None, 1.0));
    }
}
