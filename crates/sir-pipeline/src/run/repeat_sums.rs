//! Sums over the repeats of a run: what each stage has brought, and how many repeats there are and should be.

use std::sync::Arc;
use std::time::{Duration, Instant};

use sir_geom::Rgb;
use sir_mesh::SideSums;
use sir_parallel::{Communicator, StageTime, Threads};
use sir_radiosity::{MIN_REPEATS, Model, PowerUnit, Repeats, Solution, Visitor, share};

use crate::format::{duration, grouped};
use crate::plan::{Action, Ending, Pipeline, Repeat, Until};
use crate::prepare::prepared::Prepared;
use crate::report::lines::Facts;
use crate::report::result::{
    Convergence, ErrorsFrom, ErrorsReport, LightReport, LinesReport, StageReport, Time,
};
use crate::run::computed::{Computed, PartErrors};
use crate::run::lighting::{Done, Lighting};
use crate::run::measured::Measured;
use crate::run::sharing::{SHARED, Sharing};
use crate::run::step::{Step, UseOfLight};
use crate::watcher::Watcher;

/// Sums over all repeats so far. A checkpoint has them in addition to the state of the current stage.
pub(super) struct RepeatSums<'a> {
    prepared: &'a Prepared,
    /// Parts of the scene for which there are tables.
    parts: Vec<Arc<SideSums>>,
    /// Direct irradiance for pages, after its stage has been reported.
    direct: Option<Arc<[Rgb]>>,
    pub(super) steps: Vec<Step<'a>>,
    ending: Ending,
    /// How the repeats share the lines that the pipeline states; `None` if each has all of them.
    pub(super) sharing: Option<Sharing>,
    /// Number of repeats that share the rays of sensors.
    pub(super) share_rays: u64,
    /// Number of finished repeats.
    pub(super) count: u64,
    /// Size of a quantum, after a stage has run.
    unit: Option<PowerUnit>,
    /// Relative error of the mean in the worst band, if it is known.
    error: Option<f64>,
    pub(super) convergence: Vec<Convergence>,
    is_ended_early: bool,
    /// Time spent before `since`.
    spent: Duration,
    since: Instant,
}

impl<'a> RepeatSums<'a> {
    /// Returns the sums over no repeats of the stages from number `first` on. A `Solve` has the stages `of_solve`.
    pub(super) fn new(
        pipeline: &'a Pipeline,
        prepared: &'a Prepared,
        first: usize,
        of_solve: &'a [Action],
    ) -> Self {
        let mut places = Vec::new();
        let mut repeat = None;
        for (number, stage) in pipeline.stages.iter().enumerate().skip(first) {
            if let Action::Repeat(stage) = &stage.action {
                repeat = Some(stage);
            }
            let actions = stage.flat().flat_map(|stage| parts_of(&stage.action, of_solve)).enumerate();
            places.extend(actions.map(|(part, action)| ((number, part), action)));
        }
        let sharing =
            repeat.is_none().then(|| Sharing::of(places.iter().map(|(_, action)| *action), prepared));
        let times = Until::Times(sharing.map_or(1, |sharing| sharing.repeats));
        let ending = repeat.map_or(Ending::after(times), Repeat::ending);
        let share_rays = ending.share_rays();
        let sides = prepared.model.mesh.side_count();
        let parts = parts_of_tables(pipeline, prepared);
        let direct_step = if pipeline.shows_direct() {
            places
                .iter()
                .rposition(|(_, action)| matches!(action, Action::FirstShot(_) | Action::ShadowRays(_)))
        } else {
            None
        };
        let sums = |is_result: bool| {
            let has_many = ending.is_exact() && matches!(ending.until, Until::Times(MIN_REPEATS..));
            let repeats = if has_many { Repeats::of_many(sides) } else { Repeats::new(sides) };
            repeats.with_sums(if is_result { &parts } else { &[] })
        };
        let mut steps = Vec::new();
        for (i, &(place, action)) in places.iter().enumerate() {
            let has_lines = action.lines() > 0;
            let use_of_light = UseOfLight {
                is_result: has_lines && places.get(i + 1).is_none_or(|(_, next)| next.lines() == 0),
                is_direct: direct_step == Some(i),
            };
            let UseOfLight { is_result, is_direct } = use_of_light;
            let measured = match action {
                Action::Save(_) => continue,
                Action::Sensors(_) => prepared.placed.get(&place.0).map(Measured::new),
                _ => None,
            };
            let light = (is_result || is_direct).then(|| sums(is_result));
            steps.push(Step::new(place, action, light, use_of_light, measured));
        }
        Self {
            prepared,
            parts,
            direct: None,
            steps,
            ending,
            sharing,
            share_rays,
            count: 0,
            unit: None,
            error: None,
            convergence: Vec::new(),
            is_ended_early: false,
            spent: Duration::ZERO,
            since: Instant::now(),
        }
    }

