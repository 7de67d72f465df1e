//! Lights as a scene takes them.

use glam::DVec3;
use sir_geom::{Light, Material, Rgb, SceneBuilder, Sky, shapes};

/// A light as it is added to a scene.
#[derive(Clone, Debug, PartialEq)]
pub enum SceneLight {
    /// A light without a surface.
    Light(Light),
    /// A black parallelogram that emits on the side from which its edges, in their order, run counterclockwise.
    Panel {
        /// One of its corners \[m\].
        corner: DVec3,
        /// From there to the two next ones \[m\].
        edges: [DVec3; 2],
        /// Emitted exitance per band \[W/m²\].
        exitance: Rgb,
    },
    /// What is seen where there is no surface.
    Sky(Sky),
}

impl SceneLight {
    /// Adds it to a scene; a sky replaces the one before.
    pub(crate) fn add_to(&self, builder: &mut SceneBuilder) {
        match self {
            Self::Light(light) => builder.add_light(light.clone()),
            Self::Sky(sky) => builder.set_sky(sky.clone()),
            Self::Panel { corner, edges: [a, b], exitance } => {
                let black = Material::diffuse("panel", Rgb::ZERO).emitting(*exitance);
                let black = builder.add_material(black);
                shapes::quad(builder, [*corner, corner + a, corner + a + b, corner + b], black);
            }
        }
    }
}
