//! Diffuse materials.

use crate::color::Rgb;
use crate::texture::{ColorMap, TextureMap};

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

/// Which share of the lines that meet a surface is stopped by it; the others go straight on, as through fine wire mesh.
///
/// The share is `factor` times the alpha of the texture. With a `cutoff` it is one where that product reaches the cutoff, and
/// zero elsewhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Opacity {
    /// In `[0, 1]`.
    pub factor: f64,
    /// The texture.
    pub map: Option<TextureMap>,
    /// Where there is a surface at all.
    pub cutoff: Option<f64>,
}

impl Default for Opacity {
    /// An opaque surface.
    fn default() -> Self {
        Self { factor: 1.0, map: None, cutoff: None }
    }
}

impl Opacity {
    /// Whether it is one everywhere.
    #[must_use]
    pub fn is_full(&self) -> bool {
        self.map.is_none() && self.of_alpha(1.0) == 1.0
    }

    /// The opacity where the texture has this alpha.
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
    /// The name its author gave it, or an empty string.
    pub name: String,
    /// Diffuse reflectance per band, in `[0, 1)`. With a texture, its mean over the image.
    pub reflectance: Rgb,
    /// The texture of the reflectance.
    pub reflectance_map: Option<ColorMap>,
    /// Emitted radiant exitance `M` of the front per band \[W/m²\]; of a radiance `L` it is `π L`. With a texture, its mean over
    /// the image.
    pub exitance: Rgb,
    /// The texture of the exitance.
    pub exitance_map: Option<ColorMap>,
    /// How much of the light it stops.
    pub opacity: Opacity,
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
            reflectance_map: None,
            exitance: Rgb::ZERO,
            exitance_map: None,
            opacity: Opacity::default(),
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

    /// How many sets of texture coordinates its triangles need.
    #[must_use]
    pub fn coordinate_sets(&self) -> usize {
        let colors = [self.reflectance_map, self.exitance_map].map(|color| color.map(|color| color.map));
        let maps = colors.into_iter().chain([self.opacity.map]).flatten();
        maps.map(|map| usize::from(map.coordinates) + 1).max().unwrap_or(0)
    }

    /// Whether it differs from place to place, or lets light through.
    #[must_use]
    pub fn is_plain(&self) -> bool {
        self.reflectance_map.is_none() && self.exitance_map.is_none() && self.opacity.is_full()
    }

    /// The same surface, reflecting from the given sides.
    #[must_use]
    pub fn with_sides(mut self, sides: Sides) -> Self {
        self.sides = sides;
        self
    }
}
