//! The pilot of a `Solve`, which estimates the noise of each stage from few lines.

use sir_lines::{GlobalLines, LocalLines, seed_of_repeat};
use sir_mesh::SideId;
use sir_parallel::{Executor, Start};
use sir_radiosity::{
    BatchSettings, Batches, FirstShot, Model, SecondShot, ShadowRaySettings, ShadowRays, Shot, ShotSettings,
    Solution, Transported, crossings_per_patch,
};

use crate::error::Error;
use crate::plan::DomainKind;
use crate::ranks::agree;
use crate::report::light::Deviation;
use crate::report::result::Time;
use crate::run::execute::Run;
use crate::run::sharing::CROSSINGS;
use crate::run::split::{Costs, RayTrial, Split, Trial};
use crate::stopwatch::Stopwatch;

/// Lines of each shot of the pilot: a share of all lines, but at least a number, up to a larger share.
const PILOT_SHARE: f64 = 1.0 / 256.0;
const PILOT_LINES: f64 = 8000.0;
const MAX_PILOT_SHARE: f64 = 1.0 / 64.0;

/// Crossings of a typical patch by the global lines of the pilot, if there are no fewer lines in a shot.
const PILOT_CROSSINGS: f64 = 8.0;

/// Shares of the reflected light that a second shot may send, of which the pilot tries each.
const SHARES: [f64; 3] = [0.0, 0.5, 1.0];

/// Time of a global line over that of a local line: for the line itself, and for each surface that it crosses. Measured on
/// the Cornell box and the museum's stair.
const GLOBAL_TIME: [f64; 2] = [1.0, 0.5];

/// Time of a shadow ray to the sun or the sky over that of a local line, of one to a lamp, and more for each emitting surface
/// among which it is chosen. Measured on a classroom, the Cornell box and the reading room.
const RAY_TIMES: [f64; 3] = [0.7, 1.5, 0.28];

/// Largest number of emitting surfaces for which shadow rays are tried.
const MAX_SURFACES: usize = 32;

/// Fewest and most sides from which the pilot sends shadow rays, about, and their points in the mean. Two independent
/// estimates with this number of points tell how much such an estimate varies. There are as many rays as lines of a shot.
const PILOT_SIDES: (f64, f64) = (64.0, 2048.0);
const PILOT_POINTS: u64 = 8;

/// Number of the repeat whose seed the pilot has. No run has that many repeats.
const PILOT_REPEAT: u64 = u64::MAX;

/// The pilot of a `Solve`.
struct Pilot<'m> {
    model: &'m Model,
    domain: GlobalLines,
    /// Lines of each shot, and global lines.
    shot: u64,
    global: u64,
    /// Shadow rays of all sides, of which every so manyth is measured; 0 if there are none.
    rays: u64,
    every: u32,
    seed: u64,
}

impl Pilot<'_> {
    /// Returns the number of all lines: a first shot, two times shadow rays, a second shot for each share above zero, and
    /// global lines for each.
    fn lines(&self) -> u64 {
        (self.shot + self.global) * SHARES.len() as u64 + 2 * self.rays / u64::from(self.every)
    }
}

/// What the pilot says of shadow rays.
struct ByRays {
    /// Errors of the sides with rays, and of those that keep the light of the first shot.
    rays: Deviation,
    kept: Deviation,
    /// Share of the rays that are traced. Others would leave from behind a surface.
    traced: f64,
}

/// Returns the time of a shadow ray over that of a local line, in the mean over the rays from a point: to the sun and the sky,
/// and to one of these emitting surfaces.
fn ray_time([distant, lamps]: [u64; 2], surfaces: usize) -> f64 {
    let [far, near, each] = RAY_TIMES;
    let lamp = near + each * surfaces as f64;
    (distant as f64 * far + lamps as f64 * lamp) / (distant + lamps).max(1) as f64
}

