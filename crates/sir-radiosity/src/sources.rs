//! Light sources.

use glam::DVec3;
use sir_geom::{Rgb, Scene, Side, TriangleId};

/// A side of a triangle that emits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Source {
    /// The triangle.
    pub triangle: TriangleId,
    /// Which side of it.
    pub side: Side,
    /// Its corners.
    pub corners: [DVec3; 3],
    /// Unit normal on that side.
    pub normal: DVec3,
    /// Emitted power `Φ = M A` per band \[W\].
    pub power: Rgb,
}

/// All sources of a scene in the order of their triangles, front before back.
#[must_use]
pub fn sources(scene: &Scene) -> Vec<Source> {
    let mut sources = Vec::new();
    for triangle in scene.triangle_ids() {
        for side in [Side::Front, Side::Back] {
            let exitance = scene.exitance(triangle, side);
            if exitance != Rgb::ZERO {
                let normal = match side {
                    Side::Front => scene.normal(triangle),
                    Side::Back => -scene.normal(triangle),
                };
                let (corners, power) = (scene.corners(triangle), exitance * scene.area(triangle));
                sources.push(Source { triangle, side, corners, normal, power });
            }
        }
    }
    sources
}
