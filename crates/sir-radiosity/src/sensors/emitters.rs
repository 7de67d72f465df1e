//! Which emitting surfaces a point aims at.

use std::f64::consts::PI;
use std::ops::Range;

use glam::DVec3;
use sir_geom::{Rgb, Side, TriangleId};
use sir_mesh::PatchId;

use crate::emitter::Emitter;
use crate::model::Model;
use crate::sensors::sensor::Sensor;
use crate::sensors::tree::{Leaf, MOST_GROUPS, Tree};
use crate::sources;

/// All emitting surfaces of a scene.
#[derive(Clone, Debug)]
pub(super) struct Emitters {
    patches: Vec<EmittingPatch>,
    /// Groups of them, if there are many.
    tree: Option<Tree>,
}

#[derive(Clone, Copy, Debug)]
struct EmittingPatch {
    triangle: TriangleId,
    /// The patch of it, if its patches differ.
    patch: Option<PatchId>,
    side: Side,
    corners: [DVec3; 3],
    normal: DVec3,
    exitance: Rgb,
    area: f64,
}

/// The emitting surfaces as a sensor sees them if nothing is in between.
#[derive(Clone, Debug)]
pub(super) struct Choice<'e> {
    emitters: &'e Emitters,
    origin: DVec3,
    normal: DVec3,
    /// What is told apart: ranges in the order of the tree; without a tree, nothing, since then it is the patches themselves.
    groups: Vec<Range<u32>>,
    /// Running sums of the probabilities of groups, or of patches; empty if the sensor sees no emitter.
    ends: Vec<f64>,
}

/// A point of an emitting surface that a sensor aims at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Aim {
    /// Unit vector towards the point.
    pub(super) direction: DVec3,
    /// The surface.
    pub(super) triangle: TriangleId,
    /// Which side of it.
    pub(super) side: Side,
    /// What it brings if it is seen.
    pub(super) brings: Rgb,
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
                // Gaps included: rays that are aimed at them meet something else.
                let [a, b, c] = corners;
                let area = 0.5 * (b - a).cross(c - a).length();
                Some(EmittingPatch { triangle, patch, side, corners, normal, exitance, area })
            }
            // Lights without a surface are measured by themselves, and the sky is what no ray meets.
            _ => None,
        });
        let patches: Vec<EmittingPatch> = patches.collect();
        let tree = (patches.len() > MOST_GROUPS).then(|| {
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

    /// How often each is to be aimed at from a point that looks in the direction `normal`: in proportion to an estimate of the
    /// irradiance that it brings.
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

/// Exitance times an estimate of the share of the hemisphere that a source takes: from the geometry at its corners and its middle,
/// and never more than all. Zero only where the source is behind the sensor, or the sensor behind the source.
fn weight(emitting: &EmittingPatch, origin: DVec3, normal: DVec3) -> f64 {
    let [a, b, c] = emitting.corners;
    let height = (origin - a).dot(emitting.normal);
    if height <= 0.0 {
        return 0.0;
    }
    let at = |point: DVec3| {
        let to = point - origin;
        let square = to.length_squared();
        // Both cosines lack the distance.
        to.dot(normal).max(0.0) * height / (square * square).max(f64::MIN_POSITIVE)
    };
    let geometry = (at(a) + at(b) + at(c) + at((a + b + c) / 3.0)) / 4.0;
    let factor = (emitting.area * geometry).min(f64::MAX);
    emitting.exitance.element_sum() * (factor / (PI + factor))
}

impl Choice<'_> {
    /// Whether there is anything to aim at.
    pub(super) fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// How often emitter `k` is aimed at.
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

    /// What the light of emitter `k` from a direction at a distance brings, shared between the two ways to find it.
    ///
    /// Rays of the cosine distribution find a direction with the density `cos θ / π`, aimed ones with `p_k r² / (A_k cos θ′)`. Each
    /// counts `M/π · cos θ` over the sum of both (the balance heuristic of Veach and Guibas 1995), which is never more than `M`:
    /// neither an emitter that nearly touches the sensor nor one that is small and bright makes few rays carry much.
    fn brings(&self, k: usize, direction: DVec3, distance: f64) -> Rgb {
        let EmittingPatch { exitance, area, normal, .. } = self.emitters.patches[k];
        let cosine = direction.dot(self.normal);
        let its_cosine = -direction.dot(normal);
        if cosine <= 0.0 || its_cosine <= 0.0 {
            return Rgb::ZERO;
        }
        let aimed = PI * self.probability(k) * distance * distance / (area * its_cosine);
        exitance * (cosine / (aimed + cosine))
    }

    /// What a ray of the cosine distribution brings that has met this side at this distance; `patch` is where, if the patches of
    /// the triangle differ.
    pub(super) fn met(
        &self,
        triangle: TriangleId,
        patch: Option<PatchId>,
        side: Side,
        direction: DVec3,
        distance: f64,
    ) -> Rgb {
        let key = |emitting: &EmittingPatch| (emitting.triangle, emitting.side, emitting.patch);
        let found = self.emitters.patches.binary_search_by_key(&(triangle, side, patch), key);
        found.map_or(Rgb::ZERO, |k| self.brings(k, direction, distance))
    }

    /// Aims at the point that belongs to one of the unit square; `None` if it brings nothing.
    pub(super) fn aim(&self, [u, v]: [f64; 2]) -> Option<Aim> {
        // The emitters share the first coordinate; what is left of it is a coordinate on the emitter.
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
        let brings = self.brings(k, direction, distance);
        (brings != Rgb::ZERO).then_some(Aim { direction, triangle, side, brings })
    }
}