impl Run<'_> {
    /// Traces the pilot of a `Solve` with this number of lines, which this number of repeats share, and returns the split
    /// that follows.
    pub(crate) fn split(&mut self, lines: u64, repeats: u64) -> Result<Split, Error> {
        let watch = Stopwatch::start();
        let (model, focus) = (&self.prepared.model, self.prepared.focus);
        let domain = DomainKind::Hull.lines_around(&model.scene, focus);
        let per_crossing = lines as f64 / crossings_per_patch(model, &domain, lines);
        let shot = (PILOT_SHARE * lines as f64).max(PILOT_LINES.min(MAX_PILOT_SHARE * lines as f64)).ceil();
        let sides = self.prepared.inside.count(model);
        let (from_point, surfaces) =
            (ShadowRays::rays_per_point(model), ShadowRays::emitting_surfaces(model));
        let per_point = from_point.iter().sum::<u64>();
        let some_sides = shot / (PILOT_POINTS * per_point.max(1)) as f64;
        let some_sides = some_sides.clamp(PILOT_SIDES.0, PILOT_SIDES.1);
        let has_many_lamps = surfaces > MAX_SURFACES;
        let pilot = Pilot {
            model,
            domain,
            shot: shot as u64,
            global: (PILOT_CROSSINGS * per_crossing).ceil().min(shot) as u64,
            rays: if has_many_lamps { 0 } else { PILOT_POINTS * per_point * sides as u64 },
            every: (sides as f64 / some_sides).ceil().max(1.0) as u32,
            seed: seed_of_repeat(self.seed(), PILOT_REPEAT),
        };
        let traced = self.trials(&pilot);
        let (trials, crossings) = agree(self.comm, traced)?;
        let [per_line, each] = GLOBAL_TIME;
        let costs = Costs {
            global: per_line + each * crossings,
            ray: ray_time(from_point, surfaces),
            global_of_repeat: CROSSINGS * per_crossing,
            repeats,
            rays_of_repeat: ShadowRays::MIN_POINTS * per_point * sides as u64,
        };
        let split = Split::best(&trials, lines, &costs);
        let split = split.after_pilot(pilot.lines(), Time::of(watch.seconds()));
        self.progress.note(&split.message());
        Ok(split)
    }

    /// Traces the pilot. Returns its trials, and the number of surfaces that a global line crosses.
    fn trials(&self, pilot: &Pilot<'_>) -> Result<(Vec<Trial>, f64), Error> {
        let Pilot { model, ref domain, shot, global, seed, .. } = *pilot;
        let inside = &self.prepared.inside;
        let of_shot = || {
            let lines = LocalLines { count: shot, focus: self.prepared.focus };
            ShotSettings::new(model, lines, seed)
        };
        let deviation = |solution: &Solution| Deviation::of(model, inside, solution);
        let mut executor = self.executor_without_checkpoints();
        let threads = self.threads();
        executor.observer = Box::new(self.progress.part("Solve: pilot", pilot.lines(), &self.options.stop));
        let first: Shot = executor.run::<FirstShot<'_>>(of_shot(), Start::Fresh(()))?.outcome;
        let after_first = deviation(&first.solution(model));
        let by_rays = match pilot.rays {
            0 => None,
            _ => Some(self.try_rays(pilot, &first, &mut executor)?),
        };
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
            let after_all = deviation(&Solution::new(model, &all.received(model, &threads), all.unit));
            let of_lines = |lines: u64, after: &Deviation, before: &Deviation| {
                lines as f64 * after.relative_variance_beyond(before, &after_all)
            };
            trials.push(Trial {
                share,
                first: of_lines(shot, &after_first, &Deviation::default()),
                rays: by_rays.as_ref().map(|by_rays| RayTrial {
                    rays: of_lines(pilot.rays, &by_rays.rays, &Deviation::default()),
                    kept: of_lines(shot, &by_rays.kept, &Deviation::default()),
                    traced: by_rays.traced,
                }),
                second: of_lines(shot, &after_both, &after_first),
                global: of_lines(global, &after_all, &after_both),
            });
        }
        Ok((trials, crossings))
    }

    /// Tries shadow rays: two independent estimates of the direct light.
    fn try_rays(
        &self,
        pilot: &Pilot<'_>,
        first: &Shot,
        executor: &mut Executor<'_>,
    ) -> Result<ByRays, Error> {
        let Pilot { model, rays: count, every, seed, .. } = *pilot;
        let (inside, points) = (&self.prepared.inside, self.pipeline.points);
        let rays = LocalLines { count, focus: self.prepared.focus };
        let with_rays = ShadowRaySettings { model, rays, seed, points, every: 1 }.sides(&self.threads());
        let (mut estimates, mut traced) = (Vec::new(), 0);
        for seed in [seed, seed.wrapping_add(1)] {
            let settings = ShadowRaySettings { model, rays, seed, points, every };
            let run = executor.run::<ShadowRays<'_>>(settings, Start::Fresh(first.clone()))?;
            let (shot, counts) = run.outcome;
            traced += counts.lines;
            estimates.push(shot.solution(model));
        }
        let is_measured =
            |side: SideId| with_rays[side.index()] && (side.index() as u32).is_multiple_of(every);
        let is_kept = |side: SideId| inside.contains(side) && !with_rays[side.index()];
        Ok(ByRays {
            rays: Deviation::between(model, is_measured, &estimates[0], &estimates[1])
                .times(f64::from(every)),
            kept: Deviation::on(model, is_kept, &first.solution(model)),
            traced: (0.5 * f64::from(every) * traced as f64 / count.max(1) as f64).min(1.0),
        })
    }
}
