//! The light of a run: its stages from the first shot to the end, in independent repeats.
//!
//! Every repeat runs the whole chain of stages with random numbers of its own. The result is the mean, and its errors come
//! from the spread, which knows what the errors of a single repeat leave out: noise that patches inherit from others.
//! The lines of stages outside of a `Repeat` are shared among the repeats.

use std::time::{Duration, Instant};

use sir_lines::seed_of_repeat;
use sir_parallel::{Checkpoints, Communicator, Saved, StageTime, Start, Threads};
use sir_radiosity::{
    MIN_REPEATS, Points, PowerUnit, RepeatedMeasurements, RepeatedTotals, Repeats, SensorStage, SensorTask,
    Solution, Visitor, share,
};

use crate::error::Error;
use crate::format::{duration, grouped};
use crate::plan::{Action, Pipeline, Repeat, Sensors, Until};
use crate::prepare::prepared::Prepared;
use crate::progress::{PAUSE, StageProgress};
use crate::ranks::agree;
use crate::report::lines::Facts;
use crate::report::result::{
    Convergence, DomainReport, ErrorsFrom, ErrorsReport, LightReport, LinesReport, StageReport, Time,
};
use crate::report::sensors::SensorsReport;
use crate::run::execute::Run;
use crate::run::lighting::{Done, Lighting};
use crate::run::reach::{dark_warning, few_lines_warning};
use crate::run::sharing::{SHARED, Sharing};
use crate::run::stages::{large_error_warning, unshot_warning};
use crate::stopwatch::Stopwatch;

/// A stage that is run in every repeat.
struct Step<'a> {
    /// Number of the stage in the pipeline, and in a `Repeat` or `Solve`.
    place: (usize, usize),
    action: &'a Action,
    totals: RepeatedTotals,
    batches: u64,
    time: StageTime,
    domain: Option<DomainReport>,
    /// Sums of the light after this stage, if it is shown or measured.
    light: Option<Repeats>,
    /// Sums of the measurements of this stage.
    measured: Option<RepeatedMeasurements>,
}

/// Sums over all repeats so far. A checkpoint has them in addition to the state of the current stage.
struct Repeating<'a> {
    prepared: &'a Prepared,
    steps: Vec<Step<'a>>,
    until: Until,
    at_most: Option<u64>,
    /// How the repeats share the lines that the pipeline states; `None` if each has all of them.
    sharing: Option<Sharing>,
    /// Number of repeats that share the rays of sensors.
    share_rays: u64,
    /// Number of finished repeats.
    count: u64,
    /// Size of a quantum, after a stage has run.
    unit: Option<PowerUnit>,
    /// Relative error of the mean in the worst band, if it is known.
    error: Option<f64>,
    convergence: Vec<Convergence>,
    /// Time spent before `since`.
    spent: Duration,
    since: Instant,
}