    /// True if the stages are run once, as the pipeline states them.
    pub(super) fn is_single(&self) -> bool {
        self.ending.until == Until::Times(1)
    }

    /// Returns the index of the step at a place.
    pub(super) fn step_at(&self, place: (usize, usize)) -> usize {
        self.steps.iter().position(|step| step.place == place).unwrap_or(0)
    }

    /// Returns the steps of a stage.
    pub(super) fn steps_of(&self, number: usize) -> std::ops::Range<usize> {
        let start = self.steps.partition_point(|step| step.place.0 < number);
        start..self.steps.partition_point(|step| step.place.0 <= number)
    }

    /// Returns the number of lines of a stage in a repeat.
    pub(super) fn lines(&self, action: &Action, repeat: u64) -> u64 {
        match self.sharing {
            Some(Sharing { repeats, .. }) => {
                let lines = share(action.lines(), repeat, repeats);
                lines.end - lines.start
            }
            None => action.lines(),
        }
    }

    /// Visits the state that a resumed run needs.
    pub(super) fn visit(&mut self, visitor: &mut dyn Visitor) {
        let mut words = [self.elapsed().as_micros() as i64, self.count as i64, self.convergence.len() as i64];
        visitor.same(&mut words);
        (self.spent, self.since) = (Duration::from_micros(words[0] as u64), Instant::now());
        self.count = words[1] as u64;
        self.convergence.resize(words[2] as usize, Convergence::default());
        self.convergence.iter_mut().for_each(|point| point.visit(visitor));
        let Prepared { model, focus, .. } = self.prepared;
        self.steps.iter_mut().for_each(|step| step.visit(model, *focus, visitor));
    }

    /// Returns the time of all repeats so far, including that before the run was resumed.
    pub(super) fn elapsed(&self) -> Duration {
        self.spent + self.since.elapsed()
    }

    /// Adds the outcome of a stage of lines of a repeat.
    pub(super) fn add(&mut self, step: usize, done: Done, lighting: &Lighting<'_>, threads: &Threads) {
        self.unit = Some(done.unit);
        self.steps[step].add(done, &self.prepared.model, lighting, threads);
    }

    /// Closes a repeat, and computes the error of the mean if it is needed or comes from the spread.
    pub(super) fn end_repeat(&mut self, threads: &Threads) {
        self.count += 1;
        let Prepared { model, inside, .. } = self.prepared;
        let Some(light) = self.steps.iter().rev().find_map(|step| step.light.as_ref()) else { return };
        let is_target = matches!(self.ending.until, Until::RelativeError(_));
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
    pub(super) fn wants_more(&mut self, comm: &dyn Communicator, watcher: Option<&dyn Watcher>) -> bool {
        let wanted = self.ending.wants_more(self.count, self.error, self.elapsed().as_secs_f64());
        let is_ended_early = wanted && watcher.is_some_and(|watcher| watcher.wants_end());
        let mut decision = [i64::from(wanted), i64::from(is_ended_early)];
        comm.broadcast(&mut decision);
        self.is_ended_early = decision[1] > 0;
        decision[0] > 0 && !self.is_ended_early
    }

    /// True if a watcher wanted no further repeats.
    pub(super) fn is_ended_early(&self) -> bool {
        self.is_ended_early
    }

    /// Returns the mean of the light of all repeats so far, without tables; `None` if there is none.
    pub(super) fn light_so_far(&self, threads: &Threads) -> Option<Computed> {
        let Prepared { model, inside, .. } = self.prepared;
        let solution = |step: &Step<'_>| {
            let light = step.light.as_ref()?;
            Some(Solution::new(model, &light.mean(model, inside, threads), self.unit?))
        };
        let is_direct = |step: &&Step<'_>| step.use_of_light.is_direct;
        let direct =
            self.steps.iter().find(is_direct).and_then(solution).map(|direct| direct.irradiance.into());
        let solution = self.steps.iter().rev().find_map(solution)?;
        Some(Computed { solution, parts: Vec::new(), not_final: None, direct })
    }

