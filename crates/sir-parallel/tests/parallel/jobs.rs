//! A scene with everything that light can meet, and the stages that are run on it.

use std::num::NonZeroUsize;
use std::sync::LazyLock;

use glam::DVec3;
use sir_geom::shapes::{self, Facing};
use sir_geom::{BoundingBox, Light, LightKind, Material, Rgb, SceneBuilder, Sides, Sky, SkyModel, Spread};
use sir_lines::{Domain, Focus, GlobalLines, LocalLines};
use sir_mesh::{SideId, Subdivision};
use sir_parallel::{
    Communicator, Crew, RunError, Saved, StageRun, batches, first_shot, multipath, second_shot,
};
use sir_radiosity::{
    Balance, Batches, Books, Counts, FirstShot, Model, Multipath, MultipathSettings, Quanta, Received,
    SecondShot, Shot, Totals, Transported,
};

use crate::observers::StopAfter;

/// Lines of every stage.
pub(crate) const LINES: u64 = 30_000;

const SEED: u64 = 3;

/// A scene, and the light that its lamp throws on it.
pub(crate) struct Room {
    pub(crate) model: Model,
    pub(crate) shot: Shot,
    pub(crate) domain: Domain,
}

/// The room of most tests.
pub(crate) static ROOM: LazyLock<Room> = LazyLock::new(|| Room::new(400));

/// The same room in so many patches that their state is handed over in several chunks.
pub(crate) static FINE_ROOM: LazyLock<Room> = LazyLock::new(|| Room::new(40_000));

/// A stage with its settings.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Job {
    FirstShot,
    /// With a focus.
    AimedShot,
    SecondShot,
    Batches,
    /// With a focus.
    AimedBatches,
    Multipath {
        replicas: u64,
        tail: u64,
    },
}

/// What a stage has made.
#[derive(Clone, PartialEq)]
pub(crate) struct Outcome {
    pub(crate) received: Received,
    pub(crate) quantum: f64,
    pub(crate) balance: Balance,
    pub(crate) counts: Counts,
    pub(crate) made_up: Quanta,
    pub(crate) batches: u64,
    pub(crate) sent: Vec<(SideId, Quanta)>,
}

/// All stages, multipath with various settings.
pub(crate) const JOBS: [Job; 11] = [
    Job::FirstShot,
    Job::AimedShot,
    Job::SecondShot,
    Job::Batches,
    Job::AimedBatches,
    Job::Multipath { replicas: 1, tail: 0 },
    Job::Multipath { replicas: 3, tail: 0 },
    Job::Multipath { replicas: 8, tail: 0 },
    Job::Multipath { replicas: 1, tail: LINES / 10 },
    Job::Multipath { replicas: 3, tail: LINES / 10 },
    Job::Multipath { replicas: 8, tail: LINES / 5 },
];

impl Room {
    /// A room whose front is open, in about so many patches. With a lamp that does not shine to the back, a
    /// solid block, and a sheet that reflects from both sides, light ends in all possible ways. It comes from a spot, the
    /// sun and the sky, too.
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

        // The walls of a box of 2 by 2 by 2, but for the one at y = −1.
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

        let model = Model::new(b.build().unwrap().scene, Subdivision::Patches(patches)).unwrap();
        let shot = first_shot(&model, LINES, SEED, &mut Crew::of(NonZeroUsize::MIN), None).unwrap().outcome;
        let domain = Domain::hull(model.scene.vertices());
        Self { model, shot, domain }
    }

    /// A focus on a part of the room.
    fn focus(&self) -> Focus {
        let bounds = BoundingBox { min: DVec3::splat(-1.0), max: DVec3::new(0.2, 0.6, 0.1) };
        Focus::new(bounds, 0.75, self.model.scene.bounding_box(), self.model.scene.bounding_sphere()).unwrap()
    }

    fn aimed_shot(&self) -> LocalLines {
        LocalLines { count: LINES, focus: Some(self.focus()) }
    }

    fn aimed_lines(&self) -> GlobalLines {
        let lines = GlobalLines::focused(self.domain.clone(), self.focus());
        assert!(lines.weight() > 1);
        lines
    }
}

impl Job {
    fn settings(replicas: u64, tail: u64, domain: Domain) -> MultipathSettings {
        MultipathSettings { lines: LINES, tail, replicas, domain }
    }

