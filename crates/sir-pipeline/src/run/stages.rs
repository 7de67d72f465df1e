//! Runs the stages of a pipeline, one after the other.

use sir_lightmap::LightmapError;
use sir_parallel::{Checkpoints, Executor, RunError, Saved, Threads, cores};
use sir_radiosity::{Measurement, ProbeMeasurement, SpreadOfMean};

use crate::error::Error;
use crate::plan::{Action, Output, Sensors};
use crate::prepare::layout::Placed;
use crate::prepare::prepared::Prepared;
use crate::ranks::agree;
use crate::report::glare::ratings;
use crate::report::luminaires::installed_watts;
use crate::report::page::{of_probes, of_sensors};
use crate::report::result::{
    BalanceReport, ErrorsFrom, LightReport, LinesReport, OutputReport, StageReport, Time,
};
use crate::report::sensors::SensorsReport;
use crate::run::computed::Computed;
use crate::run::execute::Run;
use crate::run::save::save;
use crate::run::saver::Saver;
use crate::run::sensor_files::SensorValues;
use crate::run::{probe_files, sensor_files};

impl Run<'_> {
    /// Runs all stages, or those from the stage of `saved` on.
    pub(crate) fn stages(
        &mut self,
        checkpoints: &mut Checkpoints,
        saved: Option<Saved>,
    ) -> Result<(), Error> {
        let Prepared { load_seconds, build_seconds, .. } = *self.prepared;
        let stages = &self.pipeline.stages;
        let first = stages.iter().position(|stage| stage.action.lines() > 0).unwrap_or(stages.len());
        if saved.is_none() && self.head.report.stages.is_empty() {
            for stage in &stages[..first] {
                let seconds = match &stage.action {
                    Action::Load(_) => load_seconds,
                    Action::Subdivide(_) => build_seconds,
                    _ => 0.0,
                };
                self.head.report.stages.push(StageReport::of(stage.action.name(), Time::of(seconds)));
            }
        }
        match self.prepared.groups.is_empty() {
            true => self.light(first, checkpoints, saved),
            false => self.groups(first, checkpoints, saved),
        }
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

    /// Returns the threads of this rank.
    pub(crate) fn threads(&self) -> Threads {
        Threads(self.options.threads.unwrap_or_else(cores))
    }

    /// Returns an executor without checkpoints.
    pub(crate) fn executor_without_checkpoints<'c>(&self) -> Executor<'c>
    where
        Self: 'c,
    {
        let mut executor = Executor::new(self.threads().0);
        executor.comm = self.comm;
        executor
    }

    /// Writes the files of a stage `Sensors` on rank 0, and returns the summary. `spread` has the errors of the mean, if the
    /// spread of repeats tells them, and `outdoor` the irradiance to which daylight factors refer \[W/m²\].
    pub(crate) fn write_sensors(
        &mut self,
        number: usize,
        sensors: &Sensors,
        measured: &[Measurement],
        spread: Option<&SpreadOfMean>,
        outdoor: Option<f64>,
    ) -> Result<SensorsReport, Error> {
        let Some(Placed::Sensors(layout)) = self.prepared.placed.get(&number) else {
            return Ok(SensorsReport::of(sensors, measured, spread, outdoor, None));
        };
        let ratings =
            sensors.ugr.then(|| ratings(&self.prepared.model, self.prepared.up, &layout.sensors, measured));
        let mut summary = SensorsReport::of(sensors, measured, spread, outdoor, ratings.as_deref());
        let room = layout.cells.as_ref().and_then(|cells| cells.room);
        let watts = installed_watts(&self.head.report.scene.luminaires);
        summary.power_density = watts.zip(room).map(|(watts, room)| watts / room);
        if self.pipeline.has_page() {
            let facts = of_sensors(layout, measured, ratings.as_deref(), &summary, self.pipeline.units);
            self.pages.sensors.push(facts);
        }
        let written = if self.comm.is_first() {
            let values = SensorValues { sensors, layout, measured, ratings: ratings.as_deref() };
            sensor_files::write(&values, &summary, self.pipeline.units, &self.directory)
        } else {
            Ok(Vec::new())
        };
        self.head.report.outputs.extend(agree(self.comm, written)?);
        Ok(summary)
    }

    /// Writes the files of the probes of a stage `Sensors` on rank 0, and returns their summary. `error` is the error
    /// of the mean over all probes, if it is known from the spread of repeats.
    pub(crate) fn write_probes(
        &mut self,
        number: usize,
        sensors: &Sensors,
        measured: &[ProbeMeasurement],
        error: Option<f64>,
    ) -> Result<SensorsReport, Error> {
        let means: Vec<Measurement> = measured.iter().map(ProbeMeasurement::mean).collect();
        let spread = error.map(|error| SpreadOfMean { error, ..SpreadOfMean::default() });
        let mut summary = SensorsReport::of(sensors, &means, spread.as_ref(), None, None);
        let Some(Placed::Probes(grid)) = self.prepared.placed.get(&number) else { return Ok(summary) };
        summary.invalid = Some(grid.len() - grid.valid.len());
        if self.pipeline.has_page() {
            self.pages.sensors.push(of_probes(&grid.valid, &means, &summary, self.pipeline.units));
        }
        let written = if self.comm.is_first() {
            let units = self.pipeline.units;
            probe_files::write(sensors, grid, measured, self.prepared, units, &self.directory)
        } else {
            Ok(Vec::new())
        };
        self.head.report.outputs.extend(agree(self.comm, written)?);
        Ok(summary)
    }

    /// Converts the error of an interrupted measurement. Sensors have no checkpoints of their own.
    pub(crate) fn interrupted_measuring(&self, error: RunError) -> Error {
        match error {
            RunError::Interrupted { .. } => Error::InterruptedMeasuring { directory: self.directory.clone() },
            other => other.into(),
        }
    }

    /// Writes the outputs of a `Save` on rank 0, if there is any light.
    pub(crate) fn save(&mut self, light: Option<&Computed>, outputs: &[Output]) -> Result<(), Error> {
        let saved = match light {
            Some(light) if self.comm.is_first() => self.write(light, outputs),
            _ => Ok(Vec::new()),
        };
        self.head.report.outputs.extend(agree(self.comm, saved)?);
        Ok(())
    }

    /// Returns what the outputs of this run have in common.
    pub(crate) fn saver(&self) -> Saver<'_> {
        let Self { pipeline, prepared, ref directory, progress, options, .. } = *self;
        Saver {
            pipeline,
            prepared,
            directory,
            threads: self.threads().0.get(),
            progress,
            stop: &options.stop,
        }
    }

    /// Writes outputs until the run is asked to stop.
    fn write(&mut self, light: &Computed, outputs: &[Output]) -> Result<Vec<OutputReport>, Error> {
        let mut reports = Vec::new();
        let threads = self.threads().0.get();
        let Self { pipeline, prepared, ref directory, options, progress, ref mut pages, .. } = *self;
        let saver = Saver { pipeline, prepared, directory, threads, progress, stop: &options.stop };
        match save(saver, light, outputs, &mut pages.pages, &mut reports) {
            Ok(true) => Ok(reports),
            Ok(false) => Err(Error::InterruptedSaving { directory: self.directory.clone() }),
            Err(Error::Lightmap(error)) if matches!(*error, LightmapError::Stopped) => {
                Err(Error::InterruptedSaving { directory: self.directory.clone() })
            }
            Err(error) => Err(error),
        }
    }
}

