//! Rays of a sensor, and the light that they bring.

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

/// A low-discrepancy set of rays of a sensor: cosine-weighted rays over its hemisphere, and the same number of rays
/// aimed at emitters.
#[derive(Clone, Debug)]
pub(crate) struct RaySet {
    hemisphere: R2Sequence,
    aimed: R2Sequence,
    rays: u64,
}

/// What rays of a sensor need to know.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Gathering<'g> {
    pub(crate) model: &'g Model,
    /// Irradiance of the patches whose reflected light is gathered.
    pub(crate) solution: &'g Solution,
    /// Start of all rays.
    pub(crate) start: SensorStart,
    /// Direction in which the sensor looks.
    pub(crate) normal: DVec3,
    /// Distribution of the rays aimed at emitters.
    pub(crate) choice: &'g Choice<'g>,
}

/// Light that a ray brings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct RayLight {
    /// Unit vector of the ray, away from the sensor.
    pub(crate) direction: DVec3,
    /// Contribution of emitting surfaces and of the sky to the irradiance \[W/m²\], a sum over rays.
    pub(crate) direct: Rgb,
    /// Contribution of reflected light \[W/m²\].
    pub(crate) reflected: Rgb,
    /// Patch that reflects the light.
    pub(crate) patch: Option<(SideId, TriangleId)>,
}

impl RaySet {
    pub(crate) fn new(stream: &mut Stream) -> Self {
        let (hemisphere, aimed) = (R2Sequence::new(stream.point()), R2Sequence::new(stream.point()));
        Self { hemisphere, aimed, rays: 0 }
    }

    /// Returns the number of rays over the hemisphere so far.
    pub(crate) fn rays(&self) -> u64 {
        self.rays
    }

    /// Traces rays until there are `rays` over the hemisphere, and the same number aimed at emitters. Calls `visit`
    /// with the light of each, in a fixed order, and updates the brightest light so far.
    pub(crate) fn trace(
        &mut self,
        rays: u64,
        gathering: Gathering<'_>,
        tracer: &mut Tracer<'_>,
        extremes: &mut Extremes,
        mut visit: impl FnMut(RayLight),
    ) {
        let Gathering { start, normal, choice, .. } = gathering;
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
                visit(gathering.light(ray.line.direction, hit.as_ref(), extremes));
            }
            for (Aim { triangle, side, contribution, direction }, hit) in aims.iter().zip(&hits[free..]) {
                if hit.is_some_and(|hit| (hit.triangle, hit.side) == (*triangle, *side)) {
                    extremes.arrived.raise(*contribution);
                    visit(RayLight { direct: *contribution, ..RayLight::dark(*direction) });
                } else {
                    extremes.blocked.raise(*contribution);
                }
            }
        }
    }
}

impl RayLight {
    fn dark(direction: DVec3) -> Self {
        Self { direction, direct: Rgb::ZERO, reflected: Rgb::ZERO, patch: None }
    }
}

impl Gathering<'_> {
    /// Returns the light of a ray over the hemisphere: the radiosity of the surface that it hit, or the light of the
    /// sky.
    fn light(self, direction: DVec3, hit: Option<&Hit>, extremes: &mut Extremes) -> RayLight {
        let Self { model, solution, choice, .. } = self;
        let Model { scene, mesh, .. } = model;
        let dark = RayLight::dark(direction);
        let Some(hit) = hit else {
            let direct = scene.sky().map_or(Rgb::ZERO, |sky| PI * sky.radiance(direction));
            extremes.sky.raise(direct);
            return RayLight { direct, ..dark };
        };
        let Some(side) = mesh.side_at(hit.triangle, hit.point, hit.side) else { return dark };
        let patch = mesh.is_varied(hit.triangle).then(|| mesh.patch_at(hit.triangle, hit.point));
        let direct = choice.hit_contribution(hit.triangle, patch, hit.side, direction, hit.t);
        let reflectance = model.reflectance(hit.triangle, side);
        if reflectance == Rgb::ZERO {
            return RayLight { direct, ..dark };
        }
        let reflected = reflectance * solution.irradiance[side.index()];
        extremes.reflected.raise(reflected);
        RayLight { direction, direct, reflected, patch: Some((side, hit.triangle)) }
    }
}