    /// Lets a crew do the stage, or go on with what was saved.
    pub(crate) fn run(
        self,
        room: &Room,
        crew: &mut Crew<'_>,
        saved: Option<Saved>,
    ) -> Result<Outcome, RunError> {
        let (model, domain) = (&room.model, room.domain.clone());
        // Who goes on has not made the first shot.
        let shot = || if saved.is_some() { Shot::nothing(model) } else { room.shot.clone() };
        match self {
            Self::FirstShot => first_shot(model, LINES, SEED, crew, saved).map(Outcome::of_shot),
            Self::AimedShot => first_shot(model, room.aimed_shot(), SEED, crew, saved).map(Outcome::of_shot),
            Self::SecondShot => second_shot(model, shot(), LINES, SEED, crew, saved).map(Outcome::of_shot),
            Self::Batches => {
                batches(model, shot(), LINES, domain, SEED, crew, saved).map(Outcome::of_transport)
            }
            Self::AimedBatches => {
                let through = room.aimed_lines();
                batches(model, shot(), LINES, through, SEED, crew, saved).map(Outcome::of_transport)
            }
            Self::Multipath { replicas, tail } => {
                let settings = Self::settings(replicas, tail, domain);
                multipath(model, shot(), settings, SEED, crew, saved).map(Outcome::of_transport)
            }
        }
    }

    /// The same stage without any crew: line by line.
    pub(crate) fn by_hand(self, room: &Room) -> Outcome {
        let (model, shot, mut books) = (&room.model, room.shot.clone(), Books::default());
        let run = match self {
            Self::FirstShot | Self::AimedShot => {
                let lines =
                    if let Self::AimedShot = self { room.aimed_shot() } else { LocalLines::from(LINES) };
                let stage = FirstShot::new(model, lines, SEED).unwrap();
                let tally = stage.tally(1);
                stage.trace(0, 0..LINES, &tally, &mut books);
                let outcome = stage.finish(tally, books).unwrap();
                return Outcome::of_shot(StageRun { outcome, time: Default::default(), batches: 1 });
            }
            Self::SecondShot => {
                let stage = SecondShot::new(model, &shot, LINES, SEED);
                let tally = stage.lines().tally(1);
                stage.lines().trace(0, 0..LINES, &tally, &mut books);
                let outcome = stage.finish(shot, tally, books).unwrap();
                return Outcome::of_shot(StageRun { outcome, time: Default::default(), batches: 1 });
            }
            Self::Batches | Self::AimedBatches => {
                let through = match self {
                    Self::AimedBatches => room.aimed_lines(),
                    _ => room.domain.clone().into(),
                };
                let mut stage = Batches::new(model, shot, LINES, through, SEED, 1);
                loop {
                    stage.parts(1).for_each(|mut part| part.open());
                    stage.trace(0, stage.lines(), &mut books);
                    let mut totals = Totals::default();
                    stage.parts(1).for_each(|mut part| totals += part.close());
                    if !stage.advance(totals) {
                        break;
                    }
                }
                let batches = stage.number() + 1;
                StageRun { outcome: stage.finish(books).unwrap(), time: Default::default(), batches }
            }
            Self::Multipath { replicas, tail } => {
                let settings = Self::settings(replicas, tail, room.domain.clone());
                let stage = Multipath::new(model, shot, settings, SEED, 1);
                for number in 0..replicas {
                    stage.trace(0, &mut stage.replica(number), u64::MAX, &mut books);
                }
                StageRun {
                    outcome: stage.finish(books).unwrap(),
                    time: Default::default(),
                    batches: replicas,
                }
            }
        };
        Outcome::of_transport(run)
    }
}

impl Outcome {
    fn of_shot(StageRun { outcome, batches, .. }: StageRun<Shot>) -> Self {
        let Shot { received, unit, balance, counts, sent } = outcome;
        Self { received, quantum: unit.quantum(), balance, counts, made_up: Quanta::ZERO, batches, sent }
    }

    fn of_transport(StageRun { outcome, batches, .. }: StageRun<Transported>) -> Self {
        let Transported { received, unit, balance, counts, made_up, .. } = outcome;
        Self { received, quantum: unit.quantum(), balance, counts, made_up, batches, sent: Vec::new() }
    }

    /// Equal to the last bit.
    #[track_caller]
    pub(crate) fn assert_is(&self, expected: &Self, what: &str) {
        assert_eq!(self.counts, expected.counts, "{what}: counts");
        assert_eq!(self.balance, expected.balance, "{what}: balance");
        assert_eq!(self.received.hash(), expected.received.hash(), "{what}: power received");
        assert!(
            self.received.variance == expected.received.variance,
            "{what}: variance of the power received"
        );
        assert_eq!(self.made_up, expected.made_up, "{what}: power made up");
        assert_eq!(self.batches, expected.batches, "{what}: batches");
        assert!(self == expected, "{what}");
    }
}

/// A crew of this rank with so many threads.
pub(crate) fn crew(comm: &dyn Communicator, threads: usize) -> Crew<'_> {
    let threads = NonZeroUsize::new(threads).unwrap();
    Crew { comm, threads, observer: Box::new(StopAfter::NEVER), checkpoints: None, earlier: None }
}
