//! The light sources as seen from the points of patches.

use std::f64::consts::PI;

use glam::DVec3;
use sir_accel::Ray;
use sir_geom::{LightKind, Rgb, TriangleId};
use sir_lines::cosine_direction;
use sir_mesh::PatchId;

use crate::aimed::{Aim, Emitters};
use crate::model::Model;
use crate::sensors::SensorStart;
use crate::shadow_rays::batch::Batch;

/// The sources of light as seen from a point.
#[derive(Debug)]
pub(super) struct Sources {
    distant: Vec<LightKind>,
    /// Lights at a point.
    local: Vec<LightKind>,
    surfaces: Emitters,
    has_sky: bool,
    /// Centers and radii of spheres around lamps: lights at a point, and emitting surfaces.
    lamps: Vec<(DVec3, f64)>,
}

/// Largest distance of a lamp from the center of a patch that it is close to, in radii of the patch, and radius of a small
/// lamp.
const CLOSE: f64 = 2.0;
const SMALL: f64 = 0.5;

impl Sources {
    pub(super) fn of(model: &Model) -> Self {
        let lights = model.scene.lights().iter().map(|light| light.kind.clone());
        let (distant, local): (Vec<_>, Vec<_>) =
            lights.partition(|kind| matches!(kind, LightKind::Distant { .. }));
        let surfaces = Emitters::of(model);
        let at = |kind: &LightKind| match kind {
            LightKind::Point { position, .. } => Some((*position, 0.0)),
            LightKind::Distant { .. } => None,
        };
        let lamps =
            local.iter().filter_map(at).chain(surfaces.corners().map(|corners| around(&corners))).collect();
        Self { distant, local, surfaces, has_sky: model.scene.sky().is_some(), lamps }
    }

    /// Adds the rays from a point of a surface with this unit normal.
    pub(super) fn aim(
        &self,
        start: SensorStart,
        normal: DVec3,
        random: [f64; 2],
        model: &Model,
        batch: &mut Batch,
    ) {
        batch.irradiances.push(Rgb::ZERO);
        for light in &self.distant {
            if let Some((ray, irradiance)) = to_light(light, start, normal, model) {
                batch.push(ray, irradiance);
            }
        }
        self.aim_at_lamp(start, normal, random, model, batch);
        if let Some(sky) = model.scene.sky() {
            let direction = cosine_direction(normal, random);
            let irradiance = PI * sky.radiance(direction);
            if irradiance != Rgb::ZERO {
                batch.push(start.ray(direction), irradiance);
            }
        }
    }

    /// Adds a ray to one of all lamps.
    fn aim_at_lamp(
        &self,
        start: SensorStart,
        normal: DVec3,
        [u, v]: [f64; 2],
        model: &Model,
        batch: &mut Batch,
    ) {
        let Self { local, surfaces, .. } = self;
        let choice = surfaces.from(start.origin, normal);
        let rays = local.iter().filter_map(|light| to_light(light, start, normal, model));
        let lights: Vec<(Ray, Rgb)> = rays.collect();
        let of_lights: f64 = lights.iter().map(|(_, irradiance)| irradiance.element_sum()).sum();
        let total = choice.total + of_lights;
        let mut rest = u * total;
        if rest < choice.total {
            let share = choice.total / total;
            if let Some(aim) = choice.aim_alone([rest / choice.total, v]) {
                let Aim { direction, triangle, side, contribution } = aim;
                batch.push_aimed(start.ray(direction), (triangle, side), contribution / share);
            }
            return;
        }
        rest -= choice.total;
        for (i, &(ray, irradiance)) in lights.iter().enumerate() {
            let weight = irradiance.element_sum();
            if rest < weight || i + 1 == lights.len() {
                batch.push(ray, irradiance * (total / weight));
                return;
            }
            rest -= weight;
        }
    }

    /// True if a small lamp is close to a patch.
    pub(super) fn are_close_to(&self, model: &Model, triangle: TriangleId, patch: PatchId) -> bool {
        let (center, radius) = around(&model.mesh.corners(&model.scene, triangle, patch));
        self.lamps
            .iter()
            .any(|&(lamp, size)| size < SMALL * radius && lamp.distance(center) < CLOSE * radius + size)
    }

    /// Returns the numbers of rays from a point: to distant lights and the sky, and to lamps.
    pub(super) fn rays_per_point(&self) -> [u64; 2] {
        let has_lamps = !self.local.is_empty() || self.surfaces.count() > 0;
        [self.distant.len() as u64 + u64::from(self.has_sky), u64::from(has_lamps)]
    }
}

/// Returns the mean of points and the radius of a sphere around it.
fn around(points: &[DVec3]) -> (DVec3, f64) {
    let center = points.iter().sum::<DVec3>() / points.len() as f64;
    (center, points.iter().map(|point| point.distance(center)).fold(0.0, f64::max))
}

/// Returns the ray to a light without a surface, and the irradiance \[W/m²\] that it brings.
fn to_light(light: &LightKind, start: SensorStart, normal: DVec3, model: &Model) -> Option<(Ray, Rgb)> {
    let arrival = light.arrival(start.origin)?;
    let cosine = arrival.towards.dot(normal);
    (cosine > 0.0).then(|| {
        let ray = start.ray_to_light(arrival.towards, arrival.distance, model);
        (ray, cosine * arrival.irradiance)
    })
}
