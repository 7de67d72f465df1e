//! Choice of the emitting surfaces at which rays from a point aim.

use std::f64::consts::PI;
use std::ops::Range;

use glam::DVec3;
use sir_geom::{Beam, Rgb, Side, TriangleId};
use sir_mesh::PatchId;

use crate::aimed::seen::{SeenTriangle, share_of_hemisphere};
use crate::aimed::tree::{Leaf, MAX_CUT, Tree};
use crate::emitter::Emitter;
use crate::model::Model;
use crate::sources;

/// All emitting surfaces of a scene.
#[derive(Clone, Debug)]
pub(crate) struct Emitters {
    patches: Vec<EmittingPatch>,
    /// Tree of the surfaces, if there are many.
    tree: Option<Tree>,
}

#[derive(Clone, Debug)]
struct EmittingPatch {
    triangle: TriangleId,
    /// Patch of the triangle, if its patches differ.
    patch: Option<PatchId>,
    side: Side,
    corners: [DVec3; 3],
    normal: DVec3,
    exitance: Rgb,
    area: f64,
    /// Angular distribution of its light, if that is not diffuse.
    beam: Option<Beam>,
}

/// Distribution of rays over the emitting surfaces for one point, without occlusion.
#[derive(Clone, Debug)]
pub(crate) struct Choice<'e> {
    emitters: &'e Emitters,
    origin: DVec3,
    normal: DVec3,
    /// Ranges in the order of the tree; empty without a tree, where each patch is a group of its own.
    groups: Vec<Range<u32>>,
    /// Running sums of the probabilities of groups, or of patches; empty if nothing in front emits.
    ends: Vec<f64>,
    /// Estimate of the irradiance \[W/m²\], the sum over bands.
    pub(crate) total: f64,
}

/// Area of a source over its squared distance, above which its share of the hemisphere is not estimated: an inverse.
const NEAR: f64 = 16.0;

/// Smallest radiance that is expected of a directional light, relative to that of a diffuse one.
const DARKEST: f64 = 0.1;

/// A surface that is chosen.
struct Chosen {
    emitter: usize,
    probability: f64,
    /// Remainder of the number that chose it, uniform in `[0, 1]`.
    rest: f64,
}

/// A point of an emitting surface that a ray aims at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Aim {
    /// Unit vector towards the point.
    pub(crate) direction: DVec3,
    /// Triangle aimed at.
    pub(crate) triangle: TriangleId,
    /// Side of the triangle.
    pub(crate) side: Side,
    /// Contribution of the ray, if the point is visible.
    pub(crate) contribution: Rgb,
}

impl EmittingPatch {
    fn center(&self) -> DVec3 {
        let [a, b, c] = self.corners;
        (a + b + c) / 3.0
    }

    /// Returns the radiance in a direction of unit length, away from it, relative to that of a diffuse surface.
    fn relative_radiance(&self, direction: DVec3) -> f64 {
        self.beam.as_ref().map_or(1.0, |beam| beam.relative_radiance(direction))
    }

    /// Returns an estimate of the radiance that a point receives, likewise. It is never zero, because other parts of the surface
    /// may send more light there than its center.
    fn estimated_radiance(&self, origin: DVec3) -> f64 {
        let Some(beam) = &self.beam else { return 1.0 };
        let towards = (origin - self.center()).normalize_or_zero();
        DARKEST + (1.0 - DARKEST) * beam.relative_radiance(towards)
    }

    /// True if the surface is large for its distance.
    fn is_near(&self, origin: DVec3) -> bool {
        NEAR * self.area > origin.distance_squared(self.center())
    }
}

impl Emitters {
    pub(crate) fn of(model: &Model) -> Self {
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
                let beam = scene.material(triangle).beam.clone();
                Some(EmittingPatch { triangle, patch, side, corners, normal, exitance, area, beam })
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

    /// Returns the corners of all emitting surfaces.
    pub(crate) fn corners(&self) -> impl Iterator<Item = [DVec3; 3]> {
        self.patches.iter().map(|patch| patch.corners)
    }

    /// Returns the number of emitting surfaces.
    pub(crate) fn count(&self) -> usize {
        self.patches.len()
    }

    /// Returns the probability of aiming at each surface from a point of a surface with this unit normal, in proportion
    /// to an estimate of the irradiance that it brings.
    pub(crate) fn from(&self, origin: DVec3, normal: DVec3) -> Choice<'_> {
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
        Choice { emitters: self, origin, normal, groups, ends, total }
    }
}

