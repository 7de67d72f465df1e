//! How to read a scene file.

#[cfg(any(feature = "gltf", feature = "obj"))]
use crate::material::{Material, Sides};

#[cfg(any(feature = "gltf", feature = "obj"))]
/// Reflectance in place of one that a file does not give.
pub(super) const DEFAULT_REFLECTANCE: f64 = 0.5;

/// How to read a scene file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct LoadOptions {
    /// Which sides of surfaces take part in light transport.
    pub sides: SidesPolicy,
}

/// What decides which sides of a surface reflect.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum SidesPolicy {
    /// The file: `doubleSided` in glTF, where both sides also emit. OBJ files have no such notion: both sides
    /// reflect, and the front emits.
    #[default]
    AsAuthored,
    /// Both sides of every surface reflect. Which sides emit is left to the file.
    Both,
    /// Only the fronts reflect and emit.
    Front,
}

impl SidesPolicy {
    #[cfg(any(feature = "gltf", feature = "obj"))]
    /// The material as this policy has it.
    pub(super) fn apply(self, mut material: Material) -> Material {
        match self {
            Self::AsAuthored => {}
            Self::Both => material.sides = Sides::Both,
            Self::Front => {
                material.sides = Sides::Front;
                material.back_emits = false;
            }
        }
        material
    }
}
