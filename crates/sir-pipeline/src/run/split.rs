//! The lines of a `Solve`: how many the first shot, shadow rays, the second shot and the global lines get.
//!
//! The relative variance of the light is a sum over the stages, each of which contributes in inverse proportion to its lines:
//! `a/F + b/S + c/G`. A pilot of few lines estimates `a`, `b` and `c`. If lines take the times `1`, `1` and `κ`, the product of
//! variance and time is smallest for `F : S : G = √a : √b : √(c/κ)` (Lagrange; as in optimal allocation of strata, Neyman
//! 1934), where it is `(√a + √b + √(cκ))²`. Shadow rays take the place of the first shot, with an `a` of their own, if the
//! product is smaller then; the first shot has few lines, whose light is only reflected. The noise that reflected light
//! inherits from earlier stages is left out.

use serde::{Deserialize, Serialize};

use crate::format::{grouped, percent};
use crate::plan::{
    Action, DomainKind, FirstShot as First, Multipath, SecondShot as Second, ShadowRays, Transport,
};
use crate::report::result::{PilotReport, Time};
use crate::run::sharing::repeats_of;

/// Smallest share of all lines for the first shot and for global lines.
const FEWEST: f64 = 0.05;

/// Largest share of all lines for those global lines that are needed for the spread of repeats.
const REPEATS_SHARE: f64 = 0.25;

/// Lines of the stages of a `Solve`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Split {
    /// Lines of the first shot.
    first: u64,
    /// Shadow rays. The stage is left out without rays.
    rays: u64,
    /// Lines of the second shot. There is no second shot without lines.
    second: u64,
    /// Share of the reflected light that they carry.
    share: f64,
    /// Global lines.
    global: u64,
    /// Lines and time of the pilot.
    pub(crate) pilot: PilotReport,
}

const NO_PILOT: PilotReport = PilotReport { lines: 0, share: 0.0, rays: 0, time: Time::of(0.0) };

/// What the pilot says of one share of the reflected light: the relative variances times the numbers of lines.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Trial {
    pub(crate) share: f64,
    pub(crate) first: f64,
    /// The direct light by shadow rays; `None` if they take too long.
    pub(crate) rays: Option<RayTrial>,
    pub(crate) second: f64,
    pub(crate) global: f64,
}

/// What the pilot says of shadow rays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct RayTrial {
    /// Relative variance of their light times their number.
    pub(crate) rays: f64,
    /// Relative variance of the light of the first shot on patches without rays, times the number of its lines.
    pub(crate) kept: f64,
    /// Share of the rays that take time.
    pub(crate) traced: f64,
}

/// Time of a line or ray over that of a local line, and the numbers of lines that are needed whatever the noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Costs {
    /// Time of a global line.
    pub(crate) global: f64,
    /// Time of a shadow ray.
    pub(crate) ray: f64,
    /// Number of global lines of a repeat that are enough for its spread.
    pub(crate) global_of_repeat: f64,
    /// Largest number of repeats.
    pub(crate) repeats: u64,
    /// Number of shadow rays that a repeat has at least.
    pub(crate) rays_of_repeat: u64,
}

impl Costs {
    /// Returns the mean time of a shadow ray, of those that are traced and those that are not.
    fn of_ray(&self, of_rays: &RayTrial) -> f64 {
        self.ray * of_rays.traced.max(0.05)
    }
}

impl Split {
    /// Returns a usual split, for estimates of time.
    pub(crate) fn usual(lines: u64) -> Self {
        let (second, global) = (lines / 4, (lines / 4).max(1));
        let first = lines.saturating_sub(second + global).max(1);
        Self { first, rays: 0, second, share: 1.0, global, pilot: NO_PILOT }
    }

    /// Returns the split with the smallest product of variance and time.
    pub(crate) fn best(trials: &[Trial], lines: u64, costs: &Costs) -> Self {
        let without_rays = trials.iter().map(|trial| Trial { rays: None, ..*trial });
        let all = trials.iter().copied().chain(without_rays);
        let possible = all.filter_map(|trial| {
            let split = Self::of(&trial, lines, costs)?;
            Some((split, split.variance(&trial) * split.time(&trial, costs)))
        });
        let best = possible.min_by(|(_, a), (_, b)| a.total_cmp(b));
        best.map_or_else(|| Self::usual(lines), |(split, _)| split)
    }

