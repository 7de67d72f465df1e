//! Options for reading scene files.

#[cfg(any(feature = "gltf", feature = "obj"))]
use crate::material::{Material, Sides};

#[cfg(any(feature = "gltf", feature = "obj"))]
/// Reflectance where a file states none.
pub(super) const DEFAULT_REFLECTANCE: f64 = 0.5;

/// Options for reading a scene file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct LoadOptions {
    /// Sides of surfaces that take part in light transport.
    pub sides: SidesPolicy,
}

/// Rule for which sides of a surface reflect.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum SidesPolicy {
    /// As stated in the file: by `doubleSided` in glTF, where both sides also emit. OBJ files do not state it: both
    /// sides reflect, and the front emits.
    #[default]
    AsAuthored,
    /// Both sides of every surface reflect. The file determines which sides emit.
    Both,
    /// Only the fronts reflect and emit.
    Front,
}

impl SidesPolicy {
    #[cfg(any(feature = "gltf", feature = "obj"))]
    /// Returns the material with the sides of this policy.
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
