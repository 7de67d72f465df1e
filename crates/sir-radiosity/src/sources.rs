//! Light sources: what there is, and how much power it has.

use sir_geom::{LightKind, Rgb, Scene, Side};
use sir_lines::{Focus, MAX_FOCUS_DENSITY, ParallelLines};
use sir_mesh::{PatchId, PatchMesh};

use crate::emitter::{Emitter, SkyAperture};
use crate::model::Model;

/// Something that emits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Source {
    /// Where its lines come from.
    pub emitter: Emitter,
    /// Emitted power `Φ` per band \[W\]: `M A` of a surface; of light from outside, what enters the box around the scene, or a part of that.
    pub power: Rgb,
}

/// All sources of a scene: surfaces in the order of their triangles, front before back, patch by patch where a texture makes them
/// differ (a source is then a patch, evenly bright where it is covered), then lights in their order, then the sky and
/// its ground.
#[must_use]
pub fn sources(scene: &Scene, mesh: &PatchMesh) -> Vec<Source> {
    let mut sources = surfaces(scene, mesh);
    let bounds = scene.bounding_box();
    for light in scene.lights() {
        sources.push(match light.kind {
            LightKind::Point { position, intensity, spread } => {
                let power = intensity * spread.solid_angle();
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

/// Whether anything emits.
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
            let patches = mesh.patches_of(triangle);
            // A face that is one patch has several triangles.
            let part = area / (patches.len() as f64 * mesh.patch_area(triangle));
            for patch in patches.map(PatchId) {
                let corners = mesh.patch_corners(triangle, patch).map(|b| b.point(corners));
                let emitter = Emitter::Surface { triangle, patch: Some(patch), side, corners, normal };
                let exitance = mesh.exitance(scene, triangle, patch, side);
                sources.push(Source { emitter, power: exitance * mesh.covered_area(triangle, patch) * part });
            }
        }
    }
    sources
}

/// Least share of the light from outside that must pass around a focus to be a source of its own: its lines are those of all that do
/// not meet the focus, and would be looked for too long.
const AROUND: f64 = 1.0 / 64.0;

/// Sources, and where more of their lines go.
#[derive(Clone, Debug)]
pub(crate) struct FocusedSources {
    /// All sources; with a focus, light from outside is cut into what passes through it and what does not.
    pub(crate) sources: Vec<Source>,
    /// Which of them are in the focus.
    in_focus: Vec<bool>,
    /// How many times as many lines those in the focus have for the same power: at least 1.
    pub(crate) density: f64,
}

impl FocusedSources {
    /// The sources of a scene, with so many lines for those in the focus that they have the share of all that it asks for. Within both kinds lines
    /// are in proportion to power. Where sources in the focus have that share of the power, all lines are alike.
    pub(crate) fn new(model: &Model, focus: Option<&Focus>) -> Self {
        let scene = &model.scene;
        let all = sources(scene, &model.mesh);
        let Some(focus) = focus else { return Self::plain(all) };
        let (mut cut, mut inside) = (Vec::with_capacity(all.len() + 8), Vec::new());
        for source in &all {
            for (part, in_focus) in split(scene, *source, focus) {
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
        Self { sources: cut, in_focus: inside, density: wanted.min(f64::from(MAX_FOCUS_DENSITY)) }
    }

    /// Sources whose lines are all alike.
    pub(crate) fn plain(sources: Vec<Source>) -> Self {
        Self { in_focus: vec![false; sources.len()], sources, density: 1.0 }
    }

    /// For how much power each source has lines as if all were alike \[W\].
    pub(crate) fn weights(&self) -> Vec<f64> {
        let powers = self.sources.iter().map(|source| source.power.element_sum());
        powers
            .zip(&self.in_focus)
            .map(|(power, &inside)| if inside { power * self.density } else { power })
            .collect()
    }

    /// Power of a line in the focus over the mean of all lines.
    pub(crate) fn inner_share(&self) -> f64 {
        let power: f64 = self.sources.iter().map(|source| source.power.element_sum()).sum();
        self.weights().iter().sum::<f64>() / power / self.density
    }
}

/// The part of a source that is in a focus, and that which is not.
fn split(scene: &Scene, source: Source, focus: &Focus) -> Vec<(Source, bool)> {
    let bounds = focus.bounds();
    let around = Some(bounds);
    let beside = |around| SkyAperture { through: scene.bounding_box(), around };
    let aperture = SkyAperture { through: bounds, around: None };
    let [whole, inner] = [scene.bounding_box().face_areas(), bounds.face_areas()];
    // Shares of all bands are the same.
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
            (Emitter::Dome(aperture), Emitter::Dome(beside(around)), power(inner) / power(whole))
        }
        Emitter::Ground(_) => {
            let share = inner.element_sum() / whole.element_sum();
            (Emitter::Ground(aperture), Emitter::Ground(beside(around)), share)
        }
    };
    match share {
        0.0 => vec![(source, false)],
        share if share > 1.0 - AROUND => vec![(source, true)],
        share => vec![
            (Source { emitter: through, power: source.power * share }, true),
            (Source { emitter: passing, power: source.power * (1.0 - share) }, false),
        ],
    }
}
