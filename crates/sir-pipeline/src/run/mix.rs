//! The results for the sum of all light groups, each times a factor, from the files of the groups.

use std::path::Path;
use std::sync::Arc;

use sha2::{Digest, Sha256};
use sir_geom::{Rgb, luminance};
use sir_mesh::SideSums;
use sir_radiosity::{Measurement, ProbeMeasurement, Solution, SpreadOfMean, in_quadrature};

use crate::error::Error;
use crate::plan::Action;
use crate::report::groups::{errors_of_sum, sum_of_stages};
use crate::report::result::{GroupReport, LightReport, Time};
use crate::run::computed::{Computed, PartErrors};
use crate::run::execute::Run;
use crate::run::group_file::{GroupLight, GroupReader, Measurements};
use crate::run::repeat_sums::parts_of_tables;
use crate::run::repeating::independent_errors;
use crate::run::stages::large_error_warning;
use crate::stopwatch::Stopwatch;

impl Run<'_> {
    /// Reports all stages from number `first` on, and writes their files, for the sum of the light groups in the report, each
    /// times its factor. The lights of the scene must be dimmed accordingly.
    pub(super) fn mix(&mut self, first: usize, mut sum: Sum) -> Result<(), Error> {
        let (pipeline, prepared) = (self.pipeline, self.prepared);
        let parts = parts_of_tables(pipeline, prepared);
        let mut computed: Option<Computed> = None;
        for (number, stage) in pipeline.stages.iter().enumerate().skip(first) {
            let (watch, index) = (Stopwatch::start(), number - first);
            let mut report = sum_of_stages(stage.action.name(), &self.head.report.groups, index);
            match &stage.action {
                Action::Save(save) => {
                    self.save(computed.as_ref(), &save.outputs)?;
                    let warning = computed.as_ref().and_then(|light| independent_errors(light, save));
                    self.warn(warning.into_iter().collect());
                    report.time = Time::of(watch.seconds());
                }
                Action::Sensors(sensors) => {
                    if let Some(Measurements { all, spread }) = sum.sensors(number)? {
                        let outdoor = prepared.outdoor.map(|outdoor| outdoor * sum.dimming_of_sky());
                        let summary = self.write_sensors(number, sensors, &all, spread.as_ref(), outdoor)?;
                        report.sensors = Some(summary);
                    } else if let Some(Measurements { all, spread }) = sum.probes(number)? {
                        let error = spread.map(|spread| spread.error);
                        report.sensors = Some(self.write_probes(number, sensors, &all, error)?);
                    }
                }
                _ => {
                    // The previous light is no longer needed, and takes much memory.
                    drop(computed.take());
                    let Some(light) = sum.light(number)? else {
                        self.head.report.stages.push(report);
                        continue;
                    };
                    let (model, inside) = (&prepared.model, &prepared.inside);
                    let (errors, hash) =
                        (errors_of_sum(&self.head.report.groups, index), hash_of(&light.solution));
                    report.light = Some(LightReport::new(model, inside, &light.solution, errors, hash));
                    let is_last = pipeline.stages[number + 1..].iter().all(|stage| stage.action.lines() == 0);
                    computed = Some(light.computed(&parts, (!is_last).then(|| stage.action.name())));
                }
            }
            self.head.report.stages.push(report);
        }
        if let (Some(watcher), Some(light), false) = (self.watcher(), &computed, pipeline.has_page()) {
            self.show(watcher, light, "all light groups")?;
        }
        let last = self.head.report.stages.iter().rev().find_map(|stage| stage.light.as_ref());
        let warning = last.and_then(large_error_warning);
        self.warn(warning.into_iter().collect());
        Ok(())
    }
}

/// Files of all light groups of a run, with their factors.
pub(super) struct Sum {
    groups: Vec<(GroupReader, Rgb)>,
}

impl Sum {
    /// Opens the files in a run directory and verifies them.
    ///
    /// # Errors
    ///
    /// If a file cannot be read, is damaged, or belongs to a run with another fingerprint.
    pub(super) fn open(directory: &Path, groups: &[GroupReport], fingerprint: &str) -> Result<Self, Error> {
        let open = |(number, group): (usize, &GroupReport)| {
            Ok((GroupReader::open(directory, number, fingerprint)?, group.dimming()))
        };
        Ok(Self { groups: groups.iter().enumerate().map(open).collect::<Result<_, Error>>()? })
    }

    /// Returns the factor of the sky where there are daylight factors: the sky is then the only source.
    fn dimming_of_sky(&self) -> f64 {
        self.groups.iter().map(|(_, factor)| luminance(*factor)).fold(0.0, f64::max)
    }

    /// Returns the light after a stage, if the files have it.
    fn light(&mut self, stage: usize) -> Result<Option<GroupLight>, Error> {
        let (mut sum, mut none): (Option<GroupLight>, _) = (None, None);
        for (reader, factor) in &mut self.groups {
            let Some(light) = reader.light(stage)? else { return Ok(None) };
            if *factor == Rgb::ZERO {
                none.get_or_insert_with(|| light.dark());
            } else {
                sum.get_or_insert_with(|| light.dark()).add(&light, *factor);
            }
        }
        Ok(sum.or(none))
    }

