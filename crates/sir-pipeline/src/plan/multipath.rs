//! The stage `Multipath`: how global lines are drawn, and how they pass on light.

use sir_geom::Scene;
use sir_lines::{Domain, Focus, GlobalLines};
use sir_parallel::{Executor, RunError, StageRun, Start};
use sir_radiosity::{BatchSettings, Batches, Model, MultipathSettings, Shot, Transported};

use crate::plan::lines::{MAX_LINES, line_count};
use crate::text::field::Format as _;
use crate::text::formats::{Choice, count};
use crate::text::reader::{Fields, Reader};
use crate::text::record::{choice, named, record};

/// Most replicas: a table of them must fit into memory.
const MAX_REPLICAS: u64 = 1_000_000;

const DOMAINS: Choice<DomainKind> =
    Choice(&[("Hull", DomainKind::Hull), ("Box", DomainKind::Box), ("Sphere", DomainKind::Sphere)]);

record! {
    /// Distributes the reflected light along global lines.
    pub struct Multipath, check Multipath::check {
        /// Lines in all.
        pub lines: u64 = line_count().required();
        /// How the lines pass on the light, see below.
        pub transport: Transport = named("Batches").or(Transport::Batches);
        /// The convex body around the scene from whose surface the lines are drawn: its convex hull, its axis-aligned box, or a
        /// sphere.
        pub domain: DomainKind = DOMAINS.or(DomainKind::Hull);
    }
}

choice! {
    /// How global lines pass on the light.
    pub enum Transport as "transport" {
        /// In batches: with the lines of a batch, what the batch before has brought.
        Batches,
        /// In independent replicas, one line after the other, as Martínez, Forés and Martín (2009) published it.
        Replicas(Replicas),
    }
}

record! {
    /// Independent transports that share the lines.
    pub struct Replicas {
        /// How many replicas; not more than there are lines.
        pub count: u64 = count(1, MAX_REPLICAS, 8).or(1);
        /// How many of the lines, at the ends of the replicas, only pass on what has been reflected, so that little is left over
        /// (`unshot` in `result.json`); fewer than there are lines. With `0`, the method is as published.
        pub tail: Option<u64> = count(0, MAX_LINES, 100_000).optional("a tenth of the lines");
    }
}

/// The convex body around the scene from whose surface global lines are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DomainKind {
    /// The bounding sphere.
    Sphere,
    /// The axis-aligned bounding box.
    Box,
    /// The convex hull, which wastes the fewest lines. Default.
    #[default]
    Hull,
}

impl DomainKind {
    /// Returns the body around a scene.
    #[must_use]
    pub fn around(self, scene: &Scene) -> Domain {
        match self {
            Self::Sphere => Domain::Sphere(scene.bounding_sphere()),
            Self::Box => Domain::Box(scene.bounding_box()),
            Self::Hull => Domain::hull(scene.vertices()),
        }
    }

    /// Returns the lines through the body around a scene, and maybe a focus.
    #[must_use]
    pub fn lines_around(self, scene: &Scene, focus: Option<Focus>) -> GlobalLines {
        let domain = self.around(scene);
        match focus {
            Some(focus) => GlobalLines::focused(domain, focus),
            None => domain.into(),
        }
    }
}

impl Replicas {
    /// Returns how many of `lines` lines only pass on what has been reflected.
    #[must_use]
    pub fn tail_of(&self, lines: u64) -> u64 {
        self.tail.unwrap_or(lines / 10)
    }
}

impl Multipath {
    fn check(&self, reader: &mut Reader<'_>, fields: &Fields<'_>) {
        let Transport::Replicas(replicas) = &self.transport else { return };
        let (place, lines) = (fields.place_of("transport"), self.lines);
        if replicas.count > lines {
            let message = format!("there are {} replicas, but {lines} lines", replicas.count);
            reader.problem(place, message, "each replica needs a line: ask for fewer, or for more lines");
        }
        if replicas.tail_of(lines) >= lines {
            let message = format!("all of the {lines} lines are in the `tail`");
            let help =
                "leave `tail` out, or make it smaller: lines before the tail bring the light of the sources";
            reader.problem(place, message, help);
        }
    }

    /// Runs the transport over global lines.
    pub(crate) fn run(
        &self,
        model: &Model,
        domain: GlobalLines,
        seed: u64,
        start: Start<Shot>,
        executor: &mut Executor<'_>,
    ) -> Result<StageRun<Transported>, RunError> {
        let lines = self.lines;
        match &self.transport {
            Transport::Batches => {
                executor.run::<Batches<'_>>(BatchSettings { model, domain, lines, seed }, start)
            }
            Transport::Replicas(replicas) => {
                // A pipeline with a focus has none of these.
                let (domain, tail) = (domain.domain().clone(), replicas.tail_of(lines));
                let settings =
                    MultipathSettings { model, domain, lines, tail, replicas: replicas.count, seed };
                executor.run::<sir_radiosity::Multipath<'_>>(settings, start)
            }
        }
    }

    /// Says what else than more lines makes less light remain unshot.
    pub(crate) fn advice_on_unshot(&self) -> &'static str {
        match self.transport {
            Transport::Batches => "more lines",
            Transport::Replicas(_) => "more lines, fewer replicas or a longer `tail`",
        }
    }

    /// Returns true if what is unshot at the end is extrapolated, as far as anything was received.
    pub(crate) fn extrapolates(&self) -> bool {
        self.transport == Transport::Batches
    }
}