/// Relative error above which the errors themselves are uncertain: rare lines bring much of the light then.
const LARGE_ERROR: f64 = 0.1;

/// Returns a warning if the errors are too large to be known well. Errors of single lines have a warning of their own.
pub(crate) fn large_error_warning(light: &LightReport) -> Option<String> {
    let error = light.relative_error.into_iter().fold(0.0, f64::max);
    (light.errors.from == ErrorsFrom::Spread && error > LARGE_ERROR).then(|| {
        format!(
            "the relative error of a patch is {:.0} %; errors above {:.0} % are themselves uncertain; use more lines or fewer \
             patches",
            100.0 * error,
            100.0 * LARGE_ERROR
        )
    })
}

/// Returns a warning if the unshot power is so large that the result is visibly wrong.
pub(crate) fn unshot_warning(action: &Action, lines: &LinesReport) -> Vec<String> {
    let Action::Multipath(multipath) = action else { return Vec::new() };
    let BalanceReport { unshot, emitted, .. } = &lines.balance;
    let shares = unshot.iter().zip(emitted).filter(|(_, emitted)| **emitted > 0.0);
    let share = shares.map(|(unshot, emitted)| unshot / emitted).fold(0.0, f64::max);
    if !multipath.loses_unshot() || share <= 1e-3 {
        return Vec::new();
    }
    vec![format!(
        "{:.1} % of the reflected light remained unshot and is missing from the result; give `Multipath` more lines, fewer \
         replicas or a longer `tail`, or make fewer patches",
        100.0 * share
    )]
}
