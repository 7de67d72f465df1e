//! Runs the stages of a pipeline, one after the other.

use std::sync::atomic::Ordering::Relaxed;

use sir_parallel::{Checkpoints, Executor, RunError, Saved, Start, cores};
use sir_radiosity::{SensorStage, SensorTask, Solution};

use crate::error::Error;
use crate::plan::{Action, Output, Sensors, Stage};
use crate::ranks::agree;
use crate::report::result::{ErrorsFrom, ErrorsReport, LinesReport, OutputReport, StageReport, Time};
use crate::report::sensors::SensorsReport;
use crate::run::execute::Run;
use crate::run::lighting::Lighting;
use crate::run::reach::{dark_warning, few_lines_warning};
use crate::run::save::save;
use crate::run::sensor_files;
use crate::stopwatch::Stopwatch;

impl Run<'_> {
    /// Runs all stages, or those from the stage of `saved` on.
    pub(crate) fn stages(
        &mut self,
        checkpoints: &mut Checkpoints,
        mut saved: Option<Saved>,
    ) -> Result<(), Error> {
        let prepared = self.prepared;
        let mut lighting = Lighting::new(prepared);
        let mut solution = None;
        for (number, stage) in self.pipeline.stages.iter().enumerate().skip(self.head.stage) {
            let (name, watch) = (stage.action.name(), Stopwatch::start());
            let report = match &stage.action {
                Action::Load(_) => StageReport::of(name, Time::of(prepared.load_seconds)),
                Action::Light(_) | Action::Focus(_) => StageReport::of(name, Time::of(0.0)),
                Action::Subdivide(_) => StageReport::of(name, Time::of(prepared.build_seconds)),
                Action::Sensors(sensors) => match &solution {
                    Some(solution) => self.measure(number, sensors, solution)?,
                    None => StageReport::of(name, Time::of(0.0)),
                },
                Action::Save(save) => {
                    self.save(solution.as_ref(), &save.outputs)?;
                    StageReport::of(name, Time::of(watch.seconds()))
                }
                Action::Repeat(repeat) => {
                    let (report, mean) = self.repeat(number, repeat, checkpoints, saved.take())?;
                    solution = Some(mean);
                    report
                }
                Action::FirstShot(_) | Action::SecondShot(_) | Action::Multipath(_) => {
                    // The previous solution is no longer needed, and takes much memory.
                    drop(solution.take());
                    let (report, light) =
                        self.lines(number, stage, &mut lighting, checkpoints, saved.take())?;
                    solution = light;
                    report
                }
            };
            self.head.report.stages.push(report);
        }
        Ok(())
    }

    /// Runs a stage with lines.
    fn lines(
        &mut self,
        number: usize,
        stage: &Stage,
        lighting: &mut Lighting<'_>,
        checkpoints: &mut Checkpoints,
        saved: Option<Saved>,
    ) -> Result<(StageReport, Option<Solution>), Error> {
        let (name, action) = (stage.action.name(), &stage.action);
        self.begin(number, (0, 0), checkpoints);
        let mut executor = self.executor(checkpoints);
        executor.observer = Box::new(self.progress.stage(name, action.lines(), &self.options.stop));
        let done = lighting.run(action, self.head.report.seed, &mut executor, saved);
        drop(executor);
        let mut report = StageReport::of(name, Time::of(0.0));
        let Some(done) = agree(self.comm, done.map_err(Error::from))? else { return Ok((report, None)) };
        let lines = LinesReport::new(done.facts, done.unit);
        self.warn(unshot_warning(action, &lines));
        self.warn(dark_warning(action, &lines));
        let before = self.head.report.stages.iter().filter_map(|stage| stage.lines.as_ref());
        let samples = before.chain([&lines]).map(|lines| lines.lines).sum();
        let result = lighting.result(ErrorsReport { from: ErrorsFrom::Lines, samples });
        let (light, solution) = result.unzip();
        if let Some(solution) = &solution {
            self.warn(few_lines_warning(self.prepared, &lines, solution));
        }
        report.time = Time::of_lines(done.time, action.lines());
        (report.lines, report.light) = (Some(lines), light);
        Ok((report, solution))
    }

    /// Sets the metadata of checkpoints for a stage with lines that begins. `repeat` has the number of the repeat, and
    /// that of the stage in it.
    pub(crate) fn begin(&mut self, number: usize, repeat: (u64, usize), checkpoints: &mut Checkpoints) {
        self.head.stage = number;
        (self.head.repeat, self.head.part) = repeat;
        self.head.report.time.seconds = self.seconds();
        checkpoints.set_head(self.head.to_line());
    }

    /// Returns an executor with checkpoints.
    pub(crate) fn executor<'c>(&self, checkpoints: &'c mut Checkpoints) -> Executor<'c>
    where
        Self: 'c,
    {
        let mut executor = self.executor_without_checkpoints();
        executor.checkpoints = Some(checkpoints);
        executor
    }

    /// Returns an executor without checkpoints.
    fn executor_without_checkpoints<'c>(&self) -> Executor<'c>
    where
        Self: 'c,
    {
        let mut executor = Executor::new(self.options.threads.unwrap_or_else(cores));
        executor.comm = self.comm;
        executor
    }

    /// Measures at the sensors of a stage, and writes its files.
    fn measure(
        &mut self,
        number: usize,
        sensors: &Sensors,
        solution: &Solution,
    ) -> Result<StageReport, Error> {
        let mut report = StageReport::of("Sensors", Time::of(0.0));
        let Some(layout) = self.prepared.layouts.get(&number) else { return Ok(report) };
        let mut executor = self.executor_without_checkpoints();
        let total = sensors.rays * layout.sensors.len() as u64;
        executor.observer = Box::new(self.progress.stage("Sensors", total, &self.options.stop));
        // Each stage `Sensors` has independent random numbers.
        let seed = self.head.report.seed.wrapping_add((number as u64) << 48);
        let model = &self.prepared.model;
        let settings = sensors.settings();
        let task = SensorTask { model, solution, sensors: &layout.sensors, settings, seed };
        let done = executor.run::<SensorStage<'_>>(task, Start::Fresh(()));
        drop(executor);
        let done = agree(self.comm, done.map_err(|error| self.interrupted_measuring(error)))?;
        let measured = SensorsReport::new(&sensors.name, &done.outcome);
        report.time = Time::of_lines(done.time, measured.rays);
        report.sensors = Some(measured);
        let written = if self.comm.is_first() {
            sensor_files::write(sensors, layout, &done.outcome, self.pipeline.units, &self.directory)
        } else {
            Ok(Vec::new())
        };
        self.head.report.outputs.extend(agree(self.comm, written)?);
        Ok(report)
    }

    /// Converts the error of an interrupted measurement. Sensors have no checkpoints of their own.
    fn interrupted_measuring(&self, error: RunError) -> Error {
        match error {
            RunError::Interrupted { .. } => Error::InterruptedMeasuring { directory: self.directory.clone() },
            other => other.into(),
        }
    }

    /// Writes the outputs of a `Save` on rank 0, if there is any light.
    fn save(&mut self, solution: Option<&Solution>, outputs: &[Output]) -> Result<(), Error> {
        let saved = match solution {
            Some(solution) if self.comm.is_first() => self.write(solution, outputs),
            _ => Ok(Vec::new()),
        };
        self.head.report.outputs.extend(agree(self.comm, saved)?);
        Ok(())
    }

    /// Writes outputs until the run is asked to stop.
    fn write(&self, solution: &Solution, outputs: &[Output]) -> Result<Vec<OutputReport>, Error> {
        let mut reports = Vec::new();
        let threads = self.options.threads.unwrap_or_else(cores).get();
        save(self.prepared, solution, outputs, &self.directory, threads, self.progress, &mut |report| {
            reports.push(report);
            !self.options.stop.load(Relaxed)
        })?;
        if reports.len() < outputs.len() {
            return Err(Error::InterruptedSaving { directory: self.directory.clone() });
        }
        Ok(reports)
    }
}

