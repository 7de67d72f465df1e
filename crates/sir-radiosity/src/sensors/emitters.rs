//! Choice of the emitting surfaces at which a sensor aims.

use std::f64::consts::PI;
use std::ops::Range;

use glam::DVec3;
use sir_geom::{Rgb, Side, TriangleId};
use sir_mesh::PatchId;

use crate::emitter::Emitter;
use crate::model::Model;
use crate::sensors::sensor::Sensor;
use crate::sensors::tree::{Leaf, MAX_CUT, Tree};
use crate::sources;

/// All emitting surfaces of a scene.
#[derive(Clone, Debug)]
pub(super) struct Emitters {
    patches: Vec<EmittingPatch>,
    /// Tree of the surfaces, if there are many.
    tree: Option<Tree>,
}

#[derive(Clone, Copy, Debug)]
struct EmittingPatch {
    triangle: TriangleId,
    /// Patch of the triangle, if its patches differ.
    patch: Option<PatchId>,
    side: Side,
    corners: [DVec3; 3],
    normal: DVec3,
    exitance: Rgb,
    area: f64,
}

/// Distribution of rays over the emitting surfaces for one sensor, without occlusion.
#[derive(Clone, Debug)]
pub(super) struct Choice<'e> {
    emitters: &'e Emitters,
    origin: DVec3,
    normal: DVec3,
    /// Ranges in the order of the tree; empty without a tree, where each patch is a group of its own.
    groups: Vec<Range<u32>>,
    /// Running sums of the probabilities of groups, or of patches; empty if the sensor sees no emitter.
    ends: Vec<f64>,
}

/// A point of an emitting surface that a sensor aims at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Aim {
    /// Unit vector towards the point.
    pub(super) direction: DVec3,
    /// Triangle aimed at.
    pub(super) triangle: TriangleId,
    /// Side of the triangle.
    pub(super) side: Side,
    /// Contribution of the ray, if the point is visible.
    pub(super) contribution: Rgb,
}

impl Emitters {
    pub(super) fn of(model: &Model) -> Self {
        let Model { scene, mesh, .. } = model;
        let patches = sources(scene, mesh).into_iter().filter_map(|source| match source.emitter {
            Emitter::Surface { triangle, patch, side, corners, normal } => {
                let exitance = match patch {
                    Some(patch) => model.exitance(triangle, patch, side),
                    None => scene.exitance(triangle, side),
                };
                // Including gaps: rays aimed at gaps hit something else.
                let [a, b, c] = corners;
                let area = 0.5 * (b - a).cross(c - a).length();
                Some(EmittingPatch { triangle, patch, side, corners, normal, exitance, area })
            }
            // Lights without a surface are measured separately. Rays that hit nothing measure the sky.
            _ => None,
        });
        let patches: Vec<EmittingPatch> = patches.collect();
        let tree = (patches.len() > MAX_CUT).then(|| {
            let leaf = |&EmittingPatch { corners, normal, exitance, area, .. }: &EmittingPatch| Leaf {
                corners,
                normal,
                power: exitance.element_sum() * area,
                area,
            };
            Tree::new(&patches.iter().map(leaf).collect::<Vec<_>>())
        });
        Self { patches, tree }
    }

    /// Returns the probability of aiming at each surface from a sensor, in proportion to an estimate of the irradiance
    /// that it brings.
    pub(super) fn from(&self, origin: DVec3, sensor: &Sensor) -> Choice<'_> {
        let normal = sensor.direction();
        let of_patch = |k: usize| weight(&self.patches[k], origin, normal);
        let (groups, weights): (Vec<_>, Vec<f64>) = match &self.tree {
            Some(tree) => tree.cut(origin, normal, of_patch).into_iter().unzip(),
            None => (Vec::new(), (0..self.patches.len()).map(of_patch).collect()),
        };
        let total: f64 = weights.iter().sum();
        let mut sum = 0.0;
        let mut ends = Vec::new();
        if total > 0.0 {
            ends.extend(weights.iter().map(|w| {
                sum += w / total;
                sum
            }));
        }
        Choice { emitters: self, origin, normal, groups, ends }
    }
}

