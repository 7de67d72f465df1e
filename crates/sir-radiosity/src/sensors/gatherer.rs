//! Final gathering at a sensor.

use glam::DVec3;
use sir_accel::Tracer;
use sir_geom::Rgb;
use sir_lines::{Purpose, Streams};

use crate::aimed::{Choice, Emitters};
use crate::model::Model;
use crate::sensors::measurement::Measurement;
use crate::sensors::ray_set::Gathering;
use crate::sensors::replication::{PatchHits, Replication};
use crate::sensors::sensor::{REPLICATIONS, Sensor, SensorSettings};
use crate::sensors::start::SensorStart;
use crate::sensors::unmet::{Brightness, Squares};
use crate::solution::Solution;

/// Measures the light of a solution at points, by final gathering.
#[derive(Clone, Debug)]
pub struct Gatherer<'s> {
    model: &'s Model,
    solution: &'s Solution,
    settings: SensorSettings,
    emitters: Emitters,
    brightness: Brightness,
    streams: Streams,
}

impl<'s> Gatherer<'s> {
    /// Prepares measurements of the light of a solution, which has the irradiance of the patches whose reflected light
    /// is gathered.
    #[must_use]
    pub fn new(model: &'s Model, solution: &'s Solution, settings: SensorSettings, seed: u64) -> Self {
        Self {
            model,
            solution,
            settings,
            emitters: Emitters::of(model),
            brightness: Brightness::of(model, solution),
            streams: Streams::new(seed, Purpose::SENSORS),
        }
    }

    /// Measures the irradiance at a sensor. The result depends on the sensor, the seed and `number` only. `number`
    /// should differ between sensors and must be below 2⁴⁵.
    ///
    /// Backs of one-sided surfaces are black.
    #[must_use]
    pub fn measure(&self, number: u64, sensor: &Sensor) -> Measurement {
        let mut tracer = self.model.accel.tracer();
        let (response, facets) = (sensor.response(), sensor.response().facets());
        let Self { model, solution, .. } = *self;
        let mut start = |&normal: &DVec3| SensorStart::at(sensor.position(), normal, model, &mut tracer);
        let starts: Vec<SensorStart> = facets.iter().map(&mut start).collect();
        let choice = |(start, normal): (&SensorStart, &DVec3)| self.emitters.from(start.origin, *normal);
        let choices: Vec<Choice<'_>> = starts.iter().zip(&facets).map(choice).collect();
        let gathering = |((start, normal), choice)| Gathering { model, solution, start, normal, choice };
        let parts = starts.iter().copied().zip(facets.iter().copied()).zip(&choices);
        let gatherings: Vec<Gathering<'_>> = parts.map(gathering).collect();
        let lights = self.lights(sensor, &gatherings, &mut tracer);
        let stream = |k| self.streams.line(number * REPLICATIONS + k);
        let SensorSettings { rays, error: target, replications: count, first } = self.settings;
        let mut replications: Vec<_> =
            (0..count).map(|k| Replication::new(facets.len(), &mut stream(k))).collect();
        let mut patch_hits = PatchHits::new(facets.len());
        let most = rays.div_ceil(count).max(1);
        let mut rays = if target > 0.0 { most.min(first.div_ceil(count)) } else { most };
        loop {
            for replication in &mut replications {
                replication.trace(rays, response, &gatherings, &mut tracer, &mut patch_hits);
            }
            let largest = response.largest_facet_weight();
            let mut unmet = Squares::default();
            for extremes in &patch_hits.extremes {
                unmet.add(self.brightness.unmet(extremes, rays * count), largest * largest);
            }
            let mut measurement = Measurement::of(&replications, unmet, lights);
            // Rays may all have missed something small and bright. It makes no part of the error, which would be far too
            // large where there is nothing of this kind in view, but it takes more rays to exclude it.
            let error = libm::hypot(measurement.sampling_error(), unmet.luminance.sqrt());
            let enough = error <= target * measurement.luminance();
            if rays == most || enough {
                measurement.inherit(&patch_hits.errors(model, solution), rays * count);
                measurement.rays = rays * count * response.facet_count();
                return measurement;
            }
            rays = most.min(2 * rays);
        }
    }

    /// Returns the irradiance by lights without a surface.
    fn lights(&self, sensor: &Sensor, facets: &[Gathering<'_>], tracer: &mut Tracer<'_>) -> Rgb {
        let (mut rays, mut brings) = (Vec::new(), Vec::new());
        for light in self.model.scene.lights() {
            // The arrival is computed at the sensor itself. Only the shadow ray starts on the surface.
            let Some(arrival) = light.kind.arrival(sensor.position()) else { continue };
            let weight = sensor.response().value(arrival.towards);
            // The facet that faces the light most.
            let cosine = |facet: &&Gathering<'_>| facet.normal.dot(arrival.towards);
            let facing = facets.iter().max_by(|a, b| cosine(a).total_cmp(&cosine(b)));
            let Some(Gathering { start, .. }) = facing.filter(|_| weight > 0.0) else { continue };
            rays.push(start.ray_to_light(arrival.towards, arrival.distance, self.model));
            brings.push(weight * arrival.irradiance);
        }
        let mut seen = vec![false; rays.len()];
        tracer.occluded_each(&rays, |i, is_occluded| seen[i] = !is_occluded);
        // Rays are traced in any order, but floats have to be added in a fixed order.
        brings.iter().zip(seen).filter(|(_, seen)| *seen).fold(Rgb::ZERO, |sum, (brought, _)| sum + *brought)
    }
}