impl Run<'_> {
    /// Runs the stages from number `first`, the first with light, to the end of the pipeline in repeats; or goes on from
    /// `saved`, the state of one of them.
    pub(crate) fn light(
        &mut self,
        first: usize,
        checkpoints: &mut Checkpoints,
        mut saved: Option<Saved>,
    ) -> Result<(), Error> {
        let (pipeline, prepared) = (self.pipeline, self.prepared);
        let solve = pipeline.flat_stages().find_map(|stage| match &stage.action {
            Action::Solve(solve) => Some(solve.lines),
            _ => None,
        });
        if let (Some(lines), None) = (solve, self.head.split) {
            let has_repeat = pipeline.stages.iter().any(|stage| matches!(stage.action, Action::Repeat(_)));
            let repeats = if has_repeat { 1 } else { SHARED };
            self.head.split = Some(self.split(lines, repeats)?);
        }
        let of_solve = self.head.split.map_or(Vec::new(), |split| split.actions());
        let mut repeating = Repeating::new(pipeline, prepared, first, &of_solve);
        let is_single = repeating.is_single();
        // The errors that single lines state are those of independent points.
        let points = if is_single { Points::Random } else { pipeline.points };
        let mut lighting = Lighting::new(prepared, points);
        let (mut repeat, mut begun) = match saved {
            Some(_) => (self.head.repeat, repeating.step_at((self.head.stage, self.head.part))),
            None => (0, 0),
        };
        if !is_single {
            self.progress.note(&repeating.announcement());
        }
        let (threads, mut last_message) = (self.threads(), Instant::now());
        loop {
            let seed = seed_of_repeat(self.head.report.seed, repeat);
            for number in begun..repeating.steps.len() {
                let (place, action) = (repeating.steps[number].place, repeating.steps[number].action);
                if let Action::Sensors(sensors) = action {
                    self.measure(&mut repeating, number, sensors, &lighting, seed)?;
                    continue;
                }
                let (lines, stage) = (repeating.lines(action, repeat), action.name());
                self.begin(place.0, (repeat, place.1), checkpoints);
                let mut executor = self.executor(checkpoints);
                executor.observer = Box::new(self.observer(&repeating, stage, lines));
                executor.prior = Some(Box::new(|visitor| repeating.visit(visitor)));
                let done = lighting.run(action, lines, seed, &mut executor, saved.take());
                drop(executor);
                if let Some(done) = agree(self.comm, done.map_err(Error::from))? {
                    repeating.add(number, done, &lighting, &threads);
                }
            }
            repeating.end_repeat(&threads);
            if !repeating.wants_more(self.comm) {
                break;
            }
            (repeat, begun) = (repeat + 1, 0);
            if !is_single && last_message.elapsed() >= PAUSE {
                last_message = Instant::now();
                self.progress.note(&repeating.title());
            }
        }
        drop(lighting);
        if !is_single {
            let count = grouped(repeating.count);
            self.progress
                .note(&format!("Repeat: {count} times in {}", duration(repeating.elapsed().as_secs_f64())));
        }
        self.warn(repeating.sharing.and_then(|sharing| sharing.warning(solve)).into_iter().collect());
        self.report(first, &mut repeating)
    }

    /// Returns the observer of a stage with `total` lines: a stage of its own, or a part of a repeat.
    fn observer(&self, repeating: &Repeating<'_>, stage: &str, total: u64) -> StageProgress {
        match repeating.is_single() {
            true => self.progress.stage(stage, total, &self.options.stop),
            false => {
                self.progress.part(&format!("{}: {stage}", repeating.title()), total, &self.options.stop)
            }
        }
    }

    /// Measures at the sensors of a step in one repeat.
    fn measure(
        &mut self,
        repeating: &mut Repeating<'_>,
        step: usize,
        sensors: &Sensors,
        lighting: &Lighting<'_>,
        seed: u64,
    ) -> Result<(), Error> {
        let (number, _) = repeating.steps[step].place;
        let (Some(layout), Some(solution)) =
            (self.prepared.layouts.get(&number), lighting.solution(&self.threads()))
        else {
            return Ok(());
        };
        let settings = sensors.settings().shared(repeating.share_rays);
        let mut executor = self.executor_without_checkpoints();
        let total = settings.rays * layout.sensors.len() as u64;
        executor.observer = Box::new(self.observer(repeating, "Sensors", total));
        // Each stage `Sensors` has independent random numbers.
        let seed = seed.wrapping_add((number as u64) << 48);
        let model = &self.prepared.model;
        let task = SensorTask { model, solution: &solution, sensors: &layout.sensors, settings, seed };
        let done = executor.run::<SensorStage<'_>>(task, Start::Fresh(()));
        drop(executor);
        let done = agree(self.comm, done.map_err(|error| self.interrupted_measuring(error)))?;
        let step = &mut repeating.steps[step];
        step.time += done.time;
        if let Some(measured) = &mut step.measured {
            measured.add(&done.outcome);
        }
        Ok(())
    }

    /// Reports all stages from number `first` on, and writes their files.
    fn report(&mut self, first: usize, repeating: &mut Repeating<'_>) -> Result<(), Error> {
        let (threads, mut solution) = (self.threads(), None);
        for (number, stage) in self.pipeline.stages.iter().enumerate().skip(first) {
            let watch = Stopwatch::start();
            let mut report = StageReport::of(stage.action.name(), Time::of(0.0));
            let steps = repeating.steps_of(number);
            match &stage.action {
                Action::Save(save) => {
                    self.save(solution.as_ref(), &save.outputs)?;
                    report.time = Time::of(watch.seconds());
                }
                Action::Sensors(sensors) => {
                    for step in &repeating.steps[steps] {
                        let Some(measured) = &step.measured else { continue };
                        let (means, error) = (measured.means(), measured.error_of_mean());
                        let summary = SensorsReport::new(&sensors.name, &means, error);
                        report.time = Time::of_lines(step.time, summary.rays);
                        self.write_sensors(number, sensors, &means, &summary)?;
                        report.sensors = Some(summary);
                    }
                }
                Action::Repeat(_) | Action::Solve(_) => {
                    for step in steps {
                        let (part, light) = repeating.report(step, &threads);
                        self.warn_of_lines(repeating.steps[step].action, &part, light.as_ref());
                        solution = light.or(solution);
                        report.stages.push(part);
                    }
                    report.light = report.stages.last_mut().and_then(|stage| stage.light.take());
                    report.time = repeating.time();
                    report.pilot = self.head.split.map(|split| split.pilot);
                    report.time.seconds += report.pilot.map_or(0.0, |pilot| pilot.time.seconds);
                    let is_repeat = matches!(stage.action, Action::Repeat(_));
                    if is_repeat || !repeating.is_single() {
                        report.repeats = Some(repeating.count);
                    }
                    if let Action::Repeat(repeat) = &stage.action {
                        self.warn(missed_target_warning(repeat, &report));
                    }
                }
                _ => {
                    for step in steps {
                        // The previous solution is no longer needed, and takes much memory.
                        drop(solution.take());
                        let (part, light) = repeating.report(step, &threads);
                        self.warn_of_lines(&stage.action, &part, light.as_ref());
                        (report, solution) = (part, light);
                        if !repeating.is_single() {
                            report.repeats = Some(repeating.count);
                        }
                    }
                }
            }
            self.head.report.stages.push(report);
        }
        if let Some(last) = self.head.report.stages.iter_mut().rev().find(|stage| stage.light.is_some()) {
            last.convergence.clone_from(&repeating.convergence);
            let warning = last.light.as_ref().and_then(large_error_warning);
            self.warn(warning.into_iter().collect());
        }
        Ok(())
    }

    /// Warns of what is wrong with the lines of a stage.
    fn warn_of_lines(&mut self, action: &Action, report: &StageReport, light: Option<&Solution>) {
        let Some(lines) = &report.lines else { return };
        self.warn(unshot_warning(action, lines));
        self.warn(dark_warning(action, lines));
        if let Some(light) = light {
            self.warn(few_lines_warning(self.prepared, lines, light));
        }
    }
}