    /// Returns the best split for what one trial says, with shadow rays if it has them; `None` if these would be too few.
    fn of(trial: &Trial, lines: u64, costs: &Costs) -> Option<Self> {
        let all = lines as f64;
        let first = trial.rays.map_or(trial.first, |of_rays| of_rays.kept).sqrt();
        let rays = trial.rays.map_or(0.0, |of_rays| (of_rays.rays / costs.of_ray(&of_rays)).sqrt());
        let (second, global) = (trial.second.sqrt(), (trial.global / costs.global).sqrt());
        let sum = first + rays + second + global;
        let fewest = FEWEST * all;
        let needed = fewest.max((costs.repeats as f64 * costs.global_of_repeat).min(REPEATS_SHARE * all));
        let share = |weight: f64| all * if sum > 0.0 { weight / sum } else { 1.0 / 3.0 };
        let global = share(global).clamp(needed, all - fewest);
        let least_rays = trial.rays.map_or(0.0, |_| {
            let repeats = repeats_of(global / costs.global_of_repeat).min(costs.repeats);
            (repeats * costs.rays_of_repeat) as f64
        });
        let global = global.min(all - fewest - least_rays);
        if global < needed {
            return None;
        }
        // The other stages share the rest as their weights do; each has its least.
        let rest = all - global;
        let second = match trial.share > 0.0 && second > 0.0 {
            true => (rest * second / (first + rays + second)).min(rest - fewest - least_rays),
            false => 0.0,
        };
        let rays = match trial.rays {
            Some(_) if first > 0.0 => {
                let of_both = (rest - second) * rays / (first + rays);
                of_both.clamp(least_rays, rest - second - fewest)
            }
            Some(_) => rest - second - fewest,
            None => 0.0,
        };
        let (global, second, rays) = ((global as u64).max(1), second as u64, rays as u64);
        let first = lines.saturating_sub(global + second + rays).max(1);
        Some(Self { first, rays, second, share: trial.share, global, pilot: NO_PILOT })
    }

    /// Returns the relative variance of the light.
    fn variance(&self, trial: &Trial) -> f64 {
        let over = |variance: f64, lines: u64| if variance > 0.0 { variance / lines as f64 } else { 0.0 };
        let direct = trial.rays.map_or(over(trial.first, self.first), |of_rays| {
            over(of_rays.rays, self.rays) + over(of_rays.kept, self.first)
        });
        direct + over(trial.second, self.second) + over(trial.global, self.global)
    }

    /// Returns the time, in times of a local line.
    fn time(&self, trial: &Trial, costs: &Costs) -> f64 {
        let local = self.first + self.second;
        let ray = trial.rays.map_or(0.0, |of_rays| costs.of_ray(&of_rays));
        local as f64 + ray * self.rays as f64 + costs.global * self.global as f64
    }

    /// Returns the split with the report of its pilot.
    pub(crate) fn after_pilot(self, lines: u64, time: Time) -> Self {
        let share = if self.second > 0 { self.share } else { 0.0 };
        Self { pilot: PilotReport { lines, share, rays: self.rays, time }, ..self }
    }

    /// Returns the stages with these lines.
    pub(crate) fn actions(&self) -> Vec<Action> {
        let Self { first, rays, second, share, global, .. } = *self;
        let mut actions = vec![Action::FirstShot(First { lines: first })];
        if rays > 0 {
            actions.push(Action::ShadowRays(ShadowRays { rays }));
        }
        if second > 0 {
            actions.push(Action::SecondShot(Second { lines: second, share: Some(share) }));
        }
        let (transport, domain) = (Transport::Batches, DomainKind::Hull);
        actions.push(Action::Multipath(Multipath { lines: global, transport, domain }));
        actions
    }

