//! One set of rays of a probe, with the light that they have brought.

use std::collections::BTreeMap;

use glam::DVec3;
use sir_accel::Tracer;
use sir_geom::{Rgb, TriangleId};
use sir_lines::Stream;
use sir_mesh::SideId;

use crate::model::Model;
use crate::probes::harmonics::{COSINE_FACTORS, HARMONICS, harmonics};
use crate::probes::measurement::{QUANTITIES, Values};
use crate::sensors::{Extremes, Gathering, RayLight, RaySet};
use crate::solution::Solution;

/// Directions of the six sensors of a probe.
pub(super) const AXES: [DVec3; 6] = [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z];

/// Rays of the six sensors of a probe, with the sums of their contributions so far.
#[derive(Clone, Debug)]
pub(super) struct ProbeReplication {
    sets: [RaySet; 6],
    sums: Values,
    /// Sum of direct light, in the mean over all directions.
    direct: Rgb,
}

/// Patches whose light arrived, with the sums of the weights of their rays, and the brightest light that the rays of
/// each sensor met.
#[derive(Clone, Debug, Default)]
pub(super) struct ProbeHits {
    patches: BTreeMap<SideId, (TriangleId, [f64; QUANTITIES])>,
    pub(super) extremes: [Extremes; 6],
}

/// Returns the weights of all quantities for light from a direction that the sensor with the number `axis` has
/// measured.
///
/// The cosines of a direction to the axes that are not behind it add up to `S = |x| + |y| + |z|`. So `Y_i` is the sum of
/// `Y_i/S` times the cosines of all sensors, and its integral with radiance is the sum of what the six sensors measure
/// with the weight `Y_i/S`: each sensor measures radiance times its cosine.
pub(super) fn weights(direction: DVec3, axis: usize) -> [f64; QUANTITIES] {
    let share = 1.0 / direction.abs().element_sum();
    let mut weights = [0.0; QUANTITIES];
    for ((weight, factor), value) in weights.iter_mut().zip(COSINE_FACTORS).zip(harmonics(direction)) {
        *weight = factor * value * share;
    }
    weights[HARMONICS + axis] = 1.0;
    weights
}

impl ProbeReplication {
    pub(super) fn new(stream: &mut Stream) -> Self {
        let sets = std::array::from_fn(|_| RaySet::new(stream));
        Self { sets, sums: Values::default(), direct: Rgb::ZERO }
    }

    /// Returns the estimates of all quantities, and of the direct part of the mean irradiance over all directions.
    pub(super) fn means(&self) -> (Values, Rgb) {
        // All sensors have the same number of rays.
        let per_ray = 1.0 / self.sets[0].rays().max(1) as f64;
        (self.sums.map(|sum| sum * per_ray), self.direct * per_ray)
    }

    /// Traces rays until each sensor has `rays` over its hemisphere, and the same number aimed at emitters.
    pub(super) fn trace(
        &mut self,
        rays: u64,
        gatherings: &[Gathering<'_>; 6],
        tracer: &mut Tracer<'_>,
        ProbeHits { patches, extremes }: &mut ProbeHits,
    ) {
        let Self { sets, sums, direct } = self;
        for (axis, (set, extremes)) in sets.iter_mut().zip(extremes).enumerate() {
            set.trace(rays, gatherings[axis], tracer, extremes, |ray: RayLight| {
                let weights = weights(ray.direction, axis);
                let all = ray.direct + ray.reflected;
                sums.iter_mut().zip(weights).for_each(|(sum, weight)| *sum += all * weight);
                *direct += ray.direct * mean_weight(ray.direction);
                if let Some((side, triangle)) = ray.patch {
                    let (_, sums) = patches.entry(side).or_insert((triangle, [0.0; QUANTITIES]));
                    sums.iter_mut().zip(weights).for_each(|(sum, weight)| *sum += weight);
                }
            });
        }
    }
}

/// Returns the weight of light in the mean irradiance over all directions, which is a quarter of the integral of
/// radiance.
fn mean_weight(direction: DVec3) -> f64 {
    0.25 / direction.abs().element_sum()
}

impl ProbeHits {
    /// Returns the squares of the errors of all quantities that are due to the errors of the patches, if each sensor has
    /// `rays` rays.
    pub(super) fn inherited(&self, model: &Model, solution: &Solution, rays: u64) -> Values {
        let mut squares = Values::default();
        for (&side, &(triangle, weights)) in &self.patches {
            let error = solution.standard_error(model, triangle, side) / rays as f64;
            for (square, weight) in squares.iter_mut().zip(weights) {
                *square += error * error * (weight * weight);
            }
        }
        squares
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn weights_of_all_sensors_add_up_to_the_harmonics() {
        let direction = DVec3::new(0.3, -0.5, 0.7).normalize();
        let mut sums = [0.0; HARMONICS];
        for (axis, normal) in AXES.into_iter().enumerate() {
            let cosine = normal.dot(direction).max(0.0);
            sums.iter_mut().zip(weights(direction, axis)).for_each(|(sum, weight)| *sum += cosine * weight);
        }
        for ((sum, factor), value) in sums.into_iter().zip(COSINE_FACTORS).zip(harmonics(direction)) {
            assert!((sum - factor * value).abs() < 1e-15);
        }
        let mean = weights(direction, 0)[0] / (4.0 * PI).sqrt();
        assert!((mean - mean_weight(direction)).abs() < 1e-15);
    }
}