/// Returns a warning if the unshot power is so large that the result is visibly wrong.
pub(crate) fn unshot_warning(action: &Action, lines: &LinesReport) -> Vec<String> {
    let Action::Multipath(multipath) = action else { return Vec::new() };
    let balance = &lines.balance;
    let share = |parts: &[f64; 3]| {
        let shares = parts.iter().zip(&balance.emitted).filter(|(_, e)| **e > 0.0).map(|(part, e)| part / e);
        shares.fold(0.0, f64::max)
    };
    let unshot = share(&balance.unshot);
    let extrapolated = multipath.extrapolates()
        && balance.unshot.iter().zip(&lines.extrapolated).all(|(unshot, more)| *unshot <= 0.0 || *more > 0.0);
    if extrapolated && unshot > 0.1 {
        return vec![format!(
            "{:.0} % of the reflected light remained unshot and was extrapolated from the light sent before it; give `Multipath` \
             more lines, or make fewer patches",
            100.0 * unshot
        )];
    }
    if extrapolated || unshot <= 1e-3 {
        return Vec::new();
    }
    vec![format!(
        "{:.1} % of the reflected light remained unshot and is missing from the result; give `Multipath` {}, or make fewer \
         patches",
        100.0 * unshot,
        multipath.advice_on_unshot()
    )]
}
