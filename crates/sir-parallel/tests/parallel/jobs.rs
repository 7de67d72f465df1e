//! Test scene with all kinds of surfaces and lights, and the stages that are run on it.

use std::num::NonZeroUsize;
use std::sync::LazyLock;

use glam::DVec3;
use sir_geom::shapes::{self, Facing};
use sir_geom::{BoundingBox, Light, LightKind, Material, Rgb, SceneBuilder, Sides, Sky, SkyModel, Spread};
use sir_lines::{Domain, Focus, GlobalLines, LocalLines};
use sir_mesh::{PatchSize, SideId, Subdivision};
use sir_parallel::{Communicator, Executor, RunError, Saved, StageRun, StageTime, Start};
use sir_radiosity::{
    Balance, BatchSettings, Batches, Counts, FirstShot, Model, OneWorker, Points, Quanta, Received,
    ReplicaSettings, Replicas, SecondShot, ShadowRaySettings, ShadowRays, Shot, ShotSettings, Stage,
    StageTotals, Transported, Walked, chain_units, run_stage,
};

use crate::observers::StopAfter;

/// Number of lines of every stage.
pub(crate) const LINES: u64 = 30_000;

const SEED: u64 = 3;

/// Scene with its first shot.
pub(crate) struct Room {
    pub(crate) model: Model,
    pub(crate) shot: Shot,
    pub(crate) domain: Domain,
}

/// Room of most tests.
pub(crate) static ROOM: LazyLock<Room> = LazyLock::new(|| Room::new(400));

/// The same room with so many patches that their state is communicated in several chunks.
pub(crate) static FINE_ROOM: LazyLock<Room> = LazyLock::new(|| Room::new(40_000));

/// Stage with its settings.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Job {
    FirstShot,
    /// With a focus.
    FocusedShot,
    SecondShot,
    /// Whose units are the sides of patches.
    ShadowRays,
    Batches,
    /// With a focus.
    FocusedBatches,
    Multipath {
        replicas: u64,
        tail: u64,
    },
}

/// Outcome of a stage.
#[derive(Clone, PartialEq)]
pub(crate) struct Outcome {
    pub(crate) received: Received,
    pub(crate) quantum: f64,
    pub(crate) balance: Balance,
    pub(crate) counts: Counts,
    pub(crate) walked: Walked,
    pub(crate) batches: u64,
    pub(crate) sent: Vec<(SideId, Quanta)>,
}

/// All stages of lines, multipath with various settings.
pub(crate) const JOBS: [Job; 11] = [
    Job::FirstShot,
    Job::FocusedShot,
    Job::SecondShot,
    Job::Batches,
    Job::FocusedBatches,
    Job::Multipath { replicas: 1, tail: 0 },
    Job::Multipath { replicas: 3, tail: 0 },
    Job::Multipath { replicas: 8, tail: 0 },
    Job::Multipath { replicas: 1, tail: LINES / 10 },
    Job::Multipath { replicas: 3, tail: LINES / 10 },
    Job::Multipath { replicas: 8, tail: LINES / 5 },
];

