//! The first shot: local lines carry the light of the sources to the first surfaces.
//!
//! Martínez, Forés and Martín (2009), section 2; Castro, Martínez and Sbert (1998).

use std::ops::Range;

use sir_accel::Ray;
use sir_geom::Rgb;
use sir_lines::Purpose;

use crate::error::SolveError;
use crate::power::PowerUnit;
use crate::received::Received;
use crate::shot::{Shot, ShotSettings};
use crate::shot_lines::ShotLines;
use crate::sources::FocusedSources;
use crate::stage::{AnyOrder, Stage, Workers};
use crate::tallies::{Counters, PatchTallies};
use crate::totals::StageTotals;
use crate::visitor::Visitor;

/// The first shot: lines from all light sources, in proportion to their power.
#[derive(Debug)]
pub struct FirstShot<'m> {
    settings: ShotSettings<'m>,
    lines: ShotLines<'m>,
    tallies: PatchTallies,
}

impl FirstShot<'_> {
    /// Returns the ray of a line.
    #[must_use]
    pub fn ray(&self, index: u64) -> Ray {
        self.lines.ray(index)
    }
}

impl<'m> Stage for FirstShot<'m> {
    type Settings = ShotSettings<'m>;
    type Input = ();
    type Outcome = Shot;
    type Chain = AnyOrder;

    fn identity(settings: &Self::Settings) -> Vec<u64> {
        settings.identity(1)
    }

    fn begin(settings: Self::Settings, (): (), workers: &dyn Workers) -> Result<Self, SolveError> {
        let ShotSettings { model, lines, seed } = settings;
        let sources = FocusedSources::new(model, lines.focus.as_ref());
        let total = sources.sources.iter().fold(Rgb::ZERO, |sum, s| sum + s.power);
        if total.max_element() <= 0.0 {
            return Err(SolveError::NoLight);
        }
        let reflectance = model.mesh.largest_reflectance(&model.scene);
        let unit = PowerUnit::for_total(total.max_element(), reflectance);
        let lines = ShotLines::new(model, sources, unit, lines.count, seed, Purpose::FIRST_SHOT);
        let tallies = lines.tallies(workers.count());
        Ok(Self { settings, lines, tallies })
    }

    fn restore(
        settings: Self::Settings,
        workers: &dyn Workers,
        visitor: &mut dyn Visitor,
    ) -> Result<Self, SolveError> {
        let mut stage = Self::begin(settings, (), workers)?;
        stage.visit(visitor);
        Ok(stage)
    }

    fn round(&self) -> Range<u64> {
        0..self.lines.lines()
    }

    fn chain(&self, _number: u64) -> AnyOrder {
        AnyOrder
    }

    fn trace(&self, worker: usize, _chain: &mut AnyOrder, lines: Range<u64>, totals: &mut StageTotals) {
        self.lines.trace(worker, lines, &self.tallies, totals);
    }

    fn visit_round(&mut self, visitor: &mut dyn Visitor) {
        self.tallies.visit(Counters::All, visitor);
    }

    fn visit(&mut self, visitor: &mut dyn Visitor) {
        self.tallies.visit(Counters::All, visitor);
    }

    fn finish(self, totals: StageTotals) -> Result<Shot, SolveError> {
        let nothing = Received::nothing(self.settings.model.mesh.side_count());
        self.lines.add_to(nothing, &self.tallies, totals)
    }
}
