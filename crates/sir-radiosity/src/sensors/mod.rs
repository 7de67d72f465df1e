//! Irradiance where there is no patch: at points, by rays from there.
//!
//! Lights without a surface are exact, with one shadow ray each. Emitting surfaces are found in two ways, by rays aimed at them
//! and by rays of the cosine distribution over the hemisphere, which also gather what patches reflect and the light of the sky. The
//! rays come in [`REPLICATIONS`] sets, each of which is spread evenly ([`sir_lines::EvenPoints`]), and which are independent of each
//! other: their differences tell the error.

mod emitters;
mod measurement;
mod replication;
mod tree;

use glam::DVec3;
use sir_accel::{Ray, Tracer};
use sir_geom::{Line, Rgb};
use sir_lines::{Stage, Streams};

pub use measurement::Measurement;

use crate::model::Model;
use crate::solution::Solution;
use emitters::Emitters;
use replication::{Met, Replication};

/// Independent sets of rays of a sensor.
pub const REPLICATIONS: u64 = 32;

/// How far above its position a sensor looks from, in radii of the scene's bounding sphere, so that the surface on which it lies is
/// below it whatever was rounded in the file of the scene: 0.1 mm in a room of 10 m.
pub const LIFT: f64 = 1e-5;

/// Rays of all replications before the error is looked at for the first time.
const FIRST: u64 = 2048;

/// A point, and the direction in which it looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sensor {
    position: DVec3,
    direction: DVec3,
}

/// How carefully is measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorSettings {
    /// Most rays of a sensor over its hemisphere, rounded up to a multiple of [`REPLICATIONS`]; as many are aimed at emitting
    /// surfaces, if there are any.
    pub rays: u64,
    /// Relative standard error of the luminance-weighted irradiance by the choice of rays at which fewer rays are enough; 0 for never.
    pub error: f64,
}

/// A solution, ready to be measured.
#[derive(Clone, Debug)]
pub struct Sensors<'s> {
    model: &'s Model,
    solution: &'s Solution,
    settings: SensorSettings,
    emitters: Emitters,
    streams: Streams,
    /// Length by which sensors are lifted.
    lift: f64,
}

impl Sensor {
    /// A sensor at `position` that measures the irradiance of a surface with the normal `direction`, of any length.
    ///
    /// `None` if `direction` has no length, or a number is not finite.
    #[must_use]
    pub fn new(position: DVec3, direction: DVec3) -> Option<Self> {
        let direction = direction.try_normalize()?;
        position.is_finite().then_some(Self { position, direction })
    }

    /// Where it is.
    #[must_use]
    pub fn position(&self) -> DVec3 {
        self.position
    }

    /// Where it looks, of unit length.
    #[must_use]
    pub fn direction(&self) -> DVec3 {
        self.direction
    }
}

impl<'s> Sensors<'s> {
    /// Prepares to measure the light of a solution: `solution` has the irradiance of the patches, whose reflected light is gathered.
    #[must_use]
    pub fn new(model: &'s Model, solution: &'s Solution, settings: SensorSettings, seed: u64) -> Self {
        Self {
            model,
            solution,
            settings,
            emitters: Emitters::of(model),
            streams: Streams::new(seed, Stage::SENSORS),
            lift: LIFT * model.scene.bounding_sphere().radius,
        }
    }

    /// Measures at a sensor: a function of it, of the seed and of `number`, which should differ from sensor to sensor (below 2⁴⁵).
    ///
    /// Backs of one-sided surfaces are black.
    #[must_use]
    pub fn measure(&self, number: u64, sensor: &Sensor) -> Measurement {
        let origin = sensor.position + self.lift * sensor.direction;
        let mut tracer = self.model.accel.tracer();
        let lights = self.lights(sensor, origin, &mut tracer);
        let choice = self.emitters.from(origin, sensor);
        let stream = |k| self.streams.line(number * REPLICATIONS + k);
        let mut replications: Vec<_> = (0..REPLICATIONS).map(|k| Replication::new(&mut stream(k))).collect();
        let mut met = Met::default();
        let most = self.settings.rays.div_ceil(REPLICATIONS).max(1);
        let mut rays = if self.settings.error > 0.0 { most.min(FIRST / REPLICATIONS) } else { most };
        loop {
            for replication in &mut replications {
                replication.trace(rays, self, (origin, sensor.direction), &choice, &mut tracer, &mut met);
            }
            let mut measurement = Measurement::of(&replications, lights);
            let enough = measurement.sampling_error() <= self.settings.error * measurement.luminance();
            if rays == most || enough {
                measurement.inherit(&met.errors(self.model, self.solution), rays * REPLICATIONS);
                return measurement;
            }
            rays = most.min(2 * rays);
        }
    }

    /// The irradiance by lights without a surface.
    fn lights(&self, sensor: &Sensor, origin: DVec3, tracer: &mut Tracer<'_>) -> Rgb {
        let (mut rays, mut brings) = (Vec::new(), Vec::new());
        for light in self.model.scene.lights() {
            // What arrives at the sensor itself; only the shadow ray starts above it.
            let Some(arrival) = light.kind.arrival(sensor.position) else { continue };
            let cosine = arrival.towards.dot(sensor.direction);
            if cosine <= 0.0 {
                continue;
            }
            // A light that lies on a surface is in front of it, as sensors are.
            let ray = Ray::new(Line { origin, direction: arrival.towards });
            rays.push(ray.within(0.0..arrival.distance - self.lift));
            brings.push(cosine * arrival.irradiance);
        }
        let mut seen = vec![false; rays.len()];
        tracer.occluded_each(&rays, |i, is_occluded| seen[i] = !is_occluded);
        // Rays are done in any order, but floats have to be added up in always the same.
        brings.iter().zip(seen).filter(|(_, seen)| *seen).fold(Rgb::ZERO, |sum, (brought, _)| sum + *brought)
    }
}
