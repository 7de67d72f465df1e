//! The stage `Multipath`: domain and transport of global lines.

use sir_geom::Scene;
use sir_lines::{Domain, Focus, GlobalLines};
use sir_parallel::{Executor, RunError, StageRun, Start};
use sir_radiosity::{BatchSettings, Batches, Model, ReplicaSettings, Shot, Transported};

use crate::plan::lines::{MAX_LINES, line_count};
use crate::text::field::Format as _;
use crate::text::formats::{Choice, count};
use crate::text::reader::{Fields, Reader};
use crate::text::record::{choice, named, record};

/// Largest number of replicas: a table of them must fit into memory.
const MAX_REPLICAS: u64 = 1_000_000;

const DOMAINS: Choice<DomainKind> =
    Choice(&[("Hull", DomainKind::Hull), ("Box", DomainKind::Box), ("Sphere", DomainKind::Sphere)]);

record! {
    /// Stage that distributes the reflected light along global lines.
    pub struct Multipath, check Multipath::check {
        /// Total number of lines.
        pub lines: u64 = line_count().required();
        /// Method by which the lines transport light, see below.
        pub transport: Transport = named("Batches").or(Transport::Batches);
        /// Convex body through which the lines are drawn: convex hull, axis-aligned bounding box or bounding sphere of
        /// the scene.
        pub domain: DomainKind = DOMAINS.or(DomainKind::Hull);
    }
}

choice! {
    /// Method by which global lines transport light.
    pub enum Transport as "transport" {
        /// Batches: the lines of a batch pass on the power that the lines of the previous batch brought.
        Batches,
        /// Independent replicas, each with one line after the other, as published by Martínez, Forés and Martín (2009).
        Replicas(Replicas),
    }
}

record! {
    /// Independent replicas that share the lines.
    pub struct Replicas {
        /// Number of replicas; at most the number of lines.
        pub count: u64 = count(1, MAX_REPLICAS, 8).or(1);
        /// Number of lines, at the ends of the replicas, that only pass on reflected power, so that little remains
        /// unshot (`unshot` in `result.json`); less than the total number of lines. With `0`, the method is as
        /// published.
        pub tail: Option<u64> = count(0, MAX_LINES, 100_000).optional("a tenth of the lines");
    }
}

/// Kind of convex body around the scene through which global lines are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DomainKind {
    /// Bounding sphere.
    Sphere,
    /// Axis-aligned bounding box.
    Box,
    /// Convex hull, which wastes the fewest lines. Default.
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

    /// Returns the global lines through the body around a scene, with an optional focus.
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
    /// Returns the number of lines, of `lines` in total, that only pass on reflected power.
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
            let message = format!("there are {} replicas, but only {lines} lines", replicas.count);
            reader.problem(place, message, "each replica needs a line; use fewer replicas or more lines");
        }
        if replicas.tail_of(lines) >= lines {
            let message = format!("all of the {lines} lines are in the `tail`");
            let help = "leave `tail` out, or make it smaller; only lines before the tail send the light of the sources";
            reader.problem(place, message, help);
        }
    }

    /// Runs the transport along this number of global lines.
    pub(crate) fn run(
        &self,
        model: &Model,
        domain: GlobalLines,
        lines: u64,
        seed: u64,
        start: Start<Shot>,
        executor: &mut Executor<'_>,
    ) -> Result<StageRun<Transported>, RunError> {
        match &self.transport {
            Transport::Batches => {
                executor.run::<Batches<'_>>(BatchSettings { model, domain, lines, seed }, start)
            }
            Transport::Replicas(replicas) => {
                // Pipelines with a focus cannot have replicas.
                let (domain, tail) = (domain.domain().clone(), replicas.tail_of(lines));
                let settings = ReplicaSettings { model, domain, lines, tail, replicas: replicas.count, seed };
                executor.run::<sir_radiosity::Replicas<'_>>(settings, start)
            }
        }
    }

    /// Returns true if power that is unshot at the end is missing from the result.
    pub(crate) fn loses_unshot(&self) -> bool {
        matches!(self.transport, Transport::Replicas(_))
    }
}
