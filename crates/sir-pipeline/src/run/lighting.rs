//! Light of a run, and the stages with lines that add to it.

use sir_lines::{Focus, GlobalLines, LocalLines};
use sir_parallel::{Executor, RunError, Saved, StageRun, StageTime, Start};
use sir_radiosity::{
    Balance, Counted, Counts, FirstShot, Model, Points, PowerUnit, Received, SecondShot, ShadowRaySettings,
    ShadowRays, Shot, ShotSettings, Solution, Transported, Walked, Workers,
};

use crate::plan::{Action, DomainKind};
use crate::prepare::prepared::Prepared;
use crate::report::lines::Facts;
use crate::report::result::DomainReport;

/// Runs stages with lines, one after the other, and keeps the light computed so far.
pub(crate) struct Lighting<'m> {
    model: &'m Model,
    light: Light,
    focus: Option<Focus>,
    /// Points of the lines of shots.
    points: Points,
    /// Global lines of the last stage that used them.
    global: Option<(DomainKind, GlobalLines)>,
}

/// Light computed so far.
enum Light {
    /// No light yet, or it has been passed on.
    None,
    /// Light of the shots, whose reflected power remains for global lines.
    Direct(Box<Shot>),
    /// Light of the shots and of global lines.
    All(Box<Transported>),
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
    pub(crate) fn new(prepared: &'m Prepared, points: Points) -> Self {
        let Prepared { model, focus, .. } = prepared;
        Self { model, light: Light::None, focus: *focus, points, global: None }
    }

    /// Runs a stage with this number of lines, or resumes a saved one. Returns `None` if it is not a stage with lines.
    pub(crate) fn run(
        &mut self,
        action: &Action,
        lines: u64,
        seed: u64,
        executor: &mut Executor<'_>,
        saved: Option<Saved>,
    ) -> Result<Option<Done>, RunError> {
        let model = self.model;
        let shot =
            ShotSettings::new(model, LocalLines { count: lines, focus: self.focus }, seed).with(self.points);
        let done = match action {
            Action::FirstShot(_) => {
                let start = saved.map_or(Start::Fresh(()), Start::Resumed);
                self.light = Light::None;
                self.shot(executor.run::<FirstShot<'_>>(shot, start)?)
            }
            Action::ShadowRays(_) => {
                let Some(start) = self.start(saved) else { return Ok(None) };
                let rays = shot.lines;
                let settings = ShadowRaySettings { model, rays, seed, points: self.points, every: 1 };
                let StageRun { outcome: (shot, counts), time, batches } =
                    executor.run::<ShadowRays<'_>>(settings, start)?;
                // Rays carry no power: they find out what arrives.
                self.direct(StageRun { outcome: shot, time, batches }, Balance::default(), counts)
            }
            Action::SecondShot(stage) => {
                let Some(start) = self.start(saved) else { return Ok(None) };
                self.shot(executor.run::<SecondShot<'_>>(shot.of_reflected(stage.share), start)?)
            }
            Action::Multipath(stage) => {
                let Some(start) = self.start(saved) else { return Ok(None) };
                let domain = self.global_lines(stage.domain);
                let report = DomainReport::of(&domain);
                self.transport(stage.run(model, domain, lines, seed, start, executor)?, report)
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
            (None, Light::Direct(shot)) => Some(Start::Fresh(*shot)),
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
        let Shot { balance, counts, .. } = run.outcome;
        self.direct(run, balance, counts)
    }

    fn direct(&mut self, run: StageRun<Shot>, balance: Balance, counts: Counts) -> Done {
        let StageRun { outcome, time, batches } = run;
        let unit = outcome.unit;
        let facts = Facts { balance, counts, batches, walked: Walked::default(), domain: None };
        self.light = Light::Direct(Box::new(outcome));
        Done { facts, unit, time }
    }

    fn transport(&mut self, run: StageRun<Transported>, domain: DomainReport) -> Done {
        let StageRun { outcome, time, batches } = run;
        let Transported { balance, counts, walked, unit, .. } = outcome;
        let facts = Facts { balance, counts, batches, walked, domain: Some(domain) };
        self.light = Light::All(Box::new(outcome));
        Done { facts, unit, time }
    }

    /// Returns the power received so far, and what counted lines have brought besides; `None` if no stage has run.
    pub(crate) fn received(&self) -> Option<(&Received, Option<&Counted>)> {
        match &self.light {
            Light::None => None,
            Light::Direct(shot) => Some((&shot.received, None)),
            Light::All(all) => Some((&all.uncounted, all.counted.as_ref())),
        }
    }

    /// Returns the result so far; `None` if no stage has run.
    pub(crate) fn solution(&self, workers: &dyn Workers) -> Option<Solution> {
        match &self.light {
            Light::None => None,
            Light::Direct(shot) => Some(shot.solution(self.model)),
            Light::All(all) => Some(Solution::new(self.model, &all.received(self.model, workers), all.unit)),
        }
    }
}
