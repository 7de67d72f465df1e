//! Light groups of a run, one after the other: all stages run with the lights of a group only, and its light is kept in a
//! file.

use std::io;

use sir_parallel::{Checkpoints, RunError, Saved, SingleProcess};
use sir_radiosity::SpreadOfMean;
use sir_view::write_atomically;

use crate::error::Error;
use crate::error_kind::ErrorKind;
use crate::plan::Action;
use crate::prepare::light_groups::{LightGroup, only};
use crate::ranks::{agree, broadcast_text};
use crate::report::result::{GroupReport, StageReport, Time};
use crate::run::computed::Computed;
use crate::run::execute::Run;
use crate::run::group_file::{GroupLight, GroupReader, GroupWriter, Measurements, path_of};
use crate::run::measured::Measured;
use crate::run::mix::Sum;
use crate::run::pages::Pages;
use crate::run::repeat_sums::RepeatSums;
use crate::run::resume::Head;

impl Run<'_> {
    /// Computes the light of each light group that is not finished, with the stages from number `first` on, and writes the
    /// results for the sum of all.
    pub(super) fn groups(
        &mut self,
        first: usize,
        checkpoints: &mut Checkpoints,
        mut saved: Option<Saved>,
    ) -> Result<(), Error> {
        let groups = &self.prepared.groups;
        self.check_finished_groups()?;
        while let Some(group) = groups.get(self.head.group) {
            let number = self.head.group;
            self.progress.note(&format!("Light group {} ({} of {})", group.name, number + 1, groups.len()));
            if saved.is_none() && number > 0 {
                self.save_start(checkpoints)?;
            }
            let prepared = self.prepared.dimmed(&only(number, groups.len()));
            let mut part = Run {
                prepared: &prepared,
                group: Some(group),
                directory: self.directory.clone(),
                lock: None,
                head: self.head.clone(),
                pages: Pages::default(),
                ..*self
            };
            let outcome = part.light(first, checkpoints, saved.take());
            self.head = part.head;
            outcome?;
            self.close_group(first, group);
        }
        self.save_start(checkpoints)?;
        self.write_sum(first)
    }

    /// Moves the reports of the stages of a finished group to that of the group.
    fn close_group(&mut self, first: usize, group: &LightGroup) {
        let stages = self.head.report.stages.split_off(first.min(self.head.report.stages.len()));
        let (name, power) = (group.name.clone(), group.power.to_array());
        self.head.report.groups.push(GroupReport { name, power, factor: [1.0; 3], stages });
        self.head.group += 1;
    }

    /// Saves a checkpoint before the first stage of a group, or after the last group.
    fn save_start(&mut self, checkpoints: &mut Checkpoints) -> Result<(), Error> {
        self.head.rewind();
        self.head.report.time.seconds = self.seconds();
        checkpoints.set_head(self.head.to_line());
        agree(self.comm, checkpoints.save_start(self.comm).map_err(|error| RunError::from(error).into()))
    }

    /// Returns an error if the file of a group that was finished before a run was resumed is missing or damaged.
    fn check_finished_groups(&self) -> Result<(), Error> {
        let check = |number| GroupReader::open(&self.directory, number, &self.head.fingerprint).map(drop);
        agree(self.comm, if self.comm.is_first() { (0..self.head.group).try_for_each(check) } else { Ok(()) })
    }

    /// Writes the light of a group and its measurements to its file, and reports its stages from number `first` on.
    pub(super) fn keep(&mut self, first: usize, repeating: &mut RepeatSums<'_>) -> Result<(), Error> {
        let path = path_of(&self.directory, self.head.group);
        let kept = match self.comm.is_first() {
            true => write_atomically(&path, |file| self.keep_in(file, first, repeating)).map_err(Error::from),
            // The other ranks have the same light, and need the reports.
            false => self
                .keep_in(&mut io::sink(), first, repeating)
                .map_err(|_| Error::Elsewhere { rank: 0, kind: ErrorKind::Failed }),
        };
        agree(self.comm, kept)?;
        self.close_report(repeating);
        Ok(())
    }

    fn keep_in(
        &mut self,
        file: &mut dyn io::Write,
        first: usize,
        repeating: &mut RepeatSums<'_>,
    ) -> io::Result<()> {
        let fingerprint = self.head.fingerprint.clone();
        let mut writer = GroupWriter::new(file, self.head.group, &fingerprint)?;
        for (number, stage) in self.pipeline.stages.iter().enumerate().skip(first) {
            let mut report = StageReport::of(stage.action.name(), Time::of(0.0));
            if stage.action.lines() > 0 {
                let light;
                (report, light) = self.report_lines(number, repeating);
                if let Some(light) = light {
                    writer.light(number, &kept_light(light))?;
                }
            } else if let Action::Sensors(_) = stage.action {
                for step in &repeating.steps[repeating.steps_of(number)] {
                    let rays = match &step.measured {
                        Some(Measured::Sensors(measured)) => {
                            let (all, spread) = (measured.means(), measured.spread_of_mean());
                            let rays = all.iter().map(|one| one.rays).sum();
                            writer.sensors(number, &Measurements { all, spread })?;
                            rays
                        }
                        Some(Measured::Probes(measured)) => {
                            let spread = measured.error_of_mean();
                            let spread =
                                spread.map(|error| SpreadOfMean { error, ..SpreadOfMean::default() });
                            let all = measured.means();
                            let rays = all.iter().map(|one| one.rays).sum();
                            writer.probes(number, &Measurements { all, spread })?;
                            rays
                        }
                        None => continue,
                    };
                    report.time = Time::of_lines(step.time, rays);
                }
            }
            self.head.report.stages.push(report);
        }
        writer.finish()
    }

    /// Writes the results for the sum of all groups on rank 0, and passes the report to the other ranks.
    fn write_sum(&mut self, first: usize) -> Result<(), Error> {
        let comm = self.comm;
        let written = if comm.is_first() {
            let Head { report, fingerprint, .. } = &self.head;
            let sum = Sum::open(&self.directory, &report.groups, fingerprint);
            // The other ranks have no part in it.
            self.comm = &SingleProcess;
            let written = sum.and_then(|sum| self.mix(first, sum));
            self.comm = comm;
            written
        } else {
            Ok(())
        };
        agree(comm, written)?;
        let text = broadcast_text(comm, &self.head.to_line());
        if let (false, Ok(head)) = (comm.is_first(), serde_json::from_str(&text)) {
            self.head = head;
        }
        Ok(())
    }
}

/// Returns what a file keeps of the light after a stage.
fn kept_light(light: Computed) -> GroupLight {
    let Computed { solution, parts, direct, .. } = light;
    let part_errors = parts.into_iter().map(|parts| parts.errors).collect();
    GroupLight { solution, direct: direct.map(|direct| direct.to_vec()), part_errors }
}