impl<'a> Repeating<'a> {
    /// Returns the sums over no repeats of the stages from number `first` on. A `Solve` has the stages `of_solve`.
    fn new(pipeline: &'a Pipeline, prepared: &'a Prepared, first: usize, of_solve: &'a [Action]) -> Self {
        let mut places = Vec::new();
        let mut repeat = None;
        for (number, stage) in pipeline.stages.iter().enumerate().skip(first) {
            if let Action::Repeat(stage) = &stage.action {
                repeat = Some(stage);
            }
            let actions = stage.flat().flat_map(|stage| parts_of(&stage.action, of_solve)).enumerate();
            places.extend(actions.map(|(part, action)| ((number, part), action)));
        }
        let (sharing, until, at_most) = match repeat {
            Some(repeat) => (None, repeat.until, repeat.at_most),
            None => {
                let sharing = Sharing::of(places.iter().map(|(_, action)| *action), prepared);
                (Some(sharing), Until::Times(sharing.repeats), None)
            }
        };
        // The number of repeats may not be known, or be large.
        let most = at_most.unwrap_or(u64::MAX).min(SHARED);
        let share_rays = if let Until::Times(times) = until { times.min(most) } else { most };
        let sides = prepared.model.mesh.side_count();
        let sums = || match until {
            Until::Times(MIN_REPEATS..) if at_most.is_none() => Repeats::of_many(sides),
            _ => Repeats::new(sides),
        };
        let mut steps = Vec::new();
        for (i, &(place, action)) in places.iter().enumerate() {
            let has_lines = action.lines() > 0;
            let is_used = places.get(i + 1).is_none_or(|(_, next)| next.lines() == 0);
            let measured = match action {
                Action::Save(_) => continue,
                Action::Sensors(_) => prepared.layouts.get(&place.0).map(|layout| layout.sensors.len()),
                _ => None,
            };
            steps.push(Step {
                place,
                action,
                totals: RepeatedTotals::default(),
                batches: 0,
                time: StageTime::default(),
                domain: None,
                light: (has_lines && is_used).then(sums),
                measured: measured.map(RepeatedMeasurements::new),
            });
        }
        Self {
            prepared,
            steps,
            until,
            at_most,
            sharing,
            share_rays,
            count: 0,
            unit: None,
            error: None,
            convergence: Vec::new(),
            spent: Duration::ZERO,
            since: Instant::now(),
        }
    }

    /// True if the stages are run once, as the pipeline states them.
    fn is_single(&self) -> bool {
        self.until == Until::Times(1)
    }

