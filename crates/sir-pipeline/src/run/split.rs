//! The lines of a `Solve`: how many the first shot, the second shot and the global lines get.
//!
//! The relative variance of the light is a sum over the three stages, each of which contributes in inverse proportion to its
//! lines: `a/F + b/S + c/G`. A pilot of few lines estimates `a`, `b` and `c`. If lines take the times `1`, `1` and `κ`, the
//! product of variance and time is smallest for `F : S : G = √a : √b : √(c/κ)` (Lagrange; as in optimal allocation of strata,
//! Neyman 1934), where it is `(√a + √b + √(cκ))²`. The noise that reflected light inherits from earlier stages is left out.

use serde::{Deserialize, Serialize};

use crate::format::{grouped, percent};
use crate::plan::{Action, DomainKind, FirstShot as First, Multipath, SecondShot as Second, Transport};
use crate::report::result::{PilotReport, Time};

/// Smallest and largest share of all lines for the first shot and for global lines.
const BOUNDS: (f64, f64) = (0.05, 0.9);

/// Largest share of all lines for those global lines that are needed for the spread of repeats.
const REPEATS_SHARE: f64 = 0.25;

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
    /// Lines and time of the pilot.
    pub(crate) pilot: PilotReport,
}

const NO_PILOT: PilotReport = PilotReport { lines: 0, share: 0.0, time: Time::of(0.0) };

/// What the pilot says of one share of the reflected light: the relative variances times the numbers of lines.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Trial {
    pub(crate) share: f64,
    pub(crate) first: f64,
    pub(crate) second: f64,
    pub(crate) global: f64,
}

impl Split {
    /// Returns a usual split, for estimates of time.
    pub(crate) fn usual(lines: u64) -> Self {
        let (second, global) = (lines / 4, (lines / 4).max(1));
        Self {
            first: lines.saturating_sub(second + global).max(1),
            second,
            share: 1.0,
            global,
            pilot: NO_PILOT,
        }
    }

    /// Returns the split with the smallest variance in a given time. `global_time` is the time of a global line over that
    /// of a local line, and `least_global` the number of global lines that the spread of repeats needs.
    pub(crate) fn best(trials: &[Trial], lines: u64, global_time: f64, least_global: u64) -> Self {
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
        Self { first, second, share: best.share, global, pilot: NO_PILOT }
    }

    /// Returns the share of the reflected light that the second shot carries.
    pub(crate) fn share(&self) -> f64 {
        if self.second > 0 { self.share } else { 0.0 }
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
    pub(crate) fn message(&self) -> String {
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
            grouped(pilot.lines),
            of_all(first),
            of_all(global)
        )
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
