//! One set of rays of a sensor, with the light that they have brought.

use sir_accel::Tracer;
use sir_geom::{Rgb, TriangleId};
use sir_lines::Stream;
use sir_mesh::SideId;

use crate::model::Model;
use crate::sensors::ray_set::{Gathering, RayLight, RaySet};
use crate::sensors::unmet::Extremes;
use crate::solution::Solution;

/// A low-discrepancy set of rays, with the sums of their contributions so far.
#[derive(Clone, Debug)]
pub(super) struct Replication {
    rays: RaySet,
    /// Sums over the rays. Both sampling strategies have the same number of rays.
    direct: Rgb,
    reflected: Rgb,
}

/// The patches that rays have hit, and the brightest light that they met.
#[derive(Clone, Debug, Default)]
pub(super) struct PatchHits {
    sides: Vec<(SideId, TriangleId)>,
    pub(super) extremes: Extremes,
}

/// Contribution of a patch to the error of a sensor: the number of rays that hit the patch, and the standard error of
/// the light that it reflects.
pub(super) type Gathered = (u64, Rgb);

impl Replication {
    pub(super) fn new(stream: &mut Stream) -> Self {
        Self { rays: RaySet::new(stream), direct: Rgb::ZERO, reflected: Rgb::ZERO }
    }

    /// Returns the irradiance by emitting surfaces and the sky, and the irradiance by reflected light.
    pub(super) fn means(&self) -> (Rgb, Rgb) {
        let per_ray = 1.0 / self.rays.rays().max(1) as f64;
        (self.direct * per_ray, self.reflected * per_ray)
    }

    /// Traces rays until there are `rays` over the hemisphere, and the same number aimed at emitters.
    pub(super) fn trace(
        &mut self,
        rays: u64,
        gathering: Gathering<'_>,
        tracer: &mut Tracer<'_>,
        PatchHits { sides, extremes }: &mut PatchHits,
    ) {
        let Self { rays: set, direct, reflected } = self;
        set.trace(rays, gathering, tracer, extremes, |ray: RayLight| {
            *direct += ray.direct;
            *reflected += ray.reflected;
            sides.extend(ray.patch);
        });
    }
}

impl PatchHits {
    /// Returns, for each patch hit, the number of rays and the standard error of the light that it reflects.
    pub(super) fn errors(&mut self, model: &Model, solution: &Solution) -> Vec<Gathered> {
        self.sides.sort_unstable_by_key(|(side, _)| *side);
        let patches = self.sides.chunk_by(|a, b| a.0 == b.0);
        let gathered = |rays: &[(SideId, TriangleId)]| {
            let &(side, triangle) = rays.first()?;
            Some((rays.len() as u64, solution.standard_error(model, triangle, side)))
        };
        patches.filter_map(gathered).collect()
    }
}
