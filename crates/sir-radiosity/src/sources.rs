//! Light sources: what there is, and how much power it has.

use sir_geom::{LightKind, Rgb, Scene, Side};
use sir_lines::ParallelLines;

use crate::emitter::Emitter;

/// Something that emits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Source {
    /// Where its lines come from.
    pub emitter: Emitter,
    /// Emitted power `Φ` per band \[W\]: `M A` of a surface; of light from outside, what enters the box around the scene.
    pub power: Rgb,
}

/// All sources of a scene: surfaces in the order of their triangles, front before back, then lights in their order, then the sky and
/// its ground.
#[must_use]
pub fn sources(scene: &Scene) -> Vec<Source> {
    let mut sources = surfaces(scene);
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

fn surfaces(scene: &Scene) -> Vec<Source> {
    let mut sources = Vec::new();
    for triangle in scene.triangle_ids() {
        for side in [Side::Front, Side::Back] {
            let exitance = scene.exitance(triangle, side);
            if exitance != Rgb::ZERO {
                let normal = match side {
                    Side::Front => scene.normal(triangle),
                    Side::Back => -scene.normal(triangle),
                };
                let corners = scene.corners(triangle);
                let emitter = Emitter::Surface { triangle, side, corners, normal };
                sources.push(Source { emitter, power: exitance * scene.area(triangle) });
            }
        }
    }
    sources
}