    /// Returns the expected total number of repeats, if it can be estimated.
    fn expected_repeats(&self) -> Option<f64> {
        let done = self.count as f64;
        let (error, seconds) = (self.error, self.elapsed().as_secs_f64());
        let in_time = |budget: f64| (done > 0.0).then(|| (done * budget / seconds).floor());
        let wanted = match self.ending.until {
            Until::Times(times) => Some(times as f64),
            // The error falls with the square root of the number of repeats.
            Until::RelativeError(target) => {
                error.map(|error| (done * (error / target) * (error / target)).ceil())
            }
            Until::Seconds(budget) => in_time(budget),
        };
        let most = self.ending.at_most.map_or(f64::INFINITY, |most| most as f64);
        let allowed = self.ending.at_most_seconds.and_then(in_time);
        let least = [wanted, allowed].into_iter().flatten().reduce(f64::min);
        least.map(|wanted| wanted.max(done + 1.0).min(most))
    }

    /// Returns a line about what is repeated.
    pub(super) fn announcement(&self) -> String {
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
    pub(super) fn title(&self) -> String {
        let mut title = format!("Repeat {}", self.count + 1);
        let expected = self.expected_repeats();
        if let (Until::Times(times), true) = (self.ending.until, self.ending.is_exact()) {
            title += &format!(" of {times}");
        }
        match (self.ending.until, self.error) {
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
    pub(super) fn report(&mut self, number: usize, threads: &Threads) -> (StageReport, Option<Computed>) {
        let Prepared { model, inside, .. } = self.prepared;
        let before = self.steps[..=number].iter().map(|step| step.totals.counts().lines).sum();
        let (count, unit) = (self.count, self.unit.unwrap_or_else(|| PowerUnit::for_total(1.0, 0.0)));
        let is_last = self.steps[number + 1..].iter().all(|step| step.action.lines() == 0);
        let step = &mut self.steps[number];
        let not_final = (!is_last).then(|| step.action.name());
        let (balance, counts, walked) =
            (step.totals.mean_balance(count), step.totals.counts(), step.totals.mean_walked(count));
        let facts = Facts { balance, counts, batches: step.batches, walked, domain: step.domain.clone() };
        let mut report = StageReport::of(step.action.name(), Time::of_lines(step.time, counts.lines));
        report.lines = Some(LinesReport::new(facts, unit));
        let Some(light) = step.light.take() else { return (report, None) };
        let UseOfLight { is_result, is_direct } = step.use_of_light;
        let (from, samples) =
            if light.have_spread() { (ErrorsFrom::Spread, count) } else { (ErrorsFrom::Lines, before) };
        let mean = light.mean(model, inside, threads);
        let errors = |index| light.errors_of_sums(index, model, inside, unit);
        let parts = self.parts.iter().cloned().enumerate();
        let parts = parts.map(|(i, sums)| PartErrors { sums, errors: errors(i) }).collect();
        drop(light);
        let solution = Solution::new(model, &mean, unit);
        if is_direct {
            self.direct = Some(solution.irradiance.as_slice().into());
        }
        if !is_result {
            return (report, None);
        }
        let errors = ErrorsReport { from, samples };
        report.light = Some(LightReport::new(model, inside, &solution, errors, mean.hash()));
        (report, Some(Computed { solution, parts, not_final, direct: self.direct.clone() }))
    }

    /// Returns the time of all repeats.
    pub(super) fn time(&self) -> Time {
        let mut time = StageTime { total: self.elapsed(), ..StageTime::default() };
        for step in &self.steps {
            time.tracing += step.time.tracing;
            time.communication += step.time.communication;
        }
        let lines = self.steps.iter().map(|step| step.totals.counts().lines).sum();
        Time::of_lines(time, lines)
    }
}

/// Returns the parts of the scene for which a pipeline has tables.
pub(super) fn parts_of_tables(pipeline: &Pipeline, prepared: &Prepared) -> Vec<Arc<SideSums>> {
    let Model { scene, mesh, .. } = &prepared.model;
    let kinds = pipeline.parts_of_tables();
    kinds.into_iter().map(|per| Arc::new(SideSums::new(scene, mesh, per))).collect()
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
    pub(super) fn visit(&mut self, visitor: &mut dyn Visitor) {
        let [r, g, b] = self.relative_error.map(|error| error.to_bits() as i64);
        let mut words = [self.repeats as i64, self.lines as i64, r, g, b, self.time.seconds.to_bits() as i64];
        visitor.same(&mut words);
        let float = |i: usize| f64::from_bits(words[i] as u64);
        let (repeats, lines) = (words[0] as u64, words[1] as u64);
        *self = Self { repeats, lines, relative_error: [2, 3, 4].map(float), time: Time::of(float(5)) };
    }
}

impl Ending {
    /// Returns an ending without limits before its target.
    fn after(until: Until) -> Self {
        Self { until, at_most: None, at_most_seconds: None }
    }

    /// True if there is no limit before the target.
    fn is_exact(self) -> bool {
        self.at_most.is_none() && self.at_most_seconds.is_none()
    }

    /// Returns the number of repeats that share the rays of sensors.
    pub(crate) fn share_rays(self) -> u64 {
        // The number of repeats may not be known, or be large.
        let most = self.at_most.unwrap_or(u64::MAX).min(SHARED);
        if let Until::Times(times) = self.until { times.min(most) } else { most }
    }

    /// Returns true if another repeat should run after `done` repeats, at least one, which took `seconds` and whose
    /// mean has the relative error `error`.
    fn wants_more(self, done: u64, error: Option<f64>, seconds: f64) -> bool {
        let ends_within = |budget: f64| seconds + seconds / done.max(1) as f64 <= budget;
        let wanted = match self.until {
            Until::Times(times) => done < times,
            Until::RelativeError(target) => error.is_some_and(|error| error > target),
            Until::Seconds(budget) => ends_within(budget),
        };
        wanted && self.at_most.is_none_or(|most| done < most) && self.at_most_seconds.is_none_or(ends_within)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_repeat_that_would_end_too_late_is_not_begun() {
        let target = Until::RelativeError(0.01);
        let limited = Ending { at_most_seconds: Some(60.0), ..Ending::after(target) };
        for budget in [Ending::after(Until::Seconds(60.0)), limited] {
            // Five repeats of ten seconds each; a sixth would end just in time.
            assert!(budget.wants_more(5, Some(0.02), 50.0));
            assert!(!budget.wants_more(5, Some(0.02), 50.1));
            assert!(!budget.wants_more(1, Some(0.02), 31.0));
        }
        assert!(!limited.wants_more(5, Some(0.01), 1.0));
    }

    #[test]
    fn a_target_is_met_when_it_is_reached() {
        let target = Ending::after(Until::RelativeError(0.01));
        assert!(target.wants_more(3, Some(0.0101), 1.0) && !target.wants_more(3, Some(0.01), 1.0));
        let times = Ending::after(Until::Times(3));
        assert!(times.wants_more(2, None, 1.0) && !times.wants_more(3, None, 1.0));
        let limited = Ending { at_most: Some(3), ..target };
        assert!(limited.wants_more(2, Some(0.02), 1.0) && !limited.wants_more(3, Some(0.02), 1.0));
    }
}
