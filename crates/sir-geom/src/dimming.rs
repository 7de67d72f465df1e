//! Dimmed copies of a scene: the same surfaces with lights of other strengths.

use crate::color::Rgb;
use crate::scene::Scene;
use sir_types::TriangleId;

/// Factors of all that emits in a scene, per band. Each is finite and not negative.
#[derive(Clone, Debug, PartialEq)]
pub struct Dimming {
    /// Factor of the exitance of each material.
    pub materials: Vec<Rgb>,
    /// Factor of each light.
    pub lights: Vec<Rgb>,
    /// Factor of the sky.
    pub sky: Rgb,
}

impl Dimming {
    /// Returns the same factor for all that emits in a scene.
    #[must_use]
    pub fn uniform(scene: &Scene, factor: Rgb) -> Self {
        Self {
            materials: vec![factor; scene.materials().len()],
            lights: vec![factor; scene.lights().len()],
            sky: factor,
        }
    }
}

impl Scene {
    /// Returns a copy whose lights are multiplied by factors. It shares the geometry. Lights with the factor zero are
    /// left out, and so is the sky. Factors of one change no bit.
    #[must_use]
    pub fn dimmed(&self, dimming: &Dimming) -> Self {
        let factor = |factors: &[Rgb], index: usize| factors.get(index).copied().unwrap_or(Rgb::ONE);
        let mut scene = self.clone();
        for (i, material) in scene.materials.iter_mut().enumerate() {
            let factor = factor(&dimming.materials, i);
            material.exitance *= factor;
            if let Some(map) = &mut material.exitance_map {
                map.factor *= factor;
            }
        }
        for (i, light) in scene.lights.iter_mut().enumerate() {
            light.kind.dim(factor(&dimming.lights, i));
        }
        let mut factors = (0..).map(|i| factor(&dimming.lights, i));
        scene.lights.retain(|_| factors.next() != Some(Rgb::ZERO));
        let sky = self.sky.as_ref().filter(|_| dimming.sky != Rgb::ZERO);
        scene.sky = sky.map(|sky| sky.dimmed(dimming.sky));
        let factors =
            (0..self.materials.len()).map(|i| factor(&self.dimming, i) * factor(&dimming.materials, i));
        scene.dimming = factors.collect();
        scene
    }

    /// Returns the factor by which the exitance of a triangle was multiplied since the scene was built.
    #[must_use]
    pub fn dimming(&self, id: TriangleId) -> Rgb {
        self.dimming.get(self.triangle(id).material.index()).copied().unwrap_or(Rgb::ONE)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::builder::SceneBuilder;
    use crate::light::{Light, LightKind};
    use crate::material::Material;
    use crate::sky::Sky;
    use glam::DVec3;
    use sir_types::Side;

    fn scene() -> Scene {
        let mut b = SceneBuilder::new();
        let lamp = b.add_material(Material::diffuse("lamp", Rgb::ZERO).emitting(Rgb::new(1.0, 2.0, 3.0)));
        let corners = [DVec3::ZERO, DVec3::X, DVec3::Y].map(|corner| b.add_vertex(corner));
        b.add_polygon(&corners, lamp);
        let kind = LightKind::Distant { direction: DVec3::Z, irradiance: Rgb::splat(5.0) };
        b.add_light(Light { name: "sun".into(), kind });
        b.set_sky(Sky::everywhere(Rgb::splat(7.0)).unwrap());
        b.build().unwrap().scene
    }

    #[test]
    fn factors_apply_to_all_that_emits() {
        let (scene, half) = (scene(), Rgb::new(0.5, 1.0, 0.0));
        let dimmed = scene.dimmed(&Dimming::uniform(&scene, half));
        assert_eq!(dimmed.exitance(TriangleId(0), Side::Front), Rgb::new(0.5, 2.0, 0.0));
        let kind = LightKind::Distant { direction: DVec3::Z, irradiance: Rgb::new(2.5, 5.0, 0.0) };
        assert_eq!(dimmed.lights()[0].kind, kind);
        let radiance = |scene: &Scene| scene.sky().unwrap().radiance(DVec3::Y);
        assert_eq!(radiance(&dimmed), radiance(&scene) * half);
        assert!(std::ptr::eq(dimmed.vertices(), scene.vertices()), "the geometry is shared");
        let twice = dimmed.dimmed(&Dimming::uniform(&scene, half));
        assert_eq!(twice.dimming(TriangleId(0)), half * half);
    }

    #[test]
    fn what_has_the_factor_zero_is_left_out() {
        let scene = scene();
        let dark = scene.dimmed(&Dimming::uniform(&scene, Rgb::ZERO));
        assert!(dark.lights().is_empty() && dark.sky().is_none() && !dark.emits(TriangleId(0)));
        let same = scene.dimmed(&Dimming::uniform(&scene, Rgb::ONE));
        assert_eq!((same.lights(), same.sky()), (scene.lights(), scene.sky()));
        assert_eq!(same.materials(), scene.materials());
    }
}
