//! The lines of a `Solve`: how many the first shot, the second shot and the global lines get.
//!
//! The relative variance of the light is a sum over the three stages, each of which contributes in inverse proportion to its
//! lines: `a/F + b/S + c/G`. A pilot of few lines estimates `a`, `b` and `c`. If lines take the times `1`, `1` and `κ`, the
//! product of variance and time is smallest for `F : S : G = √a : √b : √(c/κ)` (Lagrange; as in optimal allocation of strata,
//! Neyman 1934), where it is `(√a + √b + √(cκ))²`. The noise that reflected light inherits from earlier stages is left out.

use serde::{Deserialize, Serialize};
use sir_lines::{GlobalLines, LocalLines, seed_of_repeat};
use sir_parallel::Start;
use sir_radiosity::{
    BatchSettings, Batches, FirstShot, Model, SecondShot, Shot, ShotSettings, Solution, Transported,
    crossings_per_patch,
};

use crate::error::Error;
use crate::format::{grouped, percent};
use crate::plan::{Action, DomainKind, FirstShot as First, Multipath, SecondShot as Second, Transport};
use crate::ranks::agree;
use crate::report::light::Deviation;
use crate::run::execute::Run;
use crate::run::sharing::{CROSSINGS, SHARED};

/// Lines of each shot of the pilot, as a share of all lines.
const PILOT_SHOT: f64 = 1.0 / 64.0;

/// Crossings of a typical patch by the global lines of the pilot, and the largest share of all lines for them.
const PILOT_CROSSINGS: (f64, f64) = (8.0, 1.0 / 64.0);

/// Shares of the reflected light that a second shot may send, of which the pilot tries each.
const SHARES: [f64; 3] = [0.0, 0.5, 1.0];

/// Time of a global line over that of a local line: for the line itself, and for each surface that it crosses. Measured on
/// the Cornell box and the museum's stair.
const GLOBAL_TIME: [f64; 2] = [1.0, 0.5];

/// Smallest and largest share of all lines for the first shot and for global lines.
const BOUNDS: (f64, f64) = (0.05, 0.9);

/// Largest share of all lines for those global lines that are needed for the spread of repeats.
const REPEATS_SHARE: f64 = 0.25;

/// Number of the repeat whose seed the pilot has. No run has that many repeats.
const PILOT_REPEAT: u64 = u64::MAX;

/// Lines of the stages of a `Solve`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Split {
    /// Lines of the first shot.
    first: u64,
    /// Lines of the second shot. There is no second shot without lines.
    second: u64,
    /// Share of the reflected light that they carry.
    share: f64,
    /// Global lines.
    global: u64,
    /// Lines of the pilot.
    pub(crate) pilot: u64,
}

/// What the pilot says of one share of the reflected light: the relative variances times the numbers of lines.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Trial {
    share: f64,
    first: f64,
    second: f64,
    global: f64,
}

impl Split {
    /// Returns a usual split, for estimates of time.
    pub(crate) fn usual(lines: u64) -> Self {
        let (second, global) = (lines / 4, (lines / 4).max(1));
        Self { first: lines.saturating_sub(second + global).max(1), second, share: 1.0, global, pilot: 0 }
    }

    /// Returns the split with the smallest variance in a given time. `global_time` is the time of a global line over that
    /// of a local line, and `least_global` the number of global lines that the spread of repeats needs.
    fn best(trials: &[Trial], lines: u64, global_time: f64, least_global: u64) -> Self {
        let weights =
            |trial: &Trial| [trial.first.sqrt(), trial.second.sqrt(), (trial.global / global_time).sqrt()];
        let cost = |trial: &Trial| {
            let [first, second, global] = weights(trial);
            first + second + global * global_time
        };
        let best = trials.iter().min_by(|a, b| cost(a).total_cmp(&cost(b)));
        let Some(best) = best else { return Self::usual(lines) };
        let [first, second, global] = weights(best);
        let sum = first + second + global;
        let (fewest, most) = BOUNDS;
        let of_all = |weight: f64| lines as f64 * if sum > 0.0 { weight / sum } else { 1.0 / 3.0 };
        let (fewest, most) = (lines as f64 * fewest, lines as f64 * most);
        let needed = (least_global as f64).min(REPEATS_SHARE * lines as f64);
        let global = of_all(global).clamp(fewest.max(needed), most);
        // The shots share the rest as their weights do.
        let rest = lines as f64 - global;
        let of_shots = if first + second > 0.0 { second / (first + second) } else { 0.0 };
        let second = if best.share > 0.0 { (rest * of_shots).min((rest - fewest).max(0.0)) } else { 0.0 };
        let (global, second) = ((global as u64).max(1), second as u64);
        let first = lines.saturating_sub(global + second).max(1);
        Self { first, second, share: best.share, global, pilot: 0 }
    }

    /// Returns the stages with these lines.
    pub(crate) fn actions(&self) -> Vec<Action> {
        let Self { first, second, share, global, .. } = *self;
        let mut actions = vec![Action::FirstShot(First { lines: first })];
        if second > 0 {
            actions.push(Action::SecondShot(Second { lines: second, share: Some(share) }));
        }
        let (transport, domain) = (Transport::Batches, DomainKind::Hull);
        actions.push(Action::Multipath(Multipath { lines: global, transport, domain }));
        actions
    }

    /// Returns a line about the split.
    fn message(&self) -> String {
        let Self { first, second, share, global, pilot } = *self;
        let all = (first + second + global) as f64;
        let of_all = |lines: u64| percent(lines as f64 / all);
        let second = match second {
            0 => "no second shot".into(),
            lines if share < 1.0 => {
                format!("{} for {} of the reflected light in a second shot", of_all(lines), percent(share))
            }
            lines => format!("{} in a second shot", of_all(lines)),
        };
        format!(
            "Solve: after a pilot of {} lines, {} of the lines in the first shot, {second}, {} global lines",
            grouped(pilot),
            of_all(first),
            of_all(global)
        )
    }
}

