//! The light of a run: its stages from the first shot to the end, in independent repeats.
//!
//! Every repeat runs the whole chain of stages with random numbers of its own. The result is the mean, and its errors come
//! from the spread, which knows what the errors of a single repeat leave out: noise that patches inherit from others.
//! The lines of stages outside of a `Repeat` are shared among the repeats.

use std::time::Instant;

use sir_lines::seed_of_repeat;
use sir_mesh::Per;
use sir_parallel::{Checkpoints, Saved, Start, Threads};
use sir_radiosity::{MIN_REPEATS, Points, ProbeStage, ProbeTask, SensorStage, SensorTask};

use crate::error::Error;
use crate::format::{duration, grouped, rounded_up};
use crate::plan::{Action, Output, Repeat, Save, Sensors, Until};
use crate::prepare::layout::{Layout, Placed};
use crate::prepare::probe_grid::ProbeGrid;
use crate::progress::{PAUSE, StageProgress};
use crate::ranks::agree;
use crate::report::page::{facts, title};
use crate::report::result::{StageReport, Time};
use crate::run::computed::Computed;
use crate::run::execute::Run;
use crate::run::lighting::Lighting;
use crate::run::measured::Measured;
use crate::run::reach::{dark_warning, few_lines_warning};
use crate::run::repeat_sums::RepeatSums;
use crate::run::save::view_of;
use crate::run::sharing::SHARED;
use crate::run::stages::{large_error_warning, unshot_warning};
use crate::stopwatch::Stopwatch;
use crate::watcher::Watcher;

