//! Light sources and their power.

use sir_geom::{LightKind, Rgb, Scene, Side};
use sir_lines::{Focus, MAX_FOCUS_DENSITY, ParallelLines};
use sir_mesh::PatchMesh;

use crate::emitter::{Emitter, SkyAperture};
use crate::error::SolveError;
use crate::model::Model;
use crate::power::POWERS;

/// A light source.
#[derive(Clone, Debug, PartialEq)]
pub struct Source {
    /// Kind and geometry of the source.
    pub emitter: Emitter,
    /// Emitted power `Φ` per band \[W\]: `M A` for a surface. For light from outside, the power that enters the box
    /// around the scene, or a part of it.
    pub power: Rgb,
}

/// Returns all sources of a scene: surfaces in the order of their triangles, front before back; then lights in their
/// order; then the sky and its ground.
///
/// Where patches differ because of a texture, each patch is a source, uniformly bright where it is covered.
#[must_use]
pub fn sources(scene: &Scene, mesh: &PatchMesh) -> Vec<Source> {
    let mut sources = surfaces(scene, mesh);
    let bounds = scene.bounding_box();
    for light in scene.lights() {
        sources.push(match light.kind {
            LightKind::Point { position, intensity, ref spread } => {
                let power = intensity * spread.solid_angle();
                let spread = spread.clone();
                Source { emitter: Emitter::Point { position, spread }, power }
            }
            LightKind::Distant { direction, irradiance } => {
                let lines = ParallelLines::through(bounds, direction);
                Source { emitter: Emitter::Distant { lines, around: None }, power: irradiance * lines.area() }
            }
        });
    }
    if let Some(sky) = scene.sky() {
        let areas = bounds.face_areas();
        let aperture = SkyAperture { through: bounds, around: None };
        sources.push(Source { emitter: Emitter::Dome(aperture), power: sky.dome_through(areas) });
        sources.push(Source { emitter: Emitter::Ground(aperture), power: sky.ground_through(areas) });
    }
    sources.retain(|source| source.power != Rgb::ZERO);
    sources
}

/// Returns the total power of sources per band \[W\].
///
/// # Errors
///
/// If it is zero, or the strongest band is outside [`POWERS`].
pub fn total_power(sources: &[Source]) -> Result<Rgb, SolveError> {
    let total = sources.iter().fold(Rgb::ZERO, |sum, source| sum + source.power);
    match total.max_element() {
        0.0 => Err(SolveError::NoLight),
        watts if total.is_finite() && POWERS.contains(&watts) => Ok(total),
        watts => Err(SolveError::Power { watts }),
    }
}

/// True if anything in the scene emits.
#[must_use]
pub fn emits(scene: &Scene) -> bool {
    let has_sky = scene.sky().is_some_and(|sky| {
        let areas = scene.bounding_box().face_areas();
        sky.dome_through(areas) + sky.ground_through(areas) != Rgb::ZERO
    });
    let lamps = || scene.materials().iter().any(|material| material.exitance != Rgb::ZERO);
    has_sky || !scene.lights().is_empty() || lamps()
}

fn surfaces(scene: &Scene, mesh: &PatchMesh) -> Vec<Source> {
    let mut sources = Vec::new();
    for triangle in scene.triangle_ids() {
        for side in [Side::Front, Side::Back] {
            let exitance = scene.exitance(triangle, side);
            if exitance == Rgb::ZERO {
                continue;
            }
            let normal = match side {
                Side::Front => scene.normal(triangle),
                Side::Back => -scene.normal(triangle),
            };
            let (corners, area) = (scene.corners(triangle), scene.area(triangle));
            if !mesh.is_varied(triangle) {
                let emitter = Emitter::Surface { triangle, patch: None, side, corners, normal };
                sources.push(Source { emitter, power: exitance * area });
                continue;
            }
            mesh.for_each_piece_of(triangle, |patch, piece| {
                let exitance = mesh.exitance(scene, triangle, patch, side);
                let part = area * piece.share() / mesh.patch_area(triangle, patch);
                let power = exitance * mesh.covered_area(triangle, patch) * part;
                // Patches of lamps with textures are triangles.
                if let [a, b, c] = *piece.corners() {
                    let corners = [a, b, c].map(|point| point.point(corners));
                    let emitter = Emitter::Surface { triangle, patch: Some(patch), side, corners, normal };
                    sources.push(Source { emitter, power });
                }
            });
        }
    }
    sources
}

/// Smallest share of the light from outside that must pass around a focus for it to be a source of its own. Its lines
/// are found by rejecting lines that meet the focus, which would take too long below this share.
const MIN_AROUND_SHARE: f64 = 1.0 / 64.0;

