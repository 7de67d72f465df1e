//! The light of a run, and the stages of lines that add to it.

use sir_lines::{Focus, GlobalLines, LocalLines};
use sir_parallel::{Crew, RunError, Saved, StageRun, StageTime};
use sir_radiosity::{
    Inside, Model, MultipathSettings, PowerUnit, Quanta, Received, Shot, Solution, Transported,
};

use crate::plan::pipeline::Action;
use crate::plan::transport::{Body, Transport};
use crate::prepare::prepared::Prepared;
use crate::report::lines::Facts;
use crate::report::result::{DomainReport, ErrorsReport, LightReport};

/// Runs stages of lines, one after the other, and keeps the light that they have brought so far.
pub(crate) struct Lighting<'m> {
    model: &'m Model,
    light: Light,
    focus: Option<Focus>,
    inside: &'m Inside,
    /// What global lines were last drawn through.
    through: Option<(Body, GlobalLines)>,
}

/// All light so far.
enum Light {
    /// None yet, or it has been handed out.
    None,
    /// That of the shots, which leave to global lines what is reflected of it.
    Direct(Shot),
    /// That of the shots and of global lines.
    All(Transported),
}

/// What a stage of lines has done, but for the light.
pub(crate) struct Done {
    pub(crate) facts: Facts,
    /// The size of a quantum.
    pub(crate) unit: PowerUnit,
    pub(crate) time: StageTime,
}

impl<'m> Lighting<'m> {
    /// Darkness.
    pub(crate) fn new(prepared: &'m Prepared) -> Self {
        let Prepared { model, focus, inside, .. } = prepared;
        Self { model, light: Light::None, focus: *focus, inside, through: None }
    }

    /// Runs a stage, or goes on with one that was saved. `None` if it is not a stage of lines.
    pub(crate) fn run(
        &mut self,
        action: &Action,
        seed: u64,
        crew: &mut Crew<'_>,
        saved: Option<Saved>,
    ) -> Result<Option<Done>, RunError> {
        let (model, focus) = (self.model, self.focus);
        let done = match *action {
            Action::FirstShot { lines } => {
                self.light = Light::None;
                self.shot(sir_parallel::first_shot(
                    model,
                    LocalLines { count: lines, focus },
                    seed,
                    crew,
                    saved,
                )?)
            }
            Action::SecondShot { lines } => {
                let shot = self.take_shot();
                self.shot(sir_parallel::second_shot(
                    model,
                    shot,
                    LocalLines { count: lines, focus },
                    seed,
                    crew,
                    saved,
                )?)
            }
            Action::Multipath { lines, transport, body } => {
                let (shot, through) = (self.take_shot(), self.through(body));
                let report = DomainReport::of(&through);
                let run = match transport {
                    Transport::Batches => {
                        sir_parallel::batches(model, shot, lines, through, seed, crew, saved)?
                    }
                    Transport::Replicas { replicas, tail } => {
                        // A pipeline with a focus has none of these.
                        let domain = through.domain().clone();
                        let settings = MultipathSettings { lines, tail, replicas, domain };
                        sir_parallel::multipath(model, shot, settings, seed, crew, saved)?
                    }
                };
                self.transport(run, report)
            }
            _ => return Ok(None),
        };
        Ok(Some(done))
    }

    /// What the shots leave to the next stage. The decoder lets it follow nothing else; if they are not in memory, the state of
    /// that stage was saved, and has them.
    fn take_shot(&mut self) -> Shot {
        match std::mem::replace(&mut self.light, Light::None) {
            Light::Direct(shot) => shot,
            _ => Shot::nothing(self.model),
        }
    }

    fn through(&mut self, body: Body) -> GlobalLines {
        let known = self.through.take().filter(|(of, _)| *of == body);
        let lines = || (body, body.lines_around(&self.model.scene, self.focus));
        let (_, through) = self.through.insert(known.unwrap_or_else(lines));
        through.clone()
    }

    fn shot(&mut self, run: StageRun<Shot>) -> Done {
        let StageRun { outcome, time, batches } = run;
        let Shot { balance, counts, unit, .. } = outcome;
        let facts = Facts { balance, counts, batches, made_up: Quanta::ZERO, domain: None };
        self.light = Light::Direct(outcome);
        Done { facts, unit, time }
    }

    fn transport(&mut self, run: StageRun<Transported>, domain: DomainReport) -> Done {
        let StageRun { outcome, time, batches } = run;
        let Transported { balance, counts, made_up, unit, .. } = outcome;
        let facts = Facts { balance, counts, batches, made_up, domain: Some(domain) };
        self.light = Light::All(outcome);
        Done { facts, unit, time }
    }

    /// Power received so far; `None` if no stage has run.
    pub(crate) fn received(&self) -> Option<&Received> {
        match &self.light {
            Light::None => None,
            Light::Direct(shot) => Some(&shot.received),
            Light::All(all) => Some(&all.received),
        }
    }

    /// The result so far, and what to report of it. After global lines, which no stage can follow, nothing else is kept.
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
