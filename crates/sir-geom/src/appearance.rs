//! How the properties of surfaces vary on them: textures and colours at corners.

use std::sync::Arc;

use glam::{DVec2, DVec4, Vec2, Vec4};

use crate::color::Rgb;
use crate::material::Opacity;
use crate::material::{MAX_REFLECTANCE, Material};
use crate::scene::{Scene, Triangle};
use crate::texture::{ColourMap, Texture, TextureMap};
use sir_types::{Barycentric, Side, TriangleId};

/// Textures, and what triangles have at their corners.
#[derive(Clone, Debug, Default)]
pub(crate) struct Appearance {
    pub(crate) textures: Vec<Texture>,
    /// Coordinates of the corners of triangles.
    pub(crate) coordinates: Vec<[Vec2; 3]>,
    /// Colours, and in the last place opacities, of the corners of triangles.
    pub(crate) tints: Vec<[Vec4; 3]>,
}

/// Where the values at the corners of a triangle are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Corners {
    /// The first of its sets of coordinates.
    pub(crate) coordinates: u32,
    /// How many sets it has.
    pub(crate) sets: u8,
    pub(crate) tint: u32,
}

/// In place of the number of a tint.
const NONE: u32 = u32::MAX;

impl Corners {
    /// A triangle without such values.
    pub(crate) const PLAIN: Self = Self { coordinates: 0, sets: 0, tint: NONE };
}

impl Appearance {
    /// Takes in values at the corners of a triangle; those that are not finite are left out.
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

    /// Takes in the values at the corners of a part of a triangle.
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

    /// The texture of a map on a triangle, and the coordinates of its corners.
    pub(crate) fn texture(&self, map: &TextureMap, corners: Corners) -> Option<(&Texture, [DVec2; 3])> {
        if map.coordinates >= corners.sets {
            return None;
        }
        let coordinates =
            self.coordinates.get(corners.coordinates as usize + usize::from(map.coordinates))?;
        Some((self.textures.get(map.texture.index())?, coordinates.map(|c| c.as_dvec2())))
    }

    /// Colour and opacity that the corners give a triangle at a point.
    fn tint(&self, corners: Corners, point: Barycentric) -> Option<(Rgb, f64)> {
        let mixed = mix_tint(*self.tints.get(corners.tint as usize)?, point);
        Some((mixed.truncate().max(Rgb::ZERO), mixed.w.clamp(0.0, 1.0)))
    }

    fn opacity(&self, opacity: &Opacity, corners: Corners, point: Barycentric) -> f64 {
        let alpha = opacity.map.as_ref().and_then(|map| {
            let (texture, coordinates) = self.texture(map, corners)?;
            Some(texture.alpha_at(mix(coordinates, point), map.wrap))
        });
        let tint = self.tint(corners, point).filter(|_| opacity.cutoff.is_none());
        opacity.of_alpha(alpha.unwrap_or(1.0) * tint.map_or(1.0, |(_, alpha)| alpha))
    }
}

/// The coordinates at a point of a triangle.
fn mix(corners: [DVec2; 3], point: Barycentric) -> DVec2 {
    (1.0 - point.v - point.w) * corners[0] + point.v * corners[1] + point.w * corners[2]
}

/// The colour, and in the last place the opacity, at a point of a triangle.
fn mix_tint(corners: [Vec4; 3], point: Barycentric) -> DVec4 {
    let [a, b, c] = corners.map(|corner| corner.as_dvec4());
    (1.0 - point.v - point.w) * a + point.v * b + point.w * c
}

/// Which triangles of a scene let light through, and where. Does without the scene.
#[derive(Clone, Debug)]
pub struct Opacities {
    appearance: Arc<Appearance>,
    materials: Vec<Opacity>,
    /// The material of each triangle, if it is not opaque, and its corners.
    triangles: Vec<Option<(u32, Corners)>>,
}

impl Opacities {
    /// Those of a scene; `None` if all surfaces are opaque.
    #[must_use]
    pub fn of(scene: &Scene) -> Option<Self> {
        let see_through = |t: &Triangle| scene.is_open(t).then_some((t.material.0, t.corners));
        let triangles: Vec<_> = scene.triangles().iter().map(see_through).collect();
        triangles.iter().any(Option::is_some).then(|| Self {
            appearance: scene.appearance.clone(),
            materials: scene.materials().iter().map(|material| material.opacity).collect(),
            triangles,
        })
    }

    /// Which share of the light that meets a triangle at a point is stopped; `None` if the triangle is opaque.
    #[inline]
    #[must_use]
    pub fn at(&self, triangle: TriangleId, point: Barycentric) -> Option<f64> {
        let (material, corners) = self.triangles[triangle.index()]?;
        Some(self.appearance.opacity(&self.materials[material as usize], corners, point))
    }

    /// Memory in use, without the textures \[bytes\].
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.triangles.len() * size_of::<Option<(u32, Corners)>>()
    }
}