/// Returns the exitance times an estimate of the share of the hemisphere that a source takes. The estimate uses the
/// geometry at the corners and the center of the source, and is at most 1. It is zero only if the source is behind the
/// sensor, or the sensor behind the source.
fn weight(emitting: &EmittingPatch, origin: DVec3, normal: DVec3) -> f64 {
    let [a, b, c] = emitting.corners;
    let height = (origin - a).dot(emitting.normal);
    if height <= 0.0 {
        return 0.0;
    }
    let at = |point: DVec3| {
        let to = point - origin;
        let square = to.length_squared();
        // Both cosines lack division by the distance.
        to.dot(normal).max(0.0) * height / (square * square).max(f64::MIN_POSITIVE)
    };
    let geometry = (at(a) + at(b) + at(c) + at((a + b + c) / 3.0)) / 4.0;
    let factor = (emitting.area * geometry).min(f64::MAX);
    emitting.exitance.element_sum() * (factor / (PI + factor))
}

impl Choice<'_> {
    /// True if there is nothing to aim at.
    pub(super) fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// Returns the probability of aiming at emitter `k`.
    fn probability(&self, k: usize) -> f64 {
        let Some(tree) = &self.emitters.tree else { return self.of_group(k) };
        let place = tree.place(k);
        let group = self.groups.partition_point(|group| group.end <= place);
        self.groups.get(group).map_or(0.0, |range| self.of_group(group) * tree.share(range, place))
    }

    fn of_group(&self, k: usize) -> f64 {
        match (self.ends.get(k), k.checked_sub(1).and_then(|before| self.ends.get(before))) {
            (Some(end), Some(start)) => end - start,
            (Some(end), None) => *end,
            _ => 0.0,
        }
    }

    /// Returns the contribution of emitter `k` to a ray in a direction that hits it at a distance, weighted between the
    /// two sampling strategies.
    ///
    /// Cosine-weighted rays sample a direction with the density `cos θ / π`, and aimed rays with
    /// `p_k r² / (A_k cos θ′)`. Each contributes `M/π · cos θ` over the sum of both densities (the balance heuristic of
    /// Veach and Guibas 1995), which is at most `M`. So neither an emitter that nearly touches the sensor nor a small
    /// and bright one makes a few rays carry most of the light.
    fn contribution(&self, k: usize, direction: DVec3, distance: f64) -> Rgb {
        let EmittingPatch { exitance, area, normal, .. } = self.emitters.patches[k];
        let cosine = direction.dot(self.normal);
        let its_cosine = -direction.dot(normal);
        if cosine <= 0.0 || its_cosine <= 0.0 {
            return Rgb::ZERO;
        }
        let aimed = PI * self.probability(k) * distance * distance / (area * its_cosine);
        exitance * (cosine / (aimed + cosine))
    }

    /// Returns the contribution of a cosine-weighted ray that has hit this side at this distance. `patch` is the patch
    /// hit, if the patches of the triangle differ.
    pub(super) fn hit_contribution(
        &self,
        triangle: TriangleId,
        patch: Option<PatchId>,
        side: Side,
        direction: DVec3,
        distance: f64,
    ) -> Rgb {
        let key = |emitting: &EmittingPatch| (emitting.triangle, emitting.side, emitting.patch);
        let found = self.emitters.patches.binary_search_by_key(&(triangle, side, patch), key);
        found.map_or(Rgb::ZERO, |k| self.contribution(k, direction, distance))
    }

    /// Aims at the point that corresponds to a point of the unit square. Returns `None` if the contribution is zero.
    pub(super) fn aim(&self, [u, v]: [f64; 2]) -> Option<Aim> {
        // The first coordinate selects the emitter. Its remainder is a coordinate on the emitter.
        let group = self.ends.partition_point(|&end| end <= u).min(self.ends.len().checked_sub(1)?);
        let probability = self.of_group(group);
        let start = self.ends[group] - probability;
        let within = ((u - start) / probability).clamp(0.0, 1.0);
        let (k, within) = match (&self.emitters.tree, self.groups.get(group)) {
            (Some(tree), Some(range)) => tree.choose(range, within),
            _ => (group, within),
        };
        let EmittingPatch { triangle, side, corners, .. } = self.emitters.patches[k];
        let to = sir_lines::continuous_point_on_triangle([within, v]).point(corners) - self.origin;
        let (distance, direction) = (to.length(), to.try_normalize()?);
        let contribution = self.contribution(k, direction, distance);
        (contribution != Rgb::ZERO).then_some(Aim { direction, triangle, side, contribution })
    }
}