    /// Returns a line about the split.
    pub(crate) fn message(&self) -> String {
        let Self { first, rays, second, share, global, pilot } = *self;
        let all = (first + rays + second + global) as f64;
        let of_all = |lines: u64| percent(lines as f64 / all);
        let second = match second {
            0 => "no second shot".into(),
            lines if share < 1.0 => {
                format!("{} for {} of the reflected light in a second shot", of_all(lines), percent(share))
            }
            lines => format!("{} in a second shot", of_all(lines)),
        };
        let rays = if rays > 0 { format!("{} shadow rays, ", of_all(rays)) } else { String::new() };
        format!(
            "Solve: after a pilot of {} lines, {} of the lines in the first shot, {rays}{second}, {} global lines",
            grouped(pilot.lines),
            of_all(first),
            of_all(global)
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const COSTS: Costs =
        Costs { global: 1.0, ray: 1.0, global_of_repeat: 1.0, repeats: 1, rays_of_repeat: 100 };

    fn trial(share: f64, first: f64, second: f64, global: f64) -> Trial {
        Trial { share, first, rays: None, second, global }
    }

    #[test]
    fn lines_go_where_the_noise_is() {
        let costs = Costs { global: 4.0, ..COSTS };
        let split = Split::best(&[trial(1.0, 4.0, 1.0, 4.0)], 1_000_000, &costs);
        assert_eq!((split.first, split.second, split.global), (500_000, 250_000, 250_000));
        assert_eq!((split.share, split.rays), (1.0, 0));
    }

    #[test]
    fn the_best_of_the_trials_is_taken() {
        // A second shot that costs more than it saves.
        let trials = [trial(0.0, 1.0, 0.0, 1.0), trial(1.0, 1.0, 4.0, 0.9)];
        let split = Split::best(&trials, 1000, &COSTS);
        assert_eq!((split.first, split.second, split.global), (500, 0, 500));
        assert_eq!(split.actions().len(), 2);
        let trials = [trial(0.0, 1.0, 0.0, 100.0), trial(1.0, 1.0, 1.0, 1.0)];
        assert_eq!(Split::best(&trials, 999, &COSTS).second, 333);
    }

    #[test]
    fn shadow_rays_are_taken_where_they_pay() {
        let of_rays = |rays, kept| Some(RayTrial { rays, kept, traced: 1.0 });
        let better = Trial { rays: of_rays(0.25, 0.0), ..trial(0.0, 1.0, 0.0, 1.0) };
        let split = Split::best(&[better], 1500, &COSTS);
        assert_eq!((split.first, split.rays, split.second, split.global), (75, 425, 0, 1000));
        assert_eq!(split.actions().len(), 3);
        assert!(
            split.message().contains("5.0 % of the lines in the first shot, 28.3 % shadow rays, no second")
        );
        // They are worse, or there are not enough for all patches, or not in every repeat.
        let worse = Trial { rays: of_rays(1.0, 0.0), ..better };
        assert_eq!(Split::best(&[worse], 1500, &COSTS).rays, 0);
        assert_eq!(Split::best(&[better], 1500, &Costs { rays_of_repeat: 1400, ..COSTS }).rays, 0);
        let costs = Costs { repeats: 16, global_of_repeat: 20.0, ..COSTS };
        assert_eq!(Split::best(&[better], 1500, &costs).rays, 0);
        // All patches have some, though one would do.
        let one = Trial { rays: of_rays(1e-6, 0.0), global: 100.0, ..better };
        let split = Split::best(&[one], 1500, &COSTS);
        assert_eq!((split.first, split.rays, split.global), (75, 100, 1325));
        // What keeps the light of the first shot needs its lines, and may need so many that rays do not pay.
        let some = Trial { rays: of_rays(0.04, 0.04), ..better };
        let split = Split::best(&[some], 1400, &COSTS);
        assert_eq!((split.first, split.rays, split.global), (200, 200, 1000));
        let most = Trial { rays: of_rays(0.04, 0.9), ..better };
        assert_eq!(Split::best(&[most], 1500, &COSTS).rays, 0);
    }

    #[test]
    fn global_lines_suffice_for_the_spread_of_repeats_as_far_as_they_can() {
        let trials = [trial(0.0, 1.0, 0.0, 0.0)];
        let of_repeats = |global_of_repeat| Costs { global_of_repeat, ..COSTS };
        assert_eq!(Split::best(&trials, 1000, &of_repeats(200.0)).global, 200);
        assert_eq!(Split::best(&trials, 1000, &of_repeats(900.0)).global, 250);
        // Nothing is known, or there is hardly any line.
        assert_eq!(Split::best(&[trial(0.0, 0.0, 0.0, 0.0)], 3000, &COSTS).global, 1000);
        let split = Split::best(&trials, 1, &of_repeats(9.0));
        assert_eq!((split.first, split.second, split.global), (1, 0, 1));
    }
}
