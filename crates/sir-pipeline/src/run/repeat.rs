//! A `Repeat`: its stages are run again and again, and the result is the mean.

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
use crate::run::stages::unshot_warning;

impl Run<'_> {
    /// Runs a `Repeat`, or goes on with one of which `saved` is a stage of a repeat. Returns what to report, and the mean.
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
        let mut said = Instant::now();
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
                    repeats.book(part, done);
                }
            }
            if let Some(received) = lighting.received() {
                repeats.sums.add(received);
            }
            if !repeats.go_on(model, inside, self.comm) {
                break;
            }
            (repeat, first) = (repeat + 1, 0);
            if said.elapsed() >= PAUSE {
                said = Instant::now();
                self.progress.note(&repeats.title());
            }
        }
        let (report, solution) = repeats.finish(model, inside);
        self.progress.note(&format!("Repeat: {} times after {}", repeat + 1, duration(report.time.seconds)));
        for (stage, report) in settings.stages.iter().zip(&report.stages) {
            self.progress.warn(
                &report.lines.iter().flat_map(|l| unshot_warning(&stage.action, l)).collect::<Vec<_>>(),
            );
        }
        self.progress.warn(&missed(settings, &report));
        Ok((report, solution))
    }
}

/// What is known of all repeats so far: a checkpoint has it beside the state of the stage under way.
struct Repeating<'a> {
    settings: &'a Repeat,
    sums: Repeats,
    parts: Vec<StageSums>,
    /// The size of a quantum, once a stage has run.
    unit: Option<PowerUnit>,
    /// The relative error of the mean in the worst band, if that is the target.
    error: Option<f64>,
    /// Time before `since`.
    spent: Duration,
    since: Instant,
}

/// One stage in all repeats so far.
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

    /// Shows everything that a resumed run needs to a visitor.
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

    /// Time of the whole `Repeat` so far, also before it was resumed.
    fn elapsed(&self) -> Duration {
        self.spent + self.since.elapsed()
    }

    /// Notes what a stage of a repeat has done.
    fn book(&mut self, part: usize, done: Done) {
        let Done { facts: Facts { balance, counts, batches, extrapolated, domain }, unit, time } = done;
        self.unit = Some(unit);
        let part = &mut self.parts[part];
        part.totals.add(&balance, counts, extrapolated);
        part.batches += batches;
        part.time += time;
        part.domain = domain;
    }

    /// Whether there is to be another repeat. The first rank decides, because clocks differ.
    fn go_on(&mut self, model: &Model, inside: &FocusSides, comm: &dyn Communicator) -> bool {
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

    /// The mean of all repeats: the hash of its tallies, and the light.
    fn mean(&self, model: &Model) -> (String, Solution) {
        let mean = self.sums.mean();
        let unit = self.unit.unwrap_or_else(|| PowerUnit::for_total(1.0, 0.0));
        (mean.hash(), Solution::new(model, &mean, unit))
    }

    /// How many repeats there will be in all, as far as that can be foreseen.
    fn foreseen(&self) -> Option<f64> {
        let done = self.sums.count() as f64;
        let (error, seconds) = (self.error, self.elapsed().as_secs_f64());
        let wanted = match self.settings.until {
            Until::Times(times) => Some(times as f64),
            // The error falls with the square root of the number.
            Until::RelativeError(target) => {
                error.map(|error| (done * (error / target) * (error / target)).ceil())
            }
            Until::Seconds(budget) => (done > 0.0).then(|| (done * budget / seconds).floor()),
        };
        let most = self.settings.at_most.map_or(f64::INFINITY, |most| most as f64);
        wanted.map(|wanted| wanted.max(done + 1.0).min(most))
    }

    /// What is being done: the number of the repeat, how near the target is, and how much time is left.
    fn title(&self) -> String {
        let done = self.sums.count();
        let mut title = format!("Repeat {}", done + 1);
        let foreseen = self.foreseen();
        if let (Until::Times(_), Some(times)) = (self.settings.until, foreseen) {
            title += &format!(" of {times}");
        }
        if let (Until::RelativeError(target), Some(error)) = (self.settings.until, self.error) {
            title += &format!(", relative error {:.3} % (target {} %)", 100.0 * error, 100.0 * target);
        }
        if let (Some(foreseen), 1..) = (foreseen, done) {
            let spent = self.elapsed().as_secs_f64();
            title += &format!(", {} left", duration((foreseen / done as f64 - 1.0).max(0.0) * spent));
        }
        title
    }

    /// What to report, and the mean.
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
    /// Whether there should be another repeat after some, of which at least one is `done`, with this relative error of the mean and
    /// in so many seconds.
    fn wants_more(self, done: u64, error: Option<f64>, seconds: f64) -> bool {
        match self {
            Self::Times(times) => done < times,
            Self::RelativeError(target) => error.is_some_and(|error| error > target),
            Self::Seconds(budget) => seconds + seconds / done.max(1) as f64 <= budget,
        }
    }
}

/// What to say if the target was not reached.
fn missed(settings: &Repeat, report: &StageReport) -> Vec<String> {
    let repeats = report.repeats.unwrap_or_default();
    let error =
        report.light.as_ref().map_or(0.0, |light| light.relative_error.into_iter().fold(0.0, f64::max));
    match settings.until {
        Until::Times(times) if repeats < times => {
            vec![format!("`at_most` ended `Repeat` after {repeats} of {times} times")]
        }
        Until::RelativeError(target) if error > target => {
            let wanted = (repeats as f64 * (error / target) * (error / target)).ceil();
            vec![format!(
                "after {repeats} repeats the relative error is {:.3} %, and not {} %; let there be more with `at_most` (about \
                 {wanted} in all), or give the stages more lines",
                100.0 * error,
                100.0 * target
            )]
        }
        Until::Seconds(budget) if repeats == 1 && report.time.seconds > budget => {
            let took = duration(report.time.seconds);
            vec![format!(
                "a single repeat took {took}, more than {}; give the stages fewer lines",
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
        // Five of ten seconds each, and a sixth one would end just in time.
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