impl Room {
    /// Returns a room with an open front and about this number of patches. It contains a one-sided lamp, a solid block
    /// and a two-sided sheet, so that power is absorbed, blocked and escapes. Light also comes from a spot, the sun and
    /// the sky.
    pub(crate) fn new(patches: u64) -> Self {
        let mut b = SceneBuilder::new();
        let add = |r: f64, g: f64, blue: f64| Material::diffuse("", Rgb::new(r, g, blue));
        let white = b.add_material(add(0.8, 0.8, 0.8));
        let red = b.add_material(add(0.7, 0.2, 0.1));
        let green = b.add_material(add(0.1, 0.6, 0.2));
        let dark = b.add_material(add(0.05, 0.0, 0.3));
        let mirror = b.add_material(add(0.95, 0.9, 0.9));
        let sheet = b.add_material(add(0.5, 0.6, 0.4).with_sides(Sides::Both));
        let lamp = b.add_material(add(0.3, 0.3, 0.3).emitting(Rgb::new(9.0, 7.0, 4.0)));

        // The walls of a box of 2 by 2 by 2, except the one at y = −1.
        let wall = |axis: DVec3, u: DVec3| {
            let v = axis.cross(u);
            [u + v, v - u, -u - v, u - v].map(|corner| corner - axis)
        };
        let walls = [
            (DVec3::X, DVec3::Y, red),
            (-DVec3::X, DVec3::Y, green),
            (-DVec3::Y, DVec3::Z, mirror),
            (DVec3::Z, DVec3::X, dark),
            (-DVec3::Z, DVec3::X, white),
        ];
        for (inward, along, material) in walls {
            shapes::quad(&mut b, wall(inward, along), material);
        }
        shapes::quad(&mut b, wall(-DVec3::Z, DVec3::X).map(|p| DVec3::new(0.3, 0.3, 0.9) * p), lamp);
        let slanting = wall(DVec3::Y, DVec3::X).map(|p| DVec3::new(0.5 * p.x, 0.2 + 0.3 * p.z, 0.4 * p.z));
        shapes::quad(&mut b, slanting, sheet);
        let (min, max) = (DVec3::new(0.2, -0.5, -0.99), DVec3::new(0.7, 0.1, -0.5));
        shapes::cuboid(&mut b, min, max, [green, white, red, white, dark, mirror], Facing::Outward);

        let light = |kind| Light { name: String::new(), kind };
        let position = DVec3::new(-0.6, -0.3, 0.2);
        let spread = Spread::Spot { axis: DVec3::X, inner: 0.9, outer: 0.3 };
        b.add_light(light(LightKind::Point { position, intensity: Rgb::new(1.0, 0.5, 0.2), spread }));
        let direction = DVec3::new(2.0, 6.0, -3.0) / 7.0;
        b.add_light(light(LightKind::Distant { direction, irradiance: Rgb::new(0.5, 0.5, 0.7) }));
        let sun = SkyModel::General { kind: 12, sun: -direction };
        b.set_sky(Sky::new(DVec3::Z, sun, Rgb::new(0.1, 0.2, 0.4), Rgb::splat(0.05)).unwrap());

        let model =
            Model::new(b.build().unwrap().scene, Subdivision::Triangles(PatchSize::Count(patches))).unwrap();
        let shot = run_stage::<FirstShot<'_>>(ShotSettings::new(&model, LINES, SEED), ()).unwrap();
        let domain = Domain::hull(model.scene.vertices());
        Self { model, shot, domain }
    }

    /// Returns a focus on a part of the room.
    fn focus(&self) -> Focus {
        let bounds = BoundingBox { min: DVec3::splat(-1.0), max: DVec3::new(0.2, 0.6, 0.1) };
        Focus::new(bounds, 0.75, self.model.scene.bounding_box()).unwrap()
    }

    fn focused_shot(&self) -> ShotSettings<'_> {
        let lines = LocalLines { count: LINES, focus: Some(self.focus()) };
        ShotSettings::new(&self.model, lines, SEED)
    }

    fn shadow_rays(&self) -> ShadowRaySettings<'_> {
        let rays = LocalLines { count: LINES, focus: Some(self.focus()) };
        ShadowRaySettings { model: &self.model, rays, seed: SEED, points: Points::Sobol, every: 1 }
    }

    fn focused_lines(&self) -> GlobalLines {
        let lines = GlobalLines::focused(self.domain.clone(), self.focus());
        assert!(lines.weight() > 1);
        lines
    }
}

