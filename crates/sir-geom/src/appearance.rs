//! Textures and corner values: the properties of surfaces that vary from point to point.

use glam::{DVec2, DVec4, Vec2, Vec4};

use crate::color::Rgb;
use crate::material::Opacity;
use crate::texture::{Texture, TextureMap};
use sir_types::Barycentric;

/// Textures of a scene, and values at the corners of its triangles.
#[derive(Clone, Debug, Default)]
pub(crate) struct Appearance {
    pub(crate) textures: Vec<Texture>,
    /// Texture coordinates of triangle corners.
    pub(crate) coordinates: Vec<[Vec2; 3]>,
    /// Colors (`xyz`) and opacities (`w`) of triangle corners.
    pub(crate) tints: Vec<[Vec4; 3]>,
}

/// Location of the corner values of a triangle in `Appearance`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Corners {
    /// Index of the first coordinate set.
    pub(crate) coordinates: u32,
    /// Number of coordinate sets.
    pub(crate) sets: u8,
    pub(crate) tint: u32,
}

/// Tint index of a triangle without a tint.
pub(crate) const NO_TINT: u32 = u32::MAX;

impl Corners {
    /// No corner values.
    pub(crate) const PLAIN: Self = Self { coordinates: 0, sets: 0, tint: NO_TINT };
}

impl Appearance {
    /// Adds the corner values of a triangle. Coordinates or tints that are not finite are omitted.
    pub(crate) fn add(&mut self, coordinates: &[[Vec2; 3]], tint: Option<[Vec4; 3]>) -> Corners {
        let mut corners = Corners { coordinates: self.coordinates.len() as u32, ..Corners::PLAIN };
        if coordinates.iter().flatten().all(|place| place.is_finite()) {
            corners.sets = coordinates.len().min(usize::from(u8::MAX)) as u8;
            self.coordinates.extend_from_slice(&coordinates[..usize::from(corners.sets)]);
        }
        if let Some(tint) = tint.filter(|tint| tint.iter().all(|corner| corner.is_finite())) {
            corners.tint = self.tints.len() as u32;
            self.tints.push(tint);
        }
        corners
    }

    /// Adds the corner values of a part of a triangle, interpolated from those of the whole triangle.
    pub(crate) fn part(&mut self, whole: Corners, part: [Barycentric; 3]) -> Corners {
        let first = whole.coordinates as usize;
        let sets = first..first + usize::from(whole.sets);
        let coordinates: Vec<_> = self.coordinates[sets]
            .iter()
            .map(|set| part.map(|point| mix(set.map(|place| place.as_dvec2()), point).as_vec2()))
            .collect();
        let tint = self
            .tints
            .get(whole.tint as usize)
            .map(|tint| part.map(|point| mix_tint(*tint, point).as_vec4()));
        self.add(&coordinates, tint)
    }

    /// Returns the texture of a map on a triangle, and its coordinates at the corners; `None` if the triangle lacks the
    /// coordinate set.
    pub(crate) fn texture(&self, map: &TextureMap, corners: Corners) -> Option<(&Texture, [DVec2; 3])> {
        if map.coordinates >= corners.sets {
            return None;
        }
        let coordinates =
            self.coordinates.get(corners.coordinates as usize + usize::from(map.coordinates))?;
        Some((self.textures.get(map.texture.index())?, coordinates.map(|c| c.as_dvec2())))
    }

    /// Returns the interpolated color and opacity of the corners at a point of a triangle.
    pub(crate) fn tint(&self, corners: Corners, point: Barycentric) -> Option<(Rgb, f64)> {
        let mixed = mix_tint(*self.tints.get(corners.tint as usize)?, point);
        Some((mixed.truncate().max(Rgb::ZERO), mixed.w.clamp(0.0, 1.0)))
    }

    /// Returns the opacity of a triangle at a point: the share of the light that it stops.
    pub(crate) fn opacity(&self, opacity: &Opacity, corners: Corners, point: Barycentric) -> f64 {
        let alpha = opacity.map.as_ref().and_then(|map| {
            let (texture, coordinates) = self.texture(map, corners)?;
            Some(texture.alpha_at(mix(coordinates, point), map.wrap))
        });
        let tint = self.tint(corners, point).filter(|_| opacity.cutoff.is_none());
        opacity.of_alpha(alpha.unwrap_or(1.0) * tint.map_or(1.0, |(_, alpha)| alpha))
    }
}

/// Interpolates texture coordinates at a point of a triangle.
pub(crate) fn mix(corners: [DVec2; 3], point: Barycentric) -> DVec2 {
    (1.0 - point.v - point.w) * corners[0] + point.v * corners[1] + point.w * corners[2]
}

/// Interpolates color (`xyz`) and opacity (`w`) at a point of a triangle.
fn mix_tint(corners: [Vec4; 3], point: Barycentric) -> DVec4 {
    let [a, b, c] = corners.map(|corner| corner.as_dvec4());
    (1.0 - point.v - point.w) * a + point.v * b + point.w * c
}
