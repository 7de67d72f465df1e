//! Light sources: what there is, and how much power it has.

use sir_geom::{LightKind, Rgb, Scene, Side};
use sir_lines::ParallelLines;
use sir_mesh::{PatchId, PatchMesh};

use crate::emitter::Emitter;

/// Something that emits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Source {
    /// Where its lines come from.
    pub emitter: Emitter,
    /// Emitted power `Φ` per band \[W\]: `M A` of a surface; of light from outside, what enters the box around the scene.
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
                Source { emitter: Emitter::Distant(lines), power: irradiance * lines.area() }
            }
        });
    }
    if let Some(sky) = scene.sky() {
        let areas = bounds.face_areas();
        sources.push(Source { emitter: Emitter::Dome, power: sky.dome_through(areas) });
        sources.push(Source { emitter: Emitter::Ground, power: sky.ground_through(areas) });
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
