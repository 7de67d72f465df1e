//! Mipmaps: textures filtered for distant views.
//!
//! A ray sees a point of a surface but represents a small area around it. Where this area holds many texels, their mean
//! is shown: that of the nearest smaller images (after Williams 1983, *Pyramidal Parametrics*), interpolated between
//! sizes.

use std::collections::HashMap;

use glam::DVec2;
use sir_geom::{Barycentric, ColorMap, Material, Rgb, Scene, Side, Texture, TextureId, TriangleId};

/// The smaller images of each texture that colors surfaces, down to a single texel. Together they use 1.4 bytes per
/// texel.
#[derive(Clone, Debug, Default)]
pub(super) struct Levels {
    smaller: HashMap<(TextureId, bool), Vec<Texture>>,
}

impl Levels {
    pub(super) fn of(scene: &Scene) -> Self {
        let mut smaller = HashMap::new();
        for material in scene.materials() {
            for ColorMap { map, .. } in
                [material.reflectance_map, material.exitance_map].into_iter().flatten()
            {
                let by_alpha = counts_by_alpha(material, &map);
                smaller.entry((map.texture, by_alpha)).or_insert_with(|| {
                    let mut levels: Vec<Texture> = Vec::new();
                    let texture = &scene.textures()[map.texture.index()];
                    loop {
                        let last = levels.last().unwrap_or(texture);
                        if last.size() == [1, 1] {
                            break levels;
                        }
                        let next = last.halved(by_alpha);
                        levels.push(next);
                    }
                });
            }
        }
        Self { smaller }
    }

    /// Returns the reflectance of a triangle around a point, averaged over a width \[m\].
    pub(super) fn reflectance(&self, scene: &Scene, t: TriangleId, point: Barycentric, width: f64) -> Rgb {
        let material = scene.material(t);
        let color = material.reflectance_map.and_then(|map| self.color(scene, t, &map, point, width));
        scene.tinted(t, point, color.unwrap_or(material.reflectance))
    }

    /// Returns the exitance \[W/m²\] of a side of a triangle around a point, likewise.
    pub(super) fn exitance(
        &self,
        scene: &Scene,
        t: TriangleId,
        side: Side,
        point: Barycentric,
        width: f64,
    ) -> Rgb {
        let mean = scene.exitance(t, side);
        let map = scene.material(t).exitance_map.filter(|_| mean != Rgb::ZERO);
        map.and_then(|map| self.color(scene, t, &map, point, width)).unwrap_or(mean)
    }

    fn color(
        &self,
        scene: &Scene,
        t: TriangleId,
        ColorMap { map, factor }: &ColorMap,
        point: Barycentric,
        width: f64,
    ) -> Option<Rgb> {
        let (texture, [a, b, c]) = scene.texture_on(t, map)?;
        let smaller = self.smaller.get(&(map.texture, counts_by_alpha(scene.material(t), map)))?;
        let place = a + point.v * (b - a) + point.w * (c - a);
        let texels = DVec2::from(texture.size().map(f64::from)).element_product();
        // Texels per square meter.
        let density = texels * (b - a).perp_dot(c - a).abs() / (2.0 * scene.area(t));
        // A width of one texel is looked up in the texture itself, one of two texels in the first smaller image.
        let level = (width * density.sqrt()).log2().clamp(0.0, smaller.len() as f64);
        let of_level = |level: usize| {
            let image = level.checked_sub(1).map_or(texture, |level| &smaller[level]);
            image.color_at(place, map.wrap)
        };
        let (whole, part) = (level as usize, level.fract());
        let below = of_level(whole);
        Some(*factor * if part > 0.0 { below.lerp(of_level(whole + 1), part) } else { below })
    }
}

/// Returns true if texels are weighted by their opacity. This is so if the image is also the opacity map: the colors in
/// its gaps belong to no surface.
fn counts_by_alpha(material: &Material, map: &sir_geom::TextureMap) -> bool {
    material.opacity.map.as_ref() == Some(map)
}
