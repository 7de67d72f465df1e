//! The pilot of a `Solve`, which estimates the noise of each stage from few lines.

use sir_lines::{GlobalLines, LocalLines, seed_of_repeat};
use sir_parallel::Start;
use sir_radiosity::{
    BatchSettings, Batches, FirstShot, Model, SecondShot, Shot, ShotSettings, Solution, Transported,
    crossings_per_patch,
};

use crate::error::Error;
use crate::plan::DomainKind;
use crate::ranks::agree;
use crate::report::light::Deviation;
use crate::report::result::{PilotReport, Time};
use crate::run::execute::Run;
use crate::run::sharing::CROSSINGS;
use crate::run::split::{Split, Trial};
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

/// Number of the repeat whose seed the pilot has. No run has that many repeats.
const PILOT_REPEAT: u64 = u64::MAX;

/// The pilot of a `Solve`.
struct Pilot<'m> {
    model: &'m Model,
    domain: GlobalLines,
    /// Lines of each shot, and global lines.
    shot: u64,
    global: u64,
    seed: u64,
}

impl Pilot<'_> {
    /// Returns the number of all lines: a first shot, a second shot for each share above zero, and global lines for each.
    fn lines(&self) -> u64 {
        (self.shot + self.global) * SHARES.len() as u64
    }
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
        let pilot = Pilot {
            model,
            domain,
            shot: shot as u64,
            global: (PILOT_CROSSINGS * per_crossing).ceil().min(shot) as u64,
            seed: seed_of_repeat(self.head.report.seed, PILOT_REPEAT),
        };
        let traced = self.trials(&pilot);
        let (trials, crossings) = agree(self.comm, traced)?;
        let [per_line, each] = GLOBAL_TIME;
        let needed = repeats as f64 * CROSSINGS * per_crossing;
        let mut split = Split::best(&trials, lines, per_line + each * crossings, needed.ceil() as u64);
        let time = Time::of(watch.seconds());
        split.pilot = PilotReport { lines: pilot.lines(), share: split.share(), time };
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
        let mut executor = self.executor_without_checkpoints();
        let threads = self.threads();
        executor.observer = Box::new(self.progress.part("Solve: pilot", pilot.lines(), &self.options.stop));
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
            let after_all = deviation(&Solution::new(model, &all.received(model, &threads), all.unit));
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