    /// Returns the measurements of the sensors of a stage, if the files have them.
    fn sensors(&mut self, stage: usize) -> Result<Option<Measurements<Measurement>>, Error> {
        self.measurements(|reader| reader.sensors(stage), Measurement::add_dimmed, |one| one.irradiance)
    }

    /// Returns the measurements of the probes of a stage, if the files have them.
    fn probes(&mut self, stage: usize) -> Result<Option<Measurements<ProbeMeasurement>>, Error> {
        self.measurements(
            |reader| reader.probes(stage),
            ProbeMeasurement::add_dimmed,
            |one| one.mean().irradiance,
        )
    }

    /// Adds the measurements that `read` returns. `light` returns the irradiance of a measurement.
    fn measurements<T: Default + Clone>(
        &mut self,
        read: impl Fn(&mut GroupReader) -> Result<Option<Measurements<T>>, Error>,
        add: impl Fn(&mut T, &T, Rgb),
        light: impl Fn(&T) -> Rgb,
    ) -> Result<Option<Measurements<T>>, Error> {
        let mut sum: Option<Measurements<T>> = None;
        for (reader, factor) in &mut self.groups {
            let Some(more) = read(reader)? else { return Ok(None) };
            let sum = sum.get_or_insert_with(|| Measurements {
                all: vec![T::default(); more.all.len()],
                spread: Some(SpreadOfMean::default()),
            });
            if *factor == Rgb::ZERO {
                continue;
            }
            // The error of a mean is dimmed as much as the mean.
            let mean = more.all.iter().map(&light).sum::<Rgb>();
            let dimmed = match luminance(mean) {
                mean_luminance if mean_luminance > 0.0 => luminance(*factor * mean) / mean_luminance,
                _ => 1.0,
            };
            sum.spread =
                sum.spread.take().zip(more.spread).map(|(sum, more)| sum_of_spreads(sum, more, dimmed));
            sum.all.iter_mut().zip(&more.all).for_each(|(sum, more)| add(sum, more, *factor));
        }
        Ok(sum)
    }
}

/// Returns the errors of a sum of independent means, the second of which has a factor.
fn sum_of_spreads(mut sum: SpreadOfMean, more: SpreadOfMean, factor: f64) -> SpreadOfMean {
    let error = factor * more.error;
    sum.error = (sum.error * sum.error + error * error).sqrt();
    sum.covariances.resize(more.covariances.len(), 0.0);
    for (sum, more) in sum.covariances.iter_mut().zip(more.covariances) {
        *sum += factor * factor * more;
    }
    sum
}

impl GroupLight {
    /// Returns no light, with everything that this light has.
    fn dark(&self) -> Self {
        let sides = self.solution.irradiance.len();
        let none = |errors: &Option<Vec<[Rgb; 2]>>| errors.as_ref().map(|e| vec![[Rgb::ZERO; 2]; e.len()]);
        Self {
            solution: Solution::dark(sides),
            direct: self.direct.as_ref().map(|_| vec![Rgb::ZERO; sides]),
            part_errors: self.part_errors.iter().map(none).collect(),
        }
    }

    /// Adds independent light times a factor. Variances add.
    fn add(&mut self, other: &Self, factor: Rgb) {
        self.solution.add_dimmed(&other.solution, factor);
        self.direct = self.direct.take().zip(other.direct.as_ref()).map(|(mut sum, more)| {
            sum.iter_mut().zip(more).for_each(|(sum, more)| *sum += factor * more);
            sum
        });
        for (sum, more) in self.part_errors.iter_mut().zip(&other.part_errors) {
            // Only if the spread of repeats tells the errors of all groups, it tells those of the sum.
            *sum = sum.take().zip(more.as_ref()).map(|(mut sum, more)| {
                for (sum, more) in sum.as_flattened_mut().iter_mut().zip(more.as_flattened()) {
                    *sum = in_quadrature(*sum, factor * more);
                }
                sum
            });
        }
    }

    /// Returns the light as that after a stage. `parts` are the parts of the scene for which there are tables.
    fn computed(self, parts: &[Arc<SideSums>], not_final: Option<&'static str>) -> Computed {
        let errors = self.part_errors.into_iter();
        let parts = parts.iter().cloned().zip(errors).map(|(sums, errors)| PartErrors { sums, errors });
        let direct = self.direct.map(Into::into);
        Computed { solution: self.solution, parts: parts.collect(), not_final, direct }
    }
}

/// Returns the SHA-256 of the irradiances, which is equal for equal results.
fn hash_of(solution: &Solution) -> String {
    let mut hash = Sha256::new();
    let numbers = solution.irradiance.iter().flat_map(|color| color.to_array());
    numbers.for_each(|x| hash.update(x.to_bits().to_le_bytes()));
    hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}