    /// Returns the index of the step at a place.
    fn step_at(&self, place: (usize, usize)) -> usize {
        self.steps.iter().position(|step| step.place == place).unwrap_or(0)
    }

    /// Returns the steps of a stage.
    fn steps_of(&self, number: usize) -> std::ops::Range<usize> {
        let start = self.steps.partition_point(|step| step.place.0 < number);
        start..self.steps.partition_point(|step| step.place.0 <= number)
    }

    /// Returns the number of lines of a stage in a repeat.
    fn lines(&self, action: &Action, repeat: u64) -> u64 {
        match self.sharing {
            Some(Sharing { repeats, .. }) => {
                let lines = share(action.lines(), repeat, repeats);
                lines.end - lines.start
            }
            None => action.lines(),
        }
    }

    /// Visits the state that a resumed run needs.
    fn visit(&mut self, visitor: &mut dyn Visitor) {
        let mut words = [self.elapsed().as_micros() as i64, self.count as i64, self.convergence.len() as i64];
        visitor.same(&mut words);
        (self.spent, self.since) = (Duration::from_micros(words[0] as u64), Instant::now());
        self.count = words[1] as u64;
        self.convergence.resize(words[2] as usize, Convergence::default());
        self.convergence.iter_mut().for_each(|point| point.visit(visitor));
        let Prepared { model, focus, .. } = self.prepared;
        for Step { action, totals, batches, time, light, measured, .. } in &mut self.steps {
            totals.visit(visitor);
            let mut word = [*batches as i64];
            visitor.same(&mut word);
            *batches = word[0] as u64;
            time.visit(visitor);
            if let Some(light) = light {
                let domain = || match action {
                    Action::Multipath(multipath) => Some(multipath.domain.lines_around(&model.scene, *focus)),
                    _ => None,
                };
                light.visit(domain, visitor);
            }
            if let Some(measured) = measured {
                measured.visit(visitor);
            }
        }
    }

    /// Returns the time of all repeats so far, including that before the run was resumed.
    fn elapsed(&self) -> Duration {
        self.spent + self.since.elapsed()
    }

    /// Adds the outcome of a stage of lines of a repeat.
    fn add(&mut self, step: usize, done: Done, lighting: &Lighting<'_>, threads: &Threads) {
        let Done { facts: Facts { balance, counts, batches, walked, domain }, unit, time } = done;
        self.unit = Some(unit);
        let step = &mut self.steps[step];
        step.totals.add(&balance, counts, walked);
        step.batches += batches;
        step.time += time;
        step.domain = domain;
        if let (Some(sums), Some((received, counted))) = (&mut step.light, lighting.received()) {
            sums.add(&self.prepared.model, received, counted, threads);
        }
    }

    /// Closes a repeat, and computes the error of the mean if it is needed or comes from the spread.
    fn end_repeat(&mut self, threads: &Threads) {
        self.count += 1;
        let Prepared { model, inside, .. } = self.prepared;
        let Some(light) = self.steps.iter().rev().find_map(|step| step.light.as_ref()) else { return };
        let is_target = matches!(self.until, Until::RelativeError(_));
        if !is_target && !light.have_spread() {
            return;
        }
        let relative_error = light.relative_error(model, inside, threads);
        self.error = Some(relative_error.into_iter().fold(0.0, f64::max));
        if light.have_spread() {
            let lines = self.steps.iter().map(|step| step.totals.counts().lines).sum();
            let time = Time::of(self.elapsed().as_secs_f64());
            self.convergence.push(Convergence { repeats: self.count, lines, relative_error, time });
        }
    }

    /// Returns true if another repeat should run. Rank 0 decides, because clocks differ.
    fn wants_more(&self, comm: &dyn Communicator) -> bool {
        let wanted = self.until.wants_more(self.count, self.error, self.elapsed().as_secs_f64());
        let allowed = self.at_most.is_none_or(|most| self.count < most);
        let mut decision = [i64::from(wanted && allowed)];
        comm.broadcast(&mut decision);
        decision[0] > 0
    }

    /// Returns the expected total number of repeats, if it can be estimated.
    fn expected_repeats(&self) -> Option<f64> {
        let done = self.count as f64;
        let (error, seconds) = (self.error, self.elapsed().as_secs_f64());
        let wanted = match self.until {
            Until::Times(times) => Some(times as f64),
            // The error falls with the square root of the number of repeats.
            Until::RelativeError(target) => {
                error.map(|error| (done * (error / target) * (error / target)).ceil())
            }
            Until::Seconds(budget) => (done > 0.0).then(|| (done * budget / seconds).floor()),
        };
        let most = self.at_most.map_or(f64::INFINITY, |most| most as f64);
        wanted.map(|wanted| wanted.max(done + 1.0).min(most))
    }