impl Job {
    fn settings(room: &Room, replicas: u64, tail: u64) -> ReplicaSettings<'_> {
        let settings = ReplicaSettings::new(&room.model, room.domain.clone(), LINES, SEED);
        ReplicaSettings { tail, replicas, ..settings }
    }

    /// Runs the stage, from the start or from a checkpoint.
    pub(crate) fn run(
        self,
        room: &Room,
        executor: &mut Executor<'_>,
        saved: Option<Saved>,
    ) -> Result<Outcome, RunError> {
        let shot = ShotSettings::new(&room.model, LINES, SEED);
        match self {
            Self::FirstShot => executor.run::<FirstShot<'_>>(shot, start((), saved)).map(Outcome::of_shot),
            Self::FocusedShot => {
                executor.run::<FirstShot<'_>>(room.focused_shot(), start((), saved)).map(Outcome::of_shot)
            }
            Self::SecondShot => {
                executor.run::<SecondShot<'_>>(shot, start(room.shot.clone(), saved)).map(Outcome::of_shot)
            }
            Self::ShadowRays => {
                let start = start(room.shot.clone(), saved);
                executor.run::<ShadowRays<'_>>(room.shadow_rays(), start).map(Outcome::of_rays)
            }
            Self::Batches | Self::FocusedBatches => {
                let start = start(room.shot.clone(), saved);
                executor
                    .run::<Batches<'_>>(self.batches(room), start)
                    .map(|run| Outcome::of_transport(room, run))
            }
            Self::Multipath { replicas, tail } => {
                let start = start(room.shot.clone(), saved);
                let settings = Self::settings(room, replicas, tail);
                executor.run::<Replicas<'_>>(settings, start).map(|run| Outcome::of_transport(room, run))
            }
        }
    }

    fn batches(self, room: &Room) -> BatchSettings<'_> {
        let domain = match self {
            Self::FocusedBatches => room.focused_lines(),
            _ => room.domain.clone().into(),
        };
        BatchSettings::new(&room.model, domain, LINES, SEED)
    }

    /// Runs the same stage without an executor, line by line.
    pub(crate) fn by_hand(self, room: &Room) -> Outcome {
        let shot = ShotSettings::new(&room.model, LINES, SEED);
        match self {
            Self::FirstShot => Outcome::of_shot(by_hand::<FirstShot<'_>>(shot, ())),
            Self::FocusedShot => Outcome::of_shot(by_hand::<FirstShot<'_>>(room.focused_shot(), ())),
            Self::SecondShot => Outcome::of_shot(by_hand::<SecondShot<'_>>(shot, room.shot.clone())),
            Self::ShadowRays => {
                Outcome::of_rays(by_hand::<ShadowRays<'_>>(room.shadow_rays(), room.shot.clone()))
            }
            Self::Batches | Self::FocusedBatches => {
                Outcome::of_transport(room, by_hand::<Batches<'_>>(self.batches(room), room.shot.clone()))
            }
            Self::Multipath { replicas, tail } => {
                let settings = Self::settings(room, replicas, tail);
                Outcome::of_transport(room, by_hand::<Replicas<'_>>(settings, room.shot.clone()))
            }
        }
    }
}

/// Returns the starting point: the checkpoint, or the input if there is none.
fn start<I>(input: I, saved: Option<Saved>) -> Start<I> {
    saved.map_or(Start::Fresh(input), Start::Resumed)
}

/// Runs a stage line by line, with one call for each.
fn by_hand<S: Stage>(settings: S::Settings, input: S::Input) -> StageRun<S::Outcome> {
    let mut stage = S::begin(settings, input, &OneWorker).unwrap();
    let mut totals = StageTotals::default();
    loop {
        let (round, chains) = (stage.round(), stage.chains());
        for number in 0..chains.max(1) {
            let units = if chains == 0 { round.clone() } else { chain_units(&round, number, chains) };
            let mut chain = stage.chain(number);
            units.for_each(|unit| stage.trace(0, &mut chain, unit..unit + 1, &mut totals));
        }
        if !stage.advance(&OneWorker) {
            break;
        }
    }
    let batches = stage.batches();
    StageRun { outcome: stage.finish(totals, &OneWorker).unwrap(), time: StageTime::default(), batches }
}

impl Outcome {
    fn of_shot(StageRun { outcome, batches, .. }: StageRun<Shot>) -> Self {
        let Shot { received, unit, balance, counts, sent, .. } = outcome;
        Self { received, quantum: unit.quantum(), balance, counts, walked: Walked::default(), batches, sent }
    }

    fn of_rays(run: StageRun<(Shot, Counts)>) -> Self {
        let StageRun { outcome: (shot, counts), batches, .. } = run;
        let Shot { received, unit, balance, correction, .. } = shot;
        let sent =
            correction.into_iter().enumerate().map(|(side, power)| (SideId::new(side), power)).collect();
        Self { received, quantum: unit.quantum(), balance, counts, walked: Walked::default(), batches, sent }
    }

    fn of_transport(room: &Room, StageRun { outcome, batches, .. }: StageRun<Transported>) -> Self {
        let received = outcome.received(&room.model, &OneWorker);
        let Transported { unit, balance, counts, walked, .. } = outcome;
        Self { received, quantum: unit.quantum(), balance, counts, walked, batches, sent: Vec::new() }
    }

    /// Fails unless both outcomes are bit-identical.
    #[track_caller]
    pub(crate) fn assert_is(&self, expected: &Self, what: &str) {
        assert_eq!(self.counts, expected.counts, "{what}: counts");
        assert_eq!(self.balance, expected.balance, "{what}: balance");
        assert_eq!(self.received.hash(), expected.received.hash(), "{what}: power received");
        assert!(
            self.received.variance == expected.received.variance,
            "{what}: variance of the power received"
        );
        assert_eq!(self.walked, expected.walked, "{what}: random walks");
        assert_eq!(self.batches, expected.batches, "{what}: batches");
        assert!(self == expected, "{what}");
    }
}

/// Returns an executor with this number of threads on this rank.
pub(crate) fn executor(comm: &dyn Communicator, threads: usize) -> Executor<'_> {
    let threads = NonZeroUsize::new(threads).unwrap();
    Executor { comm, threads, observer: Box::new(StopAfter::NEVER), checkpoints: None, prior: None }
}