impl Scene {
    /// The textures, indexed by [`TextureId`](crate::TextureId).
    #[must_use]
    pub fn textures(&self) -> &[Texture] {
        &self.appearance.textures
    }

    /// The texture that a map of a material lays on a triangle, and its coordinates at the corners; `None` if the triangle
    /// has no such coordinates.
    #[must_use]
    pub fn texture_on(&self, id: TriangleId, map: &TextureMap) -> Option<(&Texture, [DVec2; 3])> {
        self.appearance.texture(map, self.triangle(id).corners)
    }

    /// Colour by which the reflectance of a triangle is multiplied at a point, and its opacity.
    #[must_use]
    pub fn tint_at(&self, id: TriangleId, point: Barycentric) -> Option<(Rgb, f64)> {
        self.appearance.tint(self.triangle(id).corners, point)
    }

    /// Whether reflectance, exitance or opacity of a triangle differ from those of its material, or differ from place to place.
    #[must_use]
    pub fn is_varied(&self, id: TriangleId) -> bool {
        !self.material(id).is_plain() || self.triangle(id).corners.tint != NONE
    }

    /// Reflectance of a triangle at a point, per band.
    #[must_use]
    pub fn reflectance_at(&self, id: TriangleId, point: Barycentric) -> Rgb {
        let material = self.material(id);
        let colour = material.reflectance_map.and_then(|ColourMap { map, factor }| {
            let (texture, corners) = self.texture_on(id, &map)?;
            Some(factor * texture.colour_at(mix(corners, point), map.wrap))
        });
        self.tinted(id, point, colour.unwrap_or(material.reflectance))
    }

    /// A reflectance, times the colour that the corners give the triangle at a point; at most [`MAX_REFLECTANCE`].
    #[must_use]
    pub fn tinted(&self, id: TriangleId, point: Barycentric, reflectance: Rgb) -> Rgb {
        let tint = self.tint_at(id, point).map_or(Rgb::ONE, |(tint, _)| tint);
        (tint * reflectance).min(Rgb::splat(MAX_REFLECTANCE))
    }

    /// Emitted exitance `M` \[W/m²\] of a side of a triangle at a point.
    #[must_use]
    pub fn exitance_at(&self, id: TriangleId, side: Side, point: Barycentric) -> Rgb {
        let mean = self.exitance(id, side);
        let colour = self.material(id).exitance_map.filter(|_| mean != Rgb::ZERO).and_then(|colour| {
            let (texture, corners) = self.texture_on(id, &colour.map)?;
            Some(colour.factor * texture.colour_at(mix(corners, point), colour.map.wrap))
        });
        colour.unwrap_or(mean)
    }

    /// Which share of the light that meets a triangle at a point is stopped.
    #[must_use]
    pub fn opacity_at(&self, id: TriangleId, point: Barycentric) -> f64 {
        self.appearance.opacity(&self.material(id).opacity, self.triangle(id).corners, point)
    }

    /// Whether light goes through some of a triangle.
    #[must_use]
    pub fn lets_light_through(&self, id: TriangleId) -> bool {
        self.is_open(self.triangle(id))
    }

    /// Memory in use by textures and by what triangles have at their corners \[bytes\].
    #[must_use]
    pub fn appearance_bytes(&self) -> usize {
        let Appearance { textures, coordinates, tints } = &*self.appearance;
        let texels: usize = textures.iter().map(|texture| size_of_val(texture.texels())).sum();
        texels + size_of_val(&coordinates[..]) + size_of_val(&tints[..])
    }

    /// Passes everything on that makes surfaces differ from place to place, for a number that tells scenes apart.
    pub fn hash_appearance(&self, number: &mut dyn FnMut(u64)) {
        let Appearance { textures, coordinates, tints } = &*self.appearance;
        for texture in textures {
            texture.size().iter().for_each(|&n| number(n.into()));
            texture.texels().iter().for_each(|&texel| number(u32::from_le_bytes(texel).into()));
        }
        coordinates.iter().flatten().flat_map(|c| c.to_array()).for_each(|x| number(x.to_bits().into()));
        tints.iter().flatten().flat_map(|c| c.to_array()).for_each(|x| number(x.to_bits().into()));
        for triangle in self.triangles.iter().filter(|triangle| triangle.corners != Corners::PLAIN) {
            let Corners { coordinates, sets, tint } = triangle.corners;
            [coordinates, sets.into(), tint].iter().for_each(|&n| number(n.into()));
        }
    }

    fn is_open(&self, triangle: &Triangle) -> bool {
        let Material { opacity, .. } = &self.materials[triangle.material.index()];
        let tint = self.appearance.tints.get(triangle.corners.tint as usize);
        !opacity.is_full()
            || opacity.cutoff.is_none() && tint.is_some_and(|tint| tint.iter().any(|corner| corner.w < 1.0))
    }
}