/// The pilot of a `Solve`.
struct Pilot<'m> {
    model: &'m Model,
    domain: GlobalLines,
    /// Lines of each shot, and global lines.
    shot: u64,
    global: u64,
    seed: u64,
}

impl Run<'_> {
    /// Traces the pilot of a `Solve` with this number of lines, and returns the split that follows.
    pub(crate) fn split(&mut self, lines: u64) -> Result<Split, Error> {
        let (model, focus) = (&self.prepared.model, self.prepared.focus);
        let domain = DomainKind::Hull.lines_around(&model.scene, focus);
        let per_crossing = lines as f64 / crossings_per_patch(model, &domain, lines);
        let (crossings, most) = PILOT_CROSSINGS;
        let pilot = Pilot {
            model,
            domain,
            shot: (PILOT_SHOT * lines as f64).ceil() as u64,
            global: (crossings * per_crossing).min(most * lines as f64).ceil() as u64,
            seed: seed_of_repeat(self.head.report.seed, PILOT_REPEAT),
        };
        let traced = self.trials(&pilot);
        let (trials, crossings) = agree(self.comm, traced)?;
        let [per_line, each] = GLOBAL_TIME;
        let needed = SHARED as f64 * CROSSINGS * per_crossing;
        let split = Split::best(&trials, lines, per_line + each * crossings, needed.ceil() as u64);
        let (shots, global) = (pilot.shot * SHARES.len() as u64, pilot.global * SHARES.len() as u64);
        let split = Split { pilot: shots + global, ..split };
        self.progress.note(&split.message());
        Ok(split)
    }

    /// Traces the pilot. Returns its trials, and the number of surfaces that a global line crosses.
    fn trials(&self, pilot: &Pilot<'_>) -> Result<(Vec<Trial>, f64), Error> {
        let Pilot { model, ref domain, shot, global, seed } = *pilot;
        let inside = &self.prepared.inside;
        let of_shot = || {
            let lines = LocalLines { count: shot, focus: self.prepared.focus };
            ShotSettings::new(model, lines, seed)
        };
        let deviation = |solution: &Solution| Deviation::of(model, inside, solution);
        let total = pilot.shot * SHARES.len() as u64 + pilot.global * SHARES.len() as u64;
        let mut executor = self.executor_without_checkpoints();
        executor.observer = Box::new(self.progress.part("Solve: pilot", total, &self.options.stop));
        let first: Shot = executor.run::<FirstShot<'_>>(of_shot(), Start::Fresh(()))?.outcome;
        let after_first = deviation(&first.solution(model));
        let (mut trials, mut crossings) = (Vec::new(), 0.0);
        for share in SHARES {
            let (mut both, mut after_both) = (first.clone(), after_first);
            if share > 0.0 {
                let settings = of_shot().of_reflected(Some(share));
                both = executor.run::<SecondShot<'_>>(settings, Start::Fresh(both))?.outcome;
                after_both = deviation(&both.solution(model));
            }
            let settings = BatchSettings { model, domain: domain.clone(), lines: global, seed };
            let all: Transported = executor.run::<Batches<'_>>(settings, Start::Fresh(both))?.outcome;
            crossings = all.counts.crossings as f64 / all.counts.lines.max(1) as f64;
            let after_all = deviation(&all.solution);
            let of_lines = |lines: u64, after: &Deviation, before: &Deviation| {
                lines as f64 * after.relative_variance_beyond(before, &after_all)
            };
            trials.push(Trial {
                share,
                first: of_lines(shot, &after_first, &Deviation::default()),
                second: of_lines(shot, &after_both, &after_first),
                global: of_lines(global, &after_all, &after_both),
            });
        }
        Ok((trials, crossings))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn trial(share: f64, first: f64, second: f64, global: f64) -> Trial {
        Trial { share, first, second, global }
    }

    #[test]
    fn lines_go_where_the_noise_is() {
        let split = Split::best(&[trial(1.0, 4.0, 1.0, 4.0)], 1_000_000, 4.0, 0);
        assert_eq!((split.first, split.second, split.global), (500_000, 250_000, 250_000));
        assert_eq!(split.share, 1.0);
    }

    #[test]
    fn the_best_of_the_trials_is_taken() {
        // A second shot that costs more than it saves.
        let trials = [trial(0.0, 1.0, 0.0, 1.0), trial(1.0, 1.0, 4.0, 0.9)];
        let split = Split::best(&trials, 1000, 1.0, 0);
        assert_eq!((split.first, split.second, split.global), (500, 0, 500));
        assert_eq!(split.actions().len(), 2);
        let trials = [trial(0.0, 1.0, 0.0, 100.0), trial(1.0, 1.0, 1.0, 1.0)];
        assert_eq!(Split::best(&trials, 999, 1.0, 0).second, 333);
    }

    #[test]
    fn global_lines_suffice_for_the_spread_of_repeats_as_far_as_they_can() {
        let trials = [trial(0.0, 1.0, 0.0, 0.0)];
        assert_eq!(Split::best(&trials, 1000, 1.0, 200).global, 200);
        assert_eq!(Split::best(&trials, 1000, 1.0, 900).global, 250);
        // Nothing is known, or there is hardly any line.
        assert_eq!(Split::best(&[trial(0.0, 0.0, 0.0, 0.0)], 3000, 1.0, 0).global, 1000);
        let split = Split::best(&trials, 1, 1.0, 9);
        assert_eq!((split.first, split.second, split.global), (1, 0, 1));
    }
}
