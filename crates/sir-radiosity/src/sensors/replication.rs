//! One set of rays of a sensor.

use std::f64::consts::PI;

use glam::DVec3;
use sir_accel::{Hit, Ray, Tracer};
use sir_geom::{Rgb, TriangleId};
use sir_lines::{R2Sequence, Stream, cosine_direction};
use sir_mesh::SideId;

use crate::aimed::{Aim, Choice};
use crate::model::Model;
use crate::sensors::start::SensorStart;
use crate::sensors::unmet::Extremes;
use crate::solution::Solution;

/// Number of rays that are generated at a time.
const RAYS: u64 = 1024;

/// A low-discrepancy set of rays, with the sums of their contributions so far.
#[derive(Clone, Debug)]
pub(super) struct Replication {
    hemisphere: R2Sequence,
    aimed: R2Sequence,
    rays: u64,
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
        let (hemisphere, aimed) = (R2Sequence::new(stream.point()), R2Sequence::new(stream.point()));
        Self { hemisphere, aimed, rays: 0, direct: Rgb::ZERO, reflected: Rgb::ZERO }
    }

    /// Returns the irradiance by emitting surfaces and the sky, and the irradiance by reflected light.
    pub(super) fn means(&self) -> (Rgb, Rgb) {
        let per_ray = 1.0 / self.rays.max(1) as f64;
        (self.direct * per_ray, self.reflected * per_ray)
    }

    /// Traces rays until there are `rays` over the hemisphere, and the same number aimed at emitters.
    pub(super) fn trace(
        &mut self,
        rays: u64,
        (model, solution): (&Model, &Solution),
        (start, normal): (SensorStart, DVec3),
        choice: &Choice<'_>,
        tracer: &mut Tracer<'_>,
        patch_hits: &mut PatchHits,
    ) {
        while self.rays < rays {
            let numbers = self.rays..rays.min(self.rays + RAYS);
            self.rays = numbers.end;
            let ray = |direction| start.ray(direction);
            let mut all: Vec<Ray> =
                numbers.clone().map(|i| ray(cosine_direction(normal, self.hemisphere.at(i)))).collect();
            let free = all.len();
            let mut aims = Vec::new();
            if !choice.is_empty() {
                aims.extend(numbers.filter_map(|i| choice.aim(self.aimed.at(i))));
                all.extend(aims.iter().map(|aim| ray(aim.direction)));
            }
            // Rays are traced in any order, but floats have to be added in a fixed order.
            let mut hits = vec![None; all.len()];
            tracer.closest_each(&all, |i, hit| hits[i] = hit);
            for (ray, hit) in all[..free].iter().zip(&hits) {
                self.gather((model, solution), choice, ray.line.direction, hit.as_ref(), patch_hits);
            }
            for (Aim { triangle, side, contribution, .. }, hit) in aims.iter().zip(&hits[free..]) {
                if hit.is_some_and(|hit| (hit.triangle, hit.side) == (*triangle, *side)) {
                    self.direct += *contribution;
                    patch_hits.extremes.arrived.raise(*contribution);
                } else {
                    patch_hits.extremes.blocked.raise(*contribution);
                }
            }
        }
    }

    /// Adds the contribution of a ray over the hemisphere: the radiosity of the surface that it hit.
    fn gather(
        &mut self,
        (model, solution): (&Model, &Solution),
        choice: &Choice<'_>,
        direction: DVec3,
        hit: Option<&Hit>,
        patch_hits: &mut PatchHits,
    ) {
        let Model { scene, mesh, .. } = model;
        let Some(hit) = hit else {
            let light = scene.sky().map_or(Rgb::ZERO, |sky| PI * sky.radiance(direction));
            self.direct += light;
            patch_hits.extremes.sky.raise(light);
            return;
        };
        let Some(side) = mesh.side_at(hit.triangle, hit.point, hit.side) else { return };
        let patch = mesh.is_varied(hit.triangle).then(|| mesh.patch_at(hit.triangle, hit.point));
        self.direct += choice.hit_contribution(hit.triangle, patch, hit.side, direction, hit.t);
        let reflectance = model.reflectance(hit.triangle, side);
        if reflectance != Rgb::ZERO {
            let light = reflectance * solution.irradiance[side.index()];
            self.reflected += light;
            patch_hits.sides.push((side, hit.triangle));
            patch_hits.extremes.reflected.raise(light);
        }
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