/// Returns the exitance times the share of the hemisphere that a source takes, or an estimate of it from the geometry at the
/// corners and the center if the source is far away. It is zero only if the source is behind the sensor, or the sensor behind
/// the source.
fn weight(emitting: &EmittingPatch, origin: DVec3, normal: DVec3) -> f64 {
    let EmittingPatch { corners: corners @ [a, b, c], normal: its_normal, area, exitance, .. } = *emitting;
    let height = (origin - a).dot(its_normal);
    if height <= 0.0 {
        return 0.0;
    }
    let exitance = exitance.element_sum() * emitting.estimated_radiance(origin);
    if emitting.is_near(origin) {
        return exitance * share_of_hemisphere(origin, normal, corners);
    }
    let at = |point: DVec3| {
        let to = point - origin;
        let square = to.length_squared();
        // Both cosines lack division by the distance.
        to.dot(normal).max(0.0) * height / (square * square).max(f64::MIN_POSITIVE)
    };
    let geometry = (at(a) + at(b) + at(c) + at(emitting.center())) / 4.0;
    // A sliver may be close to a corner of it and far from its center.
    exitance * (area * geometry / PI).min(1.0)
}

impl Choice<'_> {
    /// True if there is nothing to aim at.
    pub(crate) fn is_empty(&self) -> bool {
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
        let emitting = &self.emitters.patches[k];
        let EmittingPatch { exitance, area, normal, .. } = *emitting;
        let cosine = direction.dot(self.normal);
        let its_cosine = -direction.dot(normal);
        if cosine <= 0.0 || its_cosine <= 0.0 {
            return Rgb::ZERO;
        }
        let aimed = PI * self.probability(k) * distance * distance / (area * its_cosine);
        exitance * (emitting.relative_radiance(-direction) * cosine / (aimed + cosine))
    }

    /// Returns the contribution of a cosine-weighted ray that has hit this side at this distance. `patch` is the patch
    /// hit, if the patches of the triangle differ.
    pub(crate) fn hit_contribution(
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

    /// Chooses a surface with its probability, by a uniform number. Returns `None` if there is nothing to aim at.
    fn choose(&self, u: f64) -> Option<Chosen> {
        let group = self.ends.partition_point(|&end| end <= u).min(self.ends.len().checked_sub(1)?);
        let probability = self.of_group(group);
        let start = self.ends[group] - probability;
        let within = ((u - start) / probability).clamp(0.0, 1.0);
        Some(match (&self.emitters.tree, self.groups.get(group)) {
            (Some(tree), Some(range)) => {
                let (emitter, rest) = tree.choose(range, within);
                let share = tree.share(range, tree.place(emitter));
                Chosen { emitter, probability: probability * share, rest }
            }
            _ => Chosen { emitter: group, probability, rest: within },
        })
    }

    /// Aims at the point that corresponds to a point of the unit square. Points are uniform on the surface. Returns `None`
    /// if the contribution is zero.
    pub(crate) fn aim(&self, [u, v]: [f64; 2]) -> Option<Aim> {
        let Chosen { emitter, rest, .. } = self.choose(u)?;
        let EmittingPatch { triangle, side, corners, .. } = self.emitters.patches[emitter];
        let to = sir_lines::continuous_point_on_triangle([rest, v]).point(corners) - self.origin;
        let (distance, direction) = (to.length(), to.try_normalize()?);
        let contribution = self.contribution(emitter, direction, distance);
        (contribution != Rgb::ZERO).then_some(Aim { direction, triangle, side, contribution })
    }

    /// Aims at the point that corresponds to a point of the unit square, without cosine-weighted rays beside these. Points
    /// are uniform on the surface if that is far away. If it is near, they are uniform within its solid angle, so that a
    /// surface that nearly touches the origin does not make a few rays carry most of the light. Returns `None` if the
    /// contribution is zero.
    pub(crate) fn aim_alone(&self, [u, v]: [f64; 2]) -> Option<Aim> {
        let Chosen { emitter, probability, rest } = self.choose(u)?;
        let emitting = &self.emitters.patches[emitter];
        let EmittingPatch { triangle, side, corners, normal, exitance, area, .. } = *emitting;
        let is_near = emitting.is_near(self.origin);
        let seen = if is_near { SeenTriangle::from(self.origin, corners) } else { None };
        // Irradiance per radiance: the solid angle times the cosine.
        let (direction, geometry) = match seen {
            Some(seen) => {
                let direction = seen.direction([rest, v]);
                (direction, seen.solid_angle * direction.dot(self.normal))
            }
            None => {
                let to = sir_lines::continuous_point_on_triangle([rest, v]).point(corners) - self.origin;
                let direction = to.try_normalize()?;
                let cosines = direction.dot(self.normal) * -direction.dot(normal);
                (direction, area * cosines / to.length_squared())
            }
        };
        let relative = emitting.relative_radiance(-direction);
        let contribution = exitance * (relative * geometry / (PI * probability));
        (geometry > 0.0 && contribution.is_finite()).then_some(Aim {
            direction,
            triangle,
            side,
            contribution,
        })
    }
}