    /// Returns a line about what is repeated.
    fn announcement(&self) -> String {
        let with_lines = || self.steps.iter().filter(|step| step.action.lines() > 0);
        if let Some(Sharing { repeats, .. }) = self.sharing {
            let stages = with_lines()
                .map(|step| format!("{}: {} lines", step.action.name(), grouped(step.action.lines())));
            return format!("{}; in {repeats} repeats", stages.collect::<Vec<_>>().join(", "));
        }
        let lines = with_lines().map(|step| step.action.lines()).sum();
        format!("Repeat: {} lines each time", grouped(lines))
    }

    /// Returns the title of the current repeat: its number, the error and its target, and the remaining time.
    fn title(&self) -> String {
        let mut title = format!("Repeat {}", self.count + 1);
        let expected = self.expected_repeats();
        if let (Until::Times(_), Some(times)) = (self.until, expected) {
            title += &format!(" of {times}");
        }
        match (self.until, self.error) {
            (Until::RelativeError(target), Some(error)) => {
                title += &format!(", relative error {:.3} % (target {} %)", 100.0 * error, 100.0 * target);
            }
            (_, Some(error)) => title += &format!(", relative error {:.2} %", 100.0 * error),
            _ => {}
        }
        if let (Some(expected), 1..) = (expected, self.count) {
            let spent = self.elapsed().as_secs_f64();
            title += &format!(", {} left", duration((expected / self.count as f64 - 1.0).max(0.0) * spent));
        }
        title
    }

    /// Returns the report of a step with lines, and the mean of the light after it, if that is used. Frees the sums.
    fn report(&mut self, number: usize, threads: &Threads) -> (StageReport, Option<Solution>) {
        let Prepared { model, inside, .. } = self.prepared;
        let before = self.steps[..=number].iter().map(|step| step.totals.counts().lines).sum();
        let (count, unit) = (self.count, self.unit.unwrap_or_else(|| PowerUnit::for_total(1.0, 0.0)));
        let step = &mut self.steps[number];
        let (balance, counts, walked) =
            (step.totals.mean_balance(count), step.totals.counts(), step.totals.mean_walked(count));
        let facts = Facts { balance, counts, batches: step.batches, walked, domain: step.domain.clone() };
        let mut report = StageReport::of(step.action.name(), Time::of_lines(step.time, counts.lines));
        report.lines = Some(LinesReport::new(facts, unit));
        let Some(light) = step.light.take() else { return (report, None) };
        let (from, samples) =
            if light.have_spread() { (ErrorsFrom::Spread, count) } else { (ErrorsFrom::Lines, before) };
        let mean = light.mean(model, inside, threads);
        drop(light);
        let solution = Solution::new(model, &mean, unit);
        let errors = ErrorsReport { from, samples };
        report.light = Some(LightReport::new(model, inside, &solution, errors, mean.hash()));
        (report, Some(solution))
    }

    /// Returns the time of all repeats.
    fn time(&self) -> Time {
        let mut time = StageTime { total: self.elapsed(), ..StageTime::default() };
        for step in &self.steps {
            time.tracing += step.time.tracing;
            time.communication += step.time.communication;
        }
        let lines = self.steps.iter().map(|step| step.totals.counts().lines).sum();
        Time::of_lines(time, lines)
    }
}

/// Returns the stages of a `Solve`, or the stage itself if it is another one.
fn parts_of<'a>(action: &'a Action, of_solve: &'a [Action]) -> &'a [Action] {
    match action {
        Action::Solve(_) => of_solve,
        _ => std::slice::from_ref(action),
    }
}

impl Convergence {
    /// Visits the numbers.
    fn visit(&mut self, visitor: &mut dyn Visitor) {
        let [r, g, b] = self.relative_error.map(|error| error.to_bits() as i64);
        let mut words = [self.repeats as i64, self.lines as i64, r, g, b, self.time.seconds.to_bits() as i64];
        visitor.same(&mut words);
        let float = |i: usize| f64::from_bits(words[i] as u64);
        let (repeats, lines) = (words[0] as u64, words[1] as u64);
        *self = Self { repeats, lines, relative_error: [2, 3, 4].map(float), time: Time::of(float(5)) };
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
