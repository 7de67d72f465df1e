//! Diffuse materials.

use crate::beam::Beam;
use crate::color::Rgb;
use crate::texture::{ColorMap, TextureMap};

/// Maximum reflectance of a scene in any band.
///
/// Without absorption, the light in a closed room would grow without bound. Files that state a reflectance of one
/// (`Kd 1 1 1` is common) get this value instead, with a [`Warning`](crate::Warning).
pub const MAX_REFLECTANCE: f64 = 0.999;

/// Sides of a surface that take part in light transport.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum Sides {
    /// Only the front reflects and emits. The back blocks light and absorbs what falls on it.
    #[default]
    Front,
    /// Both sides reflect independently.
    Both,
}

/// Share of the lines that a surface stops; the others pass straight on, as through fine wire mesh.
///
/// The share is `factor` times the alpha of the texture. With a `cutoff` it is one where that product is at least the
/// cutoff, and zero elsewhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Opacity {
    /// Factor, in `[0, 1]`.
    pub factor: f64,
    /// Texture with the alpha.
    pub map: Option<TextureMap>,
    /// Threshold of a mask, if it is one.
    pub cutoff: Option<f64>,
}

impl Default for Opacity {
    /// Returns the opacity of an opaque surface.
    fn default() -> Self {
        Self { factor: 1.0, map: None, cutoff: None }
    }
}

impl Opacity {
    /// Returns true if the surface is opaque everywhere.
    #[must_use]
    pub fn is_full(&self) -> bool {
        self.map.is_none() && self.of_alpha(1.0) == 1.0
    }

    /// Returns the opacity where the texture has this alpha.
    #[inline]
    #[must_use]
    pub fn of_alpha(&self, alpha: f64) -> f64 {
        let product = (self.factor * alpha).clamp(0.0, 1.0);
        self.cutoff.map_or(product, |cutoff| f64::from(u8::from(product >= cutoff)))
    }
}

/// A Lambertian surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Name given by the author, or an empty string.
    pub name: String,
    /// Diffuse reflectance per band, in `[0, 1)`. With a texture, its mean over the image.
    pub reflectance: Rgb,
    /// Texture of the reflectance.
    pub reflectance_map: Option<ColorMap>,
    /// Emitted radiant exitance `M` of the front per band \[W/m²\]: `π L` for a radiance `L`. With a texture, its mean
    /// over the image.
    pub exitance: Rgb,
    /// Texture of the exitance.
    pub exitance_map: Option<ColorMap>,
    /// Angular distribution of the light of the front, if it is not diffuse.
    pub beam: Option<Beam>,
    /// Share of the light that it stops.
    pub opacity: Opacity,
    /// Sides that reflect.
    pub sides: Sides,
    /// True if the back emits `exitance` too. Has no effect unless `sides` is [`Sides::Both`].
    pub back_emits: bool,
}

impl Material {
    /// Returns a one-sided material that reflects and does not emit.
    #[must_use]
    pub fn diffuse(name: &str, reflectance: Rgb) -> Self {
        Self {
            name: name.to_owned(),
            reflectance,
            reflectance_map: None,
            exitance: Rgb::ZERO,
            exitance_map: None,
            beam: None,
            opacity: Opacity::default(),
            sides: Sides::Front,
            back_emits: false,
        }
    }

    /// Returns the material with an emitted exitance `M` \[W/m²\] on its front.
    #[must_use]
    pub fn emitting(mut self, exitance: Rgb) -> Self {
        self.exitance = exitance;
        self
    }

    /// Returns the number of sets of texture coordinates that its triangles need.
    #[must_use]
    pub fn coordinate_sets(&self) -> usize {
        let colors = [self.reflectance_map, self.exitance_map].map(|color| color.map(|color| color.map));
        let maps = colors.into_iter().chain([self.opacity.map]).flatten();
        maps.map(|map| usize::from(map.coordinates) + 1).max().unwrap_or(0)
    }

    /// Returns true if it is uniform and opaque.
    #[must_use]
    pub fn is_plain(&self) -> bool {
        self.reflectance_map.is_none() && self.exitance_map.is_none() && self.opacity.is_full()
    }

    /// Returns the material with these reflecting sides.
    #[must_use]
    pub fn with_sides(mut self, sides: Sides) -> Self {
        self.sides = sides;
        self
    }
}
