//! Options for reading scene files.

#[cfg(any(feature = "gltf", feature = "obj"))]
use crate::material::{Material, Sides};

#[cfg(any(feature = "gltf", feature = "obj"))]
/// Reflectance where a file states none.
pub(super) const DEFAULT_REFLECTANCE: f64 = 0.5;

/// Options for reading a scene file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadOptions {
    /// Sides of surfaces that take part in light transport.
    pub sides: SidesPolicy,
    /// Length of a unit of the file \[m\], finite and above zero. It multiplies all lengths in the file: positions of
    /// corners, cameras and lights, and heights of parallel projections. Emission per area and intensities of lights
    /// stay as they are. Default 1.
    pub scale: f64,
}

impl Default for LoadOptions {
    fn default() -> Self {
        Self { sides: SidesPolicy::default(), scale: 1.0 }
    }
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
