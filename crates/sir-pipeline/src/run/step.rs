//! A stage that is run in every repeat, with the sums of its outcomes.

use sir_lines::Focus;
use sir_parallel::{StageTime, Threads};
use sir_radiosity::{Model, RepeatedTotals, Repeats, Visitor};

use crate::plan::Action;
use crate::report::lines::Facts;
use crate::report::result::DomainReport;
use crate::run::lighting::{Done, Lighting};
use crate::run::measured::Measured;

/// A stage that is run in every repeat.
pub(super) struct Step<'a> {
    /// Number of the stage in the pipeline, and in a `Repeat` or `Solve`.
    pub(super) place: (usize, usize),
    pub(super) action: &'a Action,
    pub(super) totals: RepeatedTotals,
    pub(super) batches: u64,
    pub(super) time: StageTime,
    pub(super) domain: Option<DomainReport>,
    /// Sums of the light after this stage, if it has a use.
    pub(super) light: Option<Repeats>,
    pub(super) use_of_light: UseOfLight,
    /// Sums of the measurements of this stage.
    pub(super) measured: Option<Measured>,
}

/// Use of the light after a stage.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) struct UseOfLight {
    /// True if it is a result: it is shown or measured, or is the last.
    pub(super) is_result: bool,
    /// True if it is the direct light that a page shows.
    pub(super) is_direct: bool,
}

impl<'a> Step<'a> {
    pub(super) fn new(
        place: (usize, usize),
        action: &'a Action,
        light: Option<Repeats>,
        use_of_light: UseOfLight,
        measured: Option<Measured>,
    ) -> Self {
        let (totals, time) = (RepeatedTotals::default(), StageTime::default());
        Self { place, action, totals, batches: 0, time, domain: None, light, use_of_light, measured }
    }

    /// Adds the outcome of the stage in a repeat.
    pub(super) fn add(&mut self, done: Done, model: &Model, lighting: &Lighting<'_>, threads: &Threads) {
        let Done { facts: Facts { balance, counts, batches, walked, domain }, time, .. } = done;
        self.totals.add(&balance, counts, walked);
        self.batches += batches;
        self.time += time;
        self.domain = domain;
        if let (Some(sums), Some((received, counted))) = (&mut self.light, lighting.received()) {
            sums.add(model, received, counted, threads);
        }
    }

    /// Visits the sums.
    pub(super) fn visit(&mut self, model: &Model, focus: Option<Focus>, visitor: &mut dyn Visitor) {
        self.totals.visit(visitor);
        let mut word = [self.batches as i64];
        visitor.same(&mut word);
        self.batches = word[0] as u64;
        self.time.visit(visitor);
        if let Some(light) = &mut self.light {
            let domain = || match self.action {
                Action::Multipath(multipath) => Some(multipath.domain.lines_around(&model.scene, focus)),
                _ => None,
            };
            light.visit(domain, visitor);
        }
        if let Some(measured) = &mut self.measured {
            measured.visit(visitor);
        }
    }
}
