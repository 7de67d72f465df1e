//! Lights of a pipeline, converted for a scene.

use glam::DVec3;
use sir_geom::{Light, Material, MaterialId, Rgb, SceneBuilder, Sky, shapes};

/// Light to be added to a scene.
#[derive(Clone, Debug, PartialEq)]
pub enum SceneLight {
    /// Light without a surface.
    Light(Light),
    /// Black parallelogram that emits on the side from which its edges, in their order, run counterclockwise.
    Panel {
        /// One of its corners \[m\].
        corner: DVec3,
        /// Vectors from the corner to the two adjacent ones \[m\].
        edges: [DVec3; 2],
        /// Emitted exitance per band \[W/m²\].
        exitance: Rgb,
    },
    /// Sky: the light from outside of the scene.
    Sky(Sky),
}

/// What emits in a scene after a light has been added.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Added {
    /// A light with this index.
    Light(usize),
    /// A material.
    Material(MaterialId),
    /// The sky.
    Sky,
}

impl SceneLight {
    /// Adds the light to a scene, and returns what has been added. A sky replaces an existing one.
    pub(crate) fn add_to(&self, builder: &mut SceneBuilder) -> Added {
        match self {
            Self::Light(light) => {
                let index = builder.light_count();
                builder.add_light(light.clone());
                Added::Light(index)
            }
            Self::Sky(sky) => {
                builder.set_sky(sky.clone());
                Added::Sky
            }
            Self::Panel { corner, edges: [a, b], exitance } => {
                let black = Material::diffuse("panel", Rgb::ZERO).emitting(*exitance);
                let black = builder.add_material(black);
                builder.begin_group("panel");
                shapes::quad(builder, [*corner, corner + a, corner + a + b, corner + b], black);
                Added::Material(black)
            }
        }
    }
}