/// Sources, with the relative density of lines in the focus.
#[derive(Clone, Debug)]
pub(crate) struct FocusedSources {
    /// All sources. With a focus, light from outside is split into what passes through the focus and what does not.
    pub(crate) sources: Vec<Source>,
    /// Per source, true if it is in the focus.
    in_focus: Vec<bool>,
    /// Ratio of lines per power in the focus to lines per power elsewhere: at least 1.
    pub(crate) density: f64,
}

impl FocusedSources {
    /// Returns the sources of a scene. Those in the focus get enough lines to reach the share of all lines that the
    /// focus asks for, as far as the squares of the power of `lines` lines can be counted.
    ///
    /// Within and outside the focus, lines are in proportion to power. If the sources in the focus already have that
    /// share of the power, all lines carry the same power.
    pub(crate) fn new(model: &Model, focus: Option<&Focus>, lines: u64) -> Self {
        let scene = &model.scene;
        let all = sources(scene, &model.mesh);
        let Some(focus) = focus else { return Self::plain(all) };
        let (mut cut, mut inside) = (Vec::with_capacity(all.len() + 8), Vec::new());
        for source in all.iter().cloned() {
            for (part, in_focus) in split(scene, source, focus) {
                cut.push(part);
                inside.push(in_focus);
            }
        }
        let mut powers = [0.0; 2];
        for (source, &in_focus) in cut.iter().zip(&inside) {
            powers[usize::from(in_focus)] += source.power.element_sum();
        }
        let [outer, inner] = powers;
        let wanted = if inner > 0.0 { focus.share() / (1.0 - focus.share()) * (outer / inner) } else { 1.0 };
        if wanted <= 1.0 {
            return Self::plain(all);
        }
        Self { sources: cut, in_focus: inside, density: wanted.min(max_density(lines)) }
    }

    /// Returns sources whose lines all carry the same power.
    pub(crate) fn plain(sources: Vec<Source>) -> Self {
        Self { in_focus: vec![false; sources.len()], sources, density: 1.0 }
    }

    /// Returns weights \[W\] that are in proportion to the number of lines of each source: its power, times the density
    /// if it is in the focus.
    pub(crate) fn weights(&self) -> Vec<f64> {
        let powers = self.sources.iter().map(|source| source.power.element_sum());
        powers
            .zip(&self.in_focus)
            .map(|(power, &inside)| if inside { power * self.density } else { power })
            .collect()
    }

    /// Returns the power of a line in the focus over the mean power of all lines.
    pub(crate) fn inner_share(&self) -> f64 {
        let power: f64 = self.sources.iter().map(|source| source.power.element_sum()).sum();
        self.weights().iter().sum::<f64>() / power / self.density
    }
}

/// Returns the largest ratio of the density of lines in a focus to that elsewhere for which the squares of the power of
/// both fit the same counter of 60 bits, up to `lines` times.
fn max_density(lines: u64) -> f64 {
    (f64::from(1u32 << 28) / (lines.max(1) as f64).sqrt()).clamp(1.0, f64::from(MAX_FOCUS_DENSITY))
}

/// Splits a source into the part that is in a focus, marked true, and the part that is not.
fn split(scene: &Scene, source: Source, focus: &Focus) -> Vec<(Source, bool)> {
    let bounds = focus.bounds();
    let around = Some(bounds);
    let passing_aperture = |around| SkyAperture { through: scene.bounding_box(), around };
    let aperture = SkyAperture { through: bounds, around: None };
    let [whole, inner] = [scene.bounding_box().face_areas(), bounds.face_areas()];
    // The share is the same for all bands.
    let (through, passing, share) = match source.emitter {
        Emitter::Surface { corners: [a, b, c], .. } => {
            return vec![(source, bounds.contains((a + b + c) / 3.0))];
        }
        Emitter::Point { position, .. } => return vec![(source, bounds.contains(position))],
        Emitter::Distant { lines, .. } => {
            let through = ParallelLines::through(bounds, lines.direction());
            let share = through.area() / lines.area();
            (Emitter::Distant { lines: through, around: None }, Emitter::Distant { lines, around }, share)
        }
        Emitter::Dome(_) => {
            let power = |areas| scene.sky().map_or(Rgb::ZERO, |sky| sky.dome_through(areas)).element_sum();
            (Emitter::Dome(aperture), Emitter::Dome(passing_aperture(around)), power(inner) / power(whole))
        }
        Emitter::Ground(_) => {
            let share = inner.element_sum() / whole.element_sum();
            (Emitter::Ground(aperture), Emitter::Ground(passing_aperture(around)), share)
        }
    };
    match share {
        0.0 => vec![(source, false)],
        share if share > 1.0 - MIN_AROUND_SHARE => vec![(source, true)],
        share => vec![
            (Source { emitter: through, power: source.power * share }, true),
            (Source { emitter: passing, power: source.power * (1.0 - share) }, false),
        ],
    }
}
