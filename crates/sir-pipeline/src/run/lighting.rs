//! Light of a run, and the stages with lines that add to it.

use sir_lines::{Focus, GlobalLines, LocalLines};
use sir_parallel::{Executor, RunError, Saved, StageRun, StageTime, Start};
use sir_radiosity::{
    FirstShot, FocusSides, Model, PowerUnit, Quanta, Received, SecondShot, Shot, ShotSettings, Solution,
    Transported,
};

use crate::plan::{Action, DomainKind};
use crate::prepare::prepared::Prepared;
use crate::report::lines::Facts;
use crate::report::result::{DomainReport, ErrorsReport, LightReport};

/// Runs stages with lines, one after the other, and keeps the light computed so far.
pub(crate) struct Lighting<'m> {
    model: &'m Model,
    light: Light,
    focus: Option<Focus>,
    inside: &'m FocusSides,
    /// Global lines of the last stage that used them.
    global: Option<(DomainKind, GlobalLines)>,
}

/// Light computed so far.
enum Light {
    /// No light yet, or it has been passed on.
    None,
    /// Light of the shots, whose reflected power remains for global lines.
    Direct(Shot),
    /// Light of the shots and of global lines.
    All(Transported),
}

/// Outcome of a stage with lines, without the light.
pub(crate) struct Done {
    pub(crate) facts: Facts,
    /// Size of a quantum.
    pub(crate) unit: PowerUnit,
    pub(crate) time: StageTime,
}

impl<'m> Lighting<'m> {
    /// Creates a lighting without light.
    pub(crate) fn new(prepared: &'m Prepared) -> Self {
        let Prepared { model, focus, inside, .. } = prepared;
        Self { model, light: Light::None, focus: *focus, inside, global: None }
    }

    /// Runs a stage, or resumes a saved one. Returns `None` if it is not a stage with lines.
    pub(crate) fn run(
        &mut self,
        action: &Action,
        seed: u64,
        executor: &mut Executor<'_>,
        saved: Option<Saved>,
    ) -> Result<Option<Done>, RunError> {
        let model = self.model;
        let shot = |lines| ShotSettings::new(model, LocalLines { count: lines, focus: self.focus }, seed);
        let done = match action {
            Action::FirstShot(stage) => {
                let start = saved.map_or(Start::Fresh(()), Start::Resumed);
                self.light = Light::None;
                self.shot(executor.run::<FirstShot<'_>>(shot(stage.lines), start)?)
            }
            Action::SecondShot(stage) => {
                let settings = shot(stage.lines);
                let Some(start) = self.start(saved) else { return Ok(None) };
                self.shot(executor.run::<SecondShot<'_>>(settings, start)?)
            }
            Action::Multipath(stage) => {
                let Some(start) = self.start(saved) else { return Ok(None) };
                let domain = self.global_lines(stage.domain);
                let report = DomainReport::of(&domain);
                self.transport(stage.run(model, domain, seed, start, executor)?, report)
            }
            _ => return Ok(None),
        };
        Ok(Some(done))
    }

    /// Returns the start of a stage after a shot: the saved state, or the light of the shots so far. Returns `None` if
    /// there is neither, which the order of stages excludes.
    fn start(&mut self, saved: Option<Saved>) -> Option<Start<Shot>> {
        match (saved, std::mem::replace(&mut self.light, Light::None)) {
            (Some(saved), _) => Some(Start::Resumed(saved)),
            (None, Light::Direct(shot)) => Some(Start::Fresh(shot)),
            (None, _) => None,
        }
    }

    /// Returns the global lines through a domain. Reuses those of the last stage, because a large scene takes time.
    fn global_lines(&mut self, domain: DomainKind) -> GlobalLines {
        let known = self.global.take().filter(|(of, _)| *of == domain);
        let lines = || (domain, domain.lines_around(&self.model.scene, self.focus));
        let (_, lines) = self.global.insert(known.unwrap_or_else(lines));
        lines.clone()
    }

    fn shot(&mut self, run: StageRun<Shot>) -> Done {
        let StageRun { outcome, time, batches } = run;
        let Shot { balance, counts, unit, .. } = outcome;
        let facts = Facts { balance, counts, batches, extrapolated: Quanta::ZERO, domain: None };
        self.light = Light::Direct(outcome);
        Done { facts, unit, time }
    }

    fn transport(&mut self, run: StageRun<Transported>, domain: DomainReport) -> Done {
        let StageRun { outcome, time, batches } = run;
        let Transported { balance, counts, extrapolated, unit, .. } = outcome;
        let facts = Facts { balance, counts, batches, extrapolated, domain: Some(domain) };
        self.light = Light::All(outcome);
        Done { facts, unit, time }
    }

    /// Returns the power received so far, or `None` if no stage has run.
    pub(crate) fn received(&self) -> Option<&Received> {
        match &self.light {
            Light::None => None,
            Light::Direct(shot) => Some(&shot.received),
            Light::All(all) => Some(&all.received),
        }
    }

    /// Returns the result so far, and its report. After global lines, which are the last stage with lines, the light is
    /// not kept.
    pub(crate) fn result(&mut self, errors: ErrorsReport) -> Option<(LightReport, Solution)> {
        let hash = self.received()?.hash();
        let solution = match std::mem::replace(&mut self.light, Light::None) {
            Light::None => return None,
            Light::Direct(shot) => {
                let solution = shot.solution(self.model);
                self.light = Light::Direct(shot);
                solution
            }
            Light::All(all) => all.solution,
        };
        Some((LightReport::new(self.model, self.inside, &solution, errors, hash), solution))
    }
}
