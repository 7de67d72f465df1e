//! Final gathering at a probe.

use glam::DVec3;
use sir_accel::Tracer;
use sir_geom::{Rgb, luminance};
use sir_lines::{Purpose, Streams};

use crate::aimed::Emitters;
use crate::model::Model;
use crate::probes::harmonics::{BOUNDS, COSINE_FACTORS, HARMONICS, harmonics};
use crate::probes::measurement::{ProbeMeasurement, QUANTITIES, Values};
use crate::probes::replication::{AXES, ProbeHits, ProbeReplication};
use crate::sensors::{Brightness, Gathering, REPLICATIONS, SensorSettings, SensorStart, Squares};
use crate::solution::Solution;

/// Measures the light of a solution at probes, by final gathering.
#[derive(Clone, Debug)]
pub struct ProbeGatherer<'s> {
    model: &'s Model,
    solution: &'s Solution,
    settings: SensorSettings,
    emitters: Emitters,
    brightness: Brightness,
    streams: Streams,
}

impl<'s> ProbeGatherer<'s> {
    /// Prepares measurements of the light of a solution, which has the irradiance of the patches whose reflected light
    /// is gathered. `settings` has the number of rays of each of the six sensors of a probe.
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

    /// Measures the irradiance at a position. The result depends on the position, the seed and `number` only. `number`
    /// should differ between probes and must be below 2⁴⁵.
    ///
    /// Backs of one-sided surfaces are black. The result is finite everywhere, but meaningless on a surface.
    #[must_use]
    pub fn measure(&self, number: u64, position: DVec3) -> ProbeMeasurement {
        let mut tracer = self.model.accel.tracer();
        let start = SensorStart { origin: position, surface: None };
        let (lights, light) = self.lights(start, &mut tracer);
        let choices = AXES.map(|axis| self.emitters.from(position, axis));
        let Self { model, solution, .. } = *self;
        let gatherings = std::array::from_fn(|axis| Gathering {
            model,
            solution,
            start,
            normal: AXES[axis],
            choice: &choices[axis],
        });
        let stream = |k| self.streams.line(number * REPLICATIONS + k);
        let SensorSettings { rays, error: target, replications: count, first } = self.settings;
        let mut replications: Vec<_> = (0..count).map(|k| ProbeReplication::new(&mut stream(k))).collect();
        let mut hits = ProbeHits::default();
        let most = rays.div_ceil(count).max(1);
        let mut rays = if target > 0.0 { most.min(first.div_ceil(count)) } else { most };
        loop {
            for replication in &mut replications {
                replication.trace(rays, &gatherings, &mut tracer, &mut hits);
            }
            let all = rays * count;
            let unmet = hits.extremes.each_ref().map(|extremes| self.brightness.unmet(extremes, all));
            let mut measurement = of(&replications, &unmet);
            measurement.values.iter_mut().zip(lights).for_each(|(value, light)| *value += light);
            measurement.direct += light;
            // As for sensors, rays that may have missed something take more rays, but make no part of the error.
            let missed = unmet.iter().map(|squares| squares.luminance).sum::<f64>() / 6.0;
            let error = libm::hypot(measurement.sampling_error(), missed.sqrt());
            if rays == most || error <= target * luminance(measurement.mean().irradiance) {
                let squares = hits.inherited(self.model, self.solution, all);
                measurement.inherited = squares.map(|square| square.map(f64::sqrt));
                measurement.rays = 6 * all;
                return measurement;
            }
            rays = most.min(2 * rays);
        }
    }

    /// Returns the light by lights without a surface, exactly: all quantities, and the mean irradiance over all
    /// directions.
    fn lights(&self, start: SensorStart, tracer: &mut Tracer<'_>) -> (Values, Rgb) {
        let arrivals = self.model.scene.lights().iter().filter_map(|light| light.kind.arrival(start.origin));
        let arrivals: Vec<_> = arrivals.collect();
        let ray =
            |arrival: &sir_geom::Arrival| start.ray_to_light(arrival.towards, arrival.distance, self.model);
        let rays: Vec<_> = arrivals.iter().map(ray).collect();
        let mut is_seen = vec![false; rays.len()];
        tracer.occluded_each(&rays, |i, is_occluded| is_seen[i] = !is_occluded);
        let (mut values, mut mean) = (Values::default(), Rgb::ZERO);
        for (arrival, _) in arrivals.iter().zip(is_seen).filter(|(_, is_seen)| *is_seen) {
            let factors = COSINE_FACTORS.into_iter().zip(harmonics(arrival.towards)).map(|(a, y)| a * y);
            let cosines = AXES.into_iter().map(|axis| axis.dot(arrival.towards).max(0.0));
            let all = factors.chain(cosines);
            values.iter_mut().zip(all).for_each(|(value, factor)| *value += arrival.irradiance * factor);
            mean += arrival.irradiance * 0.25;
        }
        (values, mean)
    }
}

/// Returns the measurement from the replications, and from the squared errors by light that no ray of each sensor has
/// met, which count if the replications are equal.
fn of(replications: &[ProbeReplication], unmet: &[Squares; 6]) -> ProbeMeasurement {
    let n = replications.len() as f64;
    let means: Vec<(Values, Rgb)> = replications.iter().map(ProbeReplication::means).collect();
    let mut measurement = ProbeMeasurement::default();
    for (values, direct) in &means {
        measurement.values.iter_mut().zip(values).for_each(|(sum, value)| *sum += *value / n);
        measurement.direct += *direct / n;
    }
    let mut squares = Values::default();
    for (values, _) in &means {
        for ((square, value), mean) in squares.iter_mut().zip(values).zip(&measurement.values) {
            *square += (*value - *mean) * (*value - *mean);
        }
    }
    let has_spread = squares.iter().any(|square| *square != Rgb::ZERO);
    let squares =
        if has_spread { squares.map(|square| square / (n * (n - 1.0))) } else { unmet_squares(unmet) };
    measurement.sampling = squares.map(|square| square.map(f64::sqrt));
    measurement
}

/// Returns bounds of the squared errors of all quantities by light that no ray has met.
fn unmet_squares(unmet: &[Squares; 6]) -> Values {
    let sum = unmet.iter().fold(Rgb::ZERO, |sum, squares| sum + squares.bands);
    let mut all = [Rgb::ZERO; QUANTITIES];
    for ((square, factor), bound) in all.iter_mut().zip(COSINE_FACTORS).zip(BOUNDS) {
        // The cosines to the axes add up to at least 1.
        *square = sum * (factor * bound * factor * bound);
    }
    all[HARMONICS..].iter_mut().zip(unmet).for_each(|(square, squares)| *square = squares.bands);
    all
}