impl<'a> Run<'a> {
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
        let mut repeating = RepeatSums::new(pipeline, prepared, first, &of_solve);
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
            let seed = seed_of_repeat(self.seed(), repeat);
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
            if !repeating.wants_more(self.comm, self.options.watcher.as_deref()) {
                break;
            }
            self.show_light(&repeating, &threads)?;
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
        if repeating.is_ended_early() {
            let count = grouped(repeating.count);
            self.warn(vec![format!(
                "the run was ended by its watcher after {count} repeats; it has fewer lines than stated"
            )]);
        }
        self.warn(repeating.sharing.and_then(|sharing| sharing.warning(solve)).into_iter().collect());
        match self.group {
            Some(_) => self.keep(first, &mut repeating),
            None => self.report(first, &mut repeating),
        }
    }

    /// Shows the light of all repeats so far to the watcher, if it wants it.
    fn show_light(&mut self, repeating: &RepeatSums<'_>, threads: &Threads) -> Result<(), Error> {
        let Some(watcher) = self.watcher().filter(|watcher| watcher.wants_light()) else { return Ok(()) };
        let Some(light) = repeating.light_so_far(threads) else { return Ok(()) };
        self.show(watcher, &light, &repeating.title())
    }

    /// Returns the watcher, on rank 0.
    pub(super) fn watcher(&self) -> Option<&'a dyn Watcher> {
        self.options.watcher.as_deref().filter(|_| self.comm.is_first())
    }

    /// Shows light to the watcher. `status` says how far the run is.
    pub(super) fn show(
        &mut self,
        watcher: &dyn Watcher,
        light: &Computed,
        status: &str,
    ) -> Result<(), Error> {
        let known = self.pages.watched.take().map(|shown| shown.cameras);
        let (view, shown) = view_of(self.saver(), light, known)?;
        let Self { prepared, head, pages, .. } = self;
        let facts = facts(&head.report, &prepared.model.scene, &shown, &pages.sensors);
        watcher.show(title(&head.report), view, facts, status);
        pages.watched = Some(shown);
        Ok(())
    }

    /// Returns the observer of a stage with `total` lines: a stage of its own, or a part of a repeat.
    fn observer(&self, repeating: &RepeatSums<'_>, stage: &str, total: u64) -> StageProgress {
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
        repeating: &mut RepeatSums<'_>,
        step: usize,
        sensors: &Sensors,
        lighting: &Lighting<'_>,
        seed: u64,
    ) -> Result<(), Error> {
        let (number, _) = repeating.steps[step].place;
        let (Some(placed), Some(solution)) =
            (self.prepared.placed.get(&number), lighting.solution(&self.threads()))
        else {
            return Ok(());
        };
        let settings = sensors.settings().shared(repeating.share_rays);
        let mut executor = self.executor_without_checkpoints();
        let total = settings.rays * placed.hemispheres();
        executor.observer = Box::new(self.observer(repeating, "Sensors", total));
        // Each stage `Sensors` has independent random numbers.
        let seed = seed.wrapping_add((number as u64) << 48);
        let (model, solution) = (&self.prepared.model, &solution);
        let time = match placed {
            Placed::Sensors(Layout { sensors, .. }) => {
                let task = SensorTask { model, solution, sensors, settings, seed };
                let done = executor.run::<SensorStage<'_>>(task, Start::Fresh(()));
                let done = agree(self.comm, done.map_err(|error| self.interrupted_measuring(error)))?;
                if let Some(Measured::Sensors(measured)) = &mut repeating.steps[step].measured {
                    measured.add(&done.outcome);
                }
                done.time
            }
            Placed::Probes(ProbeGrid { valid, .. }) => {
                let task = ProbeTask { model, solution, positions: valid, settings, seed };
                let done = executor.run::<ProbeStage<'_>>(task, Start::Fresh(()));
                let done = agree(self.comm, done.map_err(|error| self.interrupted_measuring(error)))?;
                if let Some(Measured::Probes(measured)) = &mut repeating.steps[step].measured {
                    measured.add(&done.outcome);
                }
                done.time
            }
        };
        repeating.steps[step].time += time;
        Ok(())
    }

    /// Reports all stages from number `first` on, and writes their files.
    fn report(&mut self, first: usize, repeating: &mut RepeatSums<'_>) -> Result<(), Error> {
        let mut computed = None;
        for (number, stage) in self.pipeline.stages.iter().enumerate().skip(first) {
            let watch = Stopwatch::start();
            let mut report = StageReport::of(stage.action.name(), Time::of(0.0));
            match &stage.action {
                Action::Save(save) => {
                    self.save(computed.as_ref(), &save.outputs)?;
                    self.warn(
                        computed
                            .as_ref()
                            .and_then(|light| independent_errors(light, save))
                            .into_iter()
                            .collect(),
                    );
                    report.time = Time::of(watch.seconds());
                }
                Action::Sensors(sensors) => {
                    for step in &repeating.steps[repeating.steps_of(number)] {
                        let summary = match &step.measured {
                            Some(Measured::Sensors(measured)) => {
                                let (means, spread) = (measured.means(), measured.spread_of_mean());
                                let outdoor = self.prepared.outdoor;
                                self.write_sensors(number, sensors, &means, spread.as_ref(), outdoor)?
                            }
                            Some(Measured::Probes(measured)) => self.write_probes(
                                number,
                                sensors,
                                &measured.means(),
                                measured.error_of_mean(),
                            )?,
                            None => continue,
                        };
                        report.time = Time::of_lines(step.time, summary.rays);
                        report.sensors = Some(summary);
                    }
                }
                _ => {
                    // The previous light is no longer needed, and takes much memory.
                    drop(computed.take());
                    (report, computed) = self.report_lines(number, repeating);
                }
            }
            self.head.report.stages.push(report);
        }
        self.close_report(repeating);
        Ok(())
    }

    /// Returns the report of a stage with lines, and the light after it if that is used. Warns of what is wrong.
    pub(super) fn report_lines(
        &mut self,
        number: usize,
        repeating: &mut RepeatSums<'_>,
    ) -> (StageReport, Option<Computed>) {
        let (threads, action) = (self.threads(), &self.pipeline.stages[number].action);
        let mut report = StageReport::of(action.name(), Time::of(0.0));
        let mut computed = None;
        let is_whole = matches!(action, Action::Repeat(_) | Action::Solve(_));
        for step in repeating.steps_of(number) {
            let (part, light) = repeating.report(step, &threads);
            self.warn_of_lines(repeating.steps[step].action, &part, light.as_ref());
            computed = light.or(computed);
            if is_whole {
                report.stages.push(part);
            } else {
                report = part;
            }
        }
        if is_whole {
            report.light = report.stages.last_mut().and_then(|stage| stage.light.take());
            report.time = repeating.time();
            report.pilot = self.head.split.map(|split| split.pilot);
            report.time.seconds += report.pilot.map_or(0.0, |pilot| pilot.time.seconds);
        }
        let is_repeat = matches!(action, Action::Repeat(_));
        if action.lines() > 0 && (is_repeat || !repeating.is_single()) {
            report.repeats = Some(repeating.count);
        }
        if let (Action::Repeat(repeat), false) = (action, repeating.is_ended_early()) {
            self.warn(missed_target_warning(repeat, &report));
        }
        (report, computed)
    }

    /// Adds to the report of the last stage with lines what concerns all of them.
    pub(super) fn close_report(&mut self, repeating: &RepeatSums<'_>) {
        if let Some(last) = self.head.report.stages.iter_mut().rev().find(|stage| stage.light.is_some()) {
            last.convergence.clone_from(&repeating.convergence);
            let warning = last.light.as_ref().and_then(large_error_warning);
            self.warn(warning.into_iter().collect());
        }
    }

    /// Warns of what is wrong with the lines of a stage.
    fn warn_of_lines(&mut self, action: &Action, report: &StageReport, light: Option<&Computed>) {
        let Some(lines) = &report.lines else { return };
        self.warn(unshot_warning(action, lines));
        self.warn(dark_warning(action, lines));
        if let Some(light) = light {
            self.warn(few_lines_warning(self.prepared, lines, &light.solution));
        }
    }
}

