//! One set of rays of each facet of a sensor, with the light that they have brought.

use sir_accel::Tracer;
use sir_geom::{Rgb, TriangleId};
use sir_lines::Stream;
use sir_mesh::SideId;

use crate::model::Model;
use crate::sensors::ray_set::{Gathering, RayLight, RaySet};
use crate::sensors::response::Response;
use crate::sensors::unmet::Extremes;
use crate::solution::Solution;

/// Low-discrepancy sets of rays, one for each facet of a sensor, with the sums of their contributions so far.
#[derive(Clone, Debug)]
pub(super) struct Replication {
    sets: Vec<RaySet>,
    /// Sums over the rays. Both sampling strategies have the same number of rays.
    direct: Rgb,
    reflected: Rgb,
}

/// The patches that rays have hit with the weights of these rays, and the brightest light that the rays of each facet met.
#[derive(Clone, Debug)]
pub(super) struct PatchHits {
    sides: Vec<(SideId, TriangleId, f32)>,
    pub(super) extremes: Vec<Extremes>,
}

/// Contribution of a patch to the error of a sensor: the sum of the weights of the rays that hit the patch, and the standard
/// error of the light that it reflects.
pub(super) type Gathered = (f64, Rgb);

impl Replication {
    /// Returns the rays of a sensor with a number of facets, before any of them is traced.
    pub(super) fn new(facets: usize, stream: &mut Stream) -> Self {
        let sets = (0..facets).map(|_| RaySet::new(stream)).collect();
        Self { sets, direct: Rgb::ZERO, reflected: Rgb::ZERO }
    }

    /// Returns the irradiance by emitting surfaces and the sky, and the irradiance by reflected light.
    pub(super) fn means(&self) -> (Rgb, Rgb) {
        // All facets have the same number of rays.
        let per_ray = 1.0 / self.sets.first().map_or(1, |set| set.rays().max(1)) as f64;
        (self.direct * per_ray, self.reflected * per_ray)
    }

    /// Traces rays until each facet has `rays` over its hemisphere, and the same number aimed at emitters.
    pub(super) fn trace(
        &mut self,
        rays: u64,
        response: Response,
        gatherings: &[Gathering<'_>],
        tracer: &mut Tracer<'_>,
        PatchHits { sides, extremes }: &mut PatchHits,
    ) {
        let Self { sets, direct, reflected } = self;
        for ((set, gathering), extremes) in sets.iter_mut().zip(gatherings).zip(extremes) {
            set.trace(rays, *gathering, tracer, extremes, |ray: RayLight| {
                let weight = response.facet_weight(ray.direction);
                *direct += ray.direct * weight;
                *reflected += ray.reflected * weight;
                // Single precision is enough for the weights of errors.
                sides.extend(ray.patch.map(|(side, triangle)| (side, triangle, weight as f32)));
            });
        }
    }
}

impl PatchHits {
    /// Returns the hits of a sensor with a number of facets, before any ray is traced.
    pub(super) fn new(facets: usize) -> Self {
        Self { sides: Vec::new(), extremes: vec![Extremes::default(); facets] }
    }

    /// Returns, for each patch hit, the weight of its rays and the standard error of the light that it reflects.
    pub(super) fn errors(&mut self, model: &Model, solution: &Solution) -> Vec<Gathered> {
        // Weights are compared, too, so that the order of their sums is fixed.
        self.sides.sort_unstable_by(|a, b| a.0.cmp(&b.0).then(a.2.total_cmp(&b.2)));
        let patches = self.sides.chunk_by(|a, b| a.0 == b.0);
        let gathered = |rays: &[(SideId, TriangleId, f32)]| {
            let &(side, triangle, _) = rays.first()?;
            let weight = rays.iter().map(|ray| f64::from(ray.2)).sum::<f64>();
            Some((weight, solution.standard_error(model, triangle, side)))
        };
        patches.filter_map(gathered).collect()
    }
}
