//! Properties of surfaces as functions of the position on a triangle.

use std::sync::Arc;

use glam::DVec2;

use crate::appearance::{Appearance, Corners, NO_TINT, mix};
use crate::color::Rgb;
use crate::material::{MAX_REFLECTANCE, Material, Opacity};
use crate::scene::{Scene, Triangle};
use crate::texture::{ColorMap, Texture, TextureMap};
use sir_types::{Barycentric, Side, TriangleId};

/// Opacities of the triangles of a scene, usable without the scene.
#[derive(Clone, Debug)]
pub struct Opacities {
    appearance: Arc<Appearance>,
    materials: Vec<Opacity>,
    /// Material and corner values of each triangle; `None` if it is opaque.
    triangles: Vec<Option<(u32, Corners)>>,
}

impl Opacities {
    /// Returns the opacities of a scene; `None` if all surfaces are opaque.
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

    /// Returns the opacity of a triangle at a point, the share of the light that it stops; `None` if the triangle is
    /// opaque.
    #[inline]
    #[must_use]
    pub fn at(&self, triangle: TriangleId, point: Barycentric) -> Option<f64> {
        let (material, corners) = self.triangles[triangle.index()]?;
        Some(self.appearance.opacity(&self.materials[material as usize], corners, point))
    }

    /// Returns the memory in use, without the textures \[bytes\].
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.triangles.len() * size_of::<Option<(u32, Corners)>>()
    }
}

impl Scene {
    /// Returns the textures, indexed by [`TextureId`](crate::TextureId).
    #[must_use]
    pub fn textures(&self) -> &[Texture] {
        &self.appearance.textures
    }

    /// Returns the texture of a map on a triangle, and its coordinates at the corners; `None` if the triangle lacks the
    /// coordinate set.
    #[must_use]
    pub fn texture_on(&self, id: TriangleId, map: &TextureMap) -> Option<(&Texture, [DVec2; 3])> {
        self.appearance.texture(map, self.triangle(id).corners)
    }

    /// Returns the tint of a triangle at a point: the factor of its reflectance, and its opacity; `None` without a
    /// tint.
    #[must_use]
    pub fn tint_at(&self, id: TriangleId, point: Barycentric) -> Option<(Rgb, f64)> {
        self.appearance.tint(self.triangle(id).corners, point)
    }

    /// Returns true if reflectance, exitance or opacity of a triangle vary, or differ from those of its material.
    #[must_use]
    pub fn is_varied(&self, id: TriangleId) -> bool {
        !self.material(id).is_plain() || self.triangle(id).corners.tint != NO_TINT
    }

    /// Returns the reflectance of a triangle at a point, per band.
    #[must_use]
    pub fn reflectance_at(&self, id: TriangleId, point: Barycentric) -> Rgb {
        let material = self.material(id);
        let color = material.reflectance_map.and_then(|ColorMap { map, factor }| {
            let (texture, corners) = self.texture_on(id, &map)?;
            Some(factor * texture.color_at(mix(corners, point), map.wrap))
        });
        self.tinted(id, point, color.unwrap_or(material.reflectance))
    }

    /// Returns a reflectance times the tint of the triangle at a point, at most [`MAX_REFLECTANCE`].
    #[must_use]
    pub fn tinted(&self, id: TriangleId, point: Barycentric, reflectance: Rgb) -> Rgb {
        let tint = self.tint_at(id, point).map_or(Rgb::ONE, |(tint, _)| tint);
        (tint * reflectance).min(Rgb::splat(MAX_REFLECTANCE))
    }

    /// Returns the emitted exitance `M` \[W/m²\] of a side of a triangle at a point.
    #[must_use]
    pub fn exitance_at(&self, id: TriangleId, side: Side, point: Barycentric) -> Rgb {
        let mean = self.exitance(id, side);
        let color = self.material(id).exitance_map.filter(|_| mean != Rgb::ZERO).and_then(|color| {
            let (texture, corners) = self.texture_on(id, &color.map)?;
            Some(color.factor * texture.color_at(mix(corners, point), color.map.wrap))
        });
        color.unwrap_or(mean)
    }

    /// Returns the opacity of a triangle at a point: the share of the light that it stops.
    #[must_use]
    pub fn opacity_at(&self, id: TriangleId, point: Barycentric) -> f64 {
        self.appearance.opacity(&self.material(id).opacity, self.triangle(id).corners, point)
    }

    /// Returns true if light can pass through a triangle.
    #[must_use]
    pub fn is_transparent(&self, id: TriangleId) -> bool {
        self.is_open(self.triangle(id))
    }

    /// Returns the memory in use by textures and corner values \[bytes\].
    #[must_use]
    pub fn appearance_bytes(&self) -> usize {
        let Appearance { textures, coordinates, tints } = &*self.appearance;
        let texels: usize = textures.iter().map(|texture| size_of_val(texture.texels())).sum();
        texels + size_of_val(&coordinates[..]) + size_of_val(&tints[..])
    }

    /// Passes all textures and corner values to `number`, for a hash that identifies the scene.
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
