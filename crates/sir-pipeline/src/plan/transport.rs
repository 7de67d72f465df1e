//! How global lines are drawn, and how they pass on light.

use sir_geom::Scene;
use sir_lines::{Domain, Focus, GlobalLines};

/// How global lines pass on the light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Transport {
    /// In frozen batches. Default, unless there are `replicas` or a `tail`.
    #[default]
    Batches,
    /// One after the other, in independent replicas, as Martínez, Forés and Martín (2009) published it.
    Replicas {
        /// Among how many replicas the lines are shared: from 1 to the number of lines. Default 1.
        replicas: u64,
        /// How many of the lines, at the ends of the replicas, only send on what was reflected: fewer than `lines`.
        /// Default a tenth.
        tail: u64,
    },
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
    /// The body around a scene.
    #[must_use]
    pub fn around(self, scene: &Scene) -> Domain {
        match self {
            Self::Sphere => Domain::Sphere(scene.bounding_sphere()),
            Self::Box => Domain::Box(scene.bounding_box()),
            Self::Hull => Domain::hull(scene.vertices()),
        }
    }

    /// The lines through the body around a scene, and maybe a focus.
    #[must_use]
    pub fn lines_around(self, scene: &Scene, focus: Option<Focus>) -> GlobalLines {
        let domain = self.around(scene);
        match focus {
            Some(focus) => GlobalLines::focused(domain, focus),
            None => domain.into(),
        }
    }
}
