//! Diffuse materials.

use crate::Rgb;

/// The largest reflectance of a scene in any band.
///
/// A surface that absorbs nothing makes the light in a closed room grow without bound; files that ask for a
/// reflectance of one (`Kd 1 1 1` is common) get this instead, with a [`Warning`](crate::Warning).
pub const MAX_REFLECTANCE: f64 = 0.999;

/// Which sides of a surface take part in light transport.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum Sides {
    /// Only the front reflects and emits. The back blocks light and absorbs what falls on it.
    #[default]
    Front,
    /// Both sides reflect, each on its own.
    Both,
}

/// A Lambertian surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// The name its author gave it, or an empty string.
    pub name: String,
    /// Diffuse reflectance per band, in `[0, 1)`.
    pub reflectance: Rgb,
    /// Emitted radiant exitance `M` of the front per band \[W/m²\]; of a radiance `L` it is `π L`.
    pub exitance: Rgb,
    /// Which sides reflect.
    pub sides: Sides,
    /// Whether the back emits `exitance` too. Has no effect unless `sides` is [`Sides::Both`].
    pub back_emits: bool,
}

impl Material {
    /// A one-sided surface that reflects and does not emit.
    #[must_use]
    pub fn diffuse(name: &str, reflectance: Rgb) -> Self {
        Self {
            name: name.to_owned(),
            reflectance,
            exitance: Rgb::ZERO,
            sides: Sides::Front,
            back_emits: false,
        }
    }

    /// The same surface with an emitted exitance `M` \[W/m²\] on its front.
    #[must_use]
    pub fn emitting(mut self, exitance: Rgb) -> Self {
        self.exitance = exitance;
        self
    }

    /// The same surface, reflecting from the given sides.
    #[must_use]
    pub fn with_sides(mut self, sides: Sides) -> Self {
        self.sides = sides;
        self
    }
}