/// Returns a warning if a table of sums has errors that assume independent patches.
pub(super) fn independent_errors(light: &Computed, save: &Save) -> Option<String> {
    let is_assumed = |per: Per| light.parts(per).is_some_and(|parts| parts.errors.is_none());
    let table = save.outputs.iter().find_map(|output| match output {
        Output::Table(table) if table.per.is_some_and(is_assumed) => Some(table),
        _ => None,
    })?;
    Some(format!(
        "the errors in {} assume that patches are independent, because there are fewer than {MIN_REPEATS} repeats; they can be \
         wrong by a factor of three; use more lines, or a `Repeat`",
        table.path.display()
    ))
}

/// Returns a warning if the target was not reached.
fn missed_target_warning(settings: &Repeat, report: &StageReport) -> Vec<String> {
    let repeats = report.repeats.unwrap_or_default();
    let error =
        report.light.as_ref().map_or(0.0, |light| light.relative_error.into_iter().fold(0.0, f64::max));
    match settings.until {
        Until::Times(times) if repeats < times => {
            let limit = if settings.at_most.is_some_and(|most| repeats >= most) {
                "at_most"
            } else {
                "at_most_seconds"
            };
            vec![format!("`{limit}` limited `Repeat` to {repeats} of {times} repeats")]
        }
        Until::RelativeError(target) if error > target => {
            let factor = (error / target) * (error / target);
            let advice = if settings.at_most.is_some_and(|most| repeats >= most) {
                let wanted = (repeats as f64 * factor).ceil();
                format!("increase `at_most` to about {wanted}, or give the stages more lines")
            } else {
                let wanted = rounded_up(report.time.seconds * factor);
                format!("increase `at_most_seconds` to about {wanted}")
            };
            vec![format!(
                "after {repeats} repeats the relative error is {:.3} %, not {} %; {advice}",
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
