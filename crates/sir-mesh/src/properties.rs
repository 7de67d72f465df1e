//! Reflectance, exitance and coverage of the patches of textured triangles: means over the area of each patch.

use std::collections::{HashMap, HashSet};

use sir_geom::{
    Barycentric, ColorMap, Material, Opacities, Opacity, Rgb, Scene, TextureId, TextureMap, TextureMean,
    TextureSums, TriangleId, Wrap,
};

use crate::numbering::Numbering;
use crate::piece::Piece;

/// Properties of the patches of varied triangles, whose patches differ. Uses 4 bytes per triangle of a scene that has
/// varied triangles, and 12 to 28 bytes per patch of such a triangle.
#[derive(Clone, Debug, Default)]
pub(crate) struct Properties {
    /// Index of the first patch of each triangle in the lists below, or [`PLAIN`]; empty if all triangles are plain.
    first: Vec<u32>,
    reflectance: Vec<[f32; 3]>,
    /// Empty if no texture emits.
    exitance: Vec<[f32; 3]>,
    /// Covered share of the patch, which stops light; empty if all surfaces are opaque.
    coverage: Vec<f32>,
}

/// Index that marks triangles whose properties are those of the material.
const PLAIN: u32 = u32::MAX;

impl Properties {
    /// Returns the index in the lists of the `within`-th patch of a triangle.
    #[inline]
    fn place(&self, triangle: TriangleId, within: u32) -> Option<usize> {
        let first = *self.first.get(triangle.index())?;
        (first != PLAIN).then(|| (first + within) as usize)
    }

    #[inline]
    pub(crate) fn reflectance(&self, triangle: TriangleId, within: u32) -> Option<Rgb> {
        let place = self.place(triangle, within)?;
        self.reflectance.get(place).map(|rgb| Rgb::from_array(rgb.map(f64::from)))
    }

    #[inline]
    pub(crate) fn exitance(&self, triangle: TriangleId, within: u32) -> Option<Rgb> {
        let place = self.place(triangle, within)?;
        self.exitance.get(place).map(|rgb| Rgb::from_array(rgb.map(f64::from)))
    }

    #[inline]
    pub(crate) fn coverage(&self, triangle: TriangleId, within: u32) -> f64 {
        let place = self.place(triangle, within);
        place.and_then(|place| self.coverage.get(place)).map_or(1.0, |&share| f64::from(share))
    }

    /// Returns true if patches of a triangle may differ from each other.
    pub(crate) fn is_varied(&self, triangle: TriangleId) -> bool {
        self.place(triangle, 0).is_some()
    }

    /// Returns the largest reflectance in any band.
    pub(crate) fn max_reflectance(&self) -> f64 {
        self.reflectance.iter().flatten().fold(0.0, |most, &band| most.max(f64::from(band)))
    }

    /// Returns the memory in use \[bytes\].
    pub(crate) fn bytes(&self) -> usize {
        size_of_val(&self.first[..])
            + size_of_val(&self.reflectance[..])
            + size_of_val(&self.exitance[..])
            + size_of_val(&self.coverage[..])
    }

    /// Computes the means over all patches of varied triangles.
    pub(crate) fn new(scene: &Scene, numbering: &Numbering) -> Self {
        let varied: Vec<TriangleId> = scene.triangle_ids().filter(|&t| scene.is_varied(t)).collect();
        if varied.is_empty() {
            return Self::default();
        }
        let is_varied: HashSet<u32> = varied.iter().map(|&t| numbering.first_patch(t)).collect();
        let mut totals: Vec<Total> = Vec::new();
        // All triangles of a surface share its patches.
        let mut starts = HashMap::new();
        for &(t, count) in
            numbering.surfaces.iter().filter(|s| is_varied.contains(&numbering.first_patch(s.0)))
        {
            starts.insert(numbering.first_patch(t), totals.len() as u32);
            totals.resize(totals.len() + count as usize, Total::default());
        }
        let mut first = vec![PLAIN; scene.triangles().len()];
        let mut images = Images { scene, sums: HashMap::new() };
        for t in scene.triangle_ids() {
            let first_patch = numbering.first_patch(t);
            let Some(&start) = starts.get(&first_patch) else { continue };
            first[t.index()] = start;
            let area = scene.area(t);
            numbering.for_each_piece_of(t, |patch, piece| {
                let total = &mut totals[(start + patch.0 - first_patch) as usize];
                total.add(area * piece.share(), &images.mean(t, &piece));
            });
        }
        let emits = varied.iter().any(|&t| scene.material(t).exitance_map.is_some());
        let gaps = Opacities::of(scene).is_some();
        let colors = |is_needed: bool, of: fn(&Total) -> Rgb| {
            let needed = if is_needed { &totals[..] } else { &[] };
            needed.iter().map(|total| of(total).as_vec3().to_array()).collect()
        };
        let shares = totals.iter().map(|t| (t.covered / t.area) as f32);
        Self {
            first,
            reflectance: colors(true, |t| t.of_covered(t.reflected, t.last.reflectance)),
            exitance: colors(emits, |t| t.of_covered(t.emitted, t.last.exitance)),
            coverage: if gaps { shares.collect() } else { Vec::new() },
        }
    }
}

/// Sums over the triangles of a patch.
#[derive(Clone, Default)]
struct Total {
    area: f64,
    covered: f64,
    /// Reflectance times covered area.
    reflected: Rgb,
    /// Exitance times covered area.
    emitted: Rgb,
    /// Mean of the last triangle, which stands in if nothing is covered.
    last: Mean,
}

impl Total {
    fn add(&mut self, area: f64, mean: &Mean) {
        self.area += area;
        self.covered += area * mean.coverage;
        self.reflected += area * mean.coverage * mean.reflectance;
        self.emitted += area * mean.coverage * mean.exitance;
        self.last = mean.clone();
    }

    /// Returns the mean over the covered area; `fallback` if nothing is covered.
    fn of_covered(&self, sum: Rgb, fallback: Rgb) -> Rgb {
        if self.covered > 0.0 { sum / self.covered } else { fallback }
    }
}

/// Mean properties of a part of a triangle.
#[derive(Clone, Default)]
struct Mean {
    reflectance: Rgb,
    /// Exitance of a side that emits.
    exitance: Rgb,
    coverage: f64,
}

/// Textures of a scene with their sums, which are computed when first needed.
struct Images<'a> {
    scene: &'a Scene,
    sums: HashMap<Key, TextureSums<'a>>,
}

/// Texture, wrap modes and, if texels are weighted by their opacity, its factor and cutoff.
type Key = (TextureId, [Wrap; 2], Option<[u64; 2]>);

impl Images<'_> {
    /// Returns the means over a piece of a triangle.
    fn mean(&mut self, t: TriangleId, piece: &Piece) -> Mean {
        let mut triangles = piece.triangles();
        if let (Some(only), 3) = (triangles.next(), piece.corners().len()) {
            return self.mean_between(t, only);
        }
        let mut total = Total::default();
        piece
            .triangles()
            .for_each(|corners| total.add(Piece::new(t, &corners).share(), &self.mean_between(t, corners)));
        Mean {
            reflectance: total.of_covered(total.reflected, total.last.reflectance),
            exitance: total.of_covered(total.emitted, total.last.exitance),
            coverage: total.covered / total.area,
        }
    }

    /// Returns the means over the part of a triangle between three points.
    fn mean_between(&mut self, t: TriangleId, corners: [Barycentric; 3]) -> Mean {
        let Material { reflectance, reflectance_map, exitance, exitance_map, opacity, .. } =
            *self.scene.material(t);
        let sum = |part: fn(Barycentric) -> f64| corners.iter().map(|&c| part(c)).sum::<f64>() / 3.0;
        let middle = Barycentric { v: sum(|c| c.v), w: sum(|c| c.w) };
        let coverage = match opacity.map.and_then(|map| self.over(t, &map, Some(&opacity), corners)) {
            Some(mean) => {
                // With a cutoff, the alpha of corners is ignored.
                let tint = self.scene.tint_at(t, middle).filter(|_| opacity.cutoff.is_none());
                mean.weight * tint.map_or(1.0, |(_, alpha)| alpha)
            }
            None => self.scene.opacity_at(t, middle),
        };
        let mut color = |map: Option<ColorMap>, plain: Rgb| {
            let Some(ColorMap { map, factor }) = map else { return plain };
            let weight = Some(&opacity).filter(|opacity| opacity.map == Some(map));
            self.over(t, &map, weight, corners).map_or(plain, |mean| factor * mean.color)
        };
        let (reflectance, exitance) = (color(reflectance_map, reflectance), color(exitance_map, exitance));
        Mean { reflectance: self.scene.tinted(t, middle, reflectance), exitance, coverage }
    }

    /// Returns the mean of a texture, with texels weighted by their opacity if one is given.
    fn over(
        &mut self,
        t: TriangleId,
        map: &TextureMap,
        weight: Option<&Opacity>,
        corners: [Barycentric; 3],
    ) -> Option<TextureMean> {
        let (texture, [a, b, c]) = self.scene.texture_on(t, map)?;
        let opacity = weight.map(|o| [o.factor, o.cutoff.unwrap_or(-1.0)].map(f64::to_bits));
        let key = (map.texture, map.wrap, opacity);
        let sums = self.sums.entry(key).or_insert_with(|| {
            TextureSums::new(texture, map.wrap, |alpha| weight.map_or(1.0, |opacity| opacity.of_alpha(alpha)))
        });
        let at = |p: Barycentric| a + p.v * (b - a) + p.w * (c - a);
        Some(sums.mean(corners.map(at)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::index::PatchId;
    use crate::mesh::PatchMesh;
    use crate::subdivision::{PatchSize, Subdivision};
    use glam::{DVec3, Vec2, Vec4};
    use sir_geom::{SceneBuilder, Side, Sides, Texture};

    const RED: Rgb = Rgb::X;
    const GREEN: Rgb = Rgb::Y;

    /// Returns a square of side 2, in two triangles, with an image of a red and an almost transparent green half.
    fn square(opacity: Opacity, tint: Option<[Vec4; 3]>) -> Scene {
        let mut b = SceneBuilder::new();
        let texture = b.add_texture(Texture::new(2, 1, vec![[255, 0, 0, 255], [0, 255, 0, 51]]).unwrap());
        let map = TextureMap { texture, wrap: [Wrap::Clamp; 2], coordinates: 0 };
        let color = Some(ColorMap { map, factor: Rgb::splat(0.5) });
        let material = b.add_material(Material {
            reflectance_map: color,
            exitance_map: color,
            opacity: Opacity { map: opacity.map.or(Some(map)), ..opacity },
            sides: Sides::Both,
            ..Material::diffuse("", Rgb::splat(0.25)).emitting(Rgb::splat(0.25))
        });
        let places = [Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y];
        let v = places.map(|p| b.add_vertex(2.0 * DVec3::new(p.x.into(), p.y.into(), 0.0)));
        for [i, j, k] in [[0, 1, 2], [0, 2, 3]] {
            b.add_polygon(&[v[i], v[j], v[k]], material);
            b.set_corners(&[[places[i], places[j], places[k]]], tint);
        }
        b.build().unwrap().scene
    }

    fn close(a: Rgb, b: Rgb) -> bool {
        (a - b).length() < 1e-6
    }

    #[test]
    fn patches_have_the_mean_of_what_covers_them() {
        let scene = square(Opacity::default(), None);
        let mesh = PatchMesh::new(&scene, Subdivision::PerTriangle).unwrap();
        // Of the lower triangle (0, 0), (1, 0), (1, 1) a quarter lies in the red half.
        let (triangle, patch) = (TriangleId(0), PatchId(0));
        let covered = 0.25 + 0.75 * 0.2;
        assert!((mesh.covered_area(triangle, patch) - 2.0 * covered).abs() < 1e-6);
        let mean = (0.25 * RED + 0.75 * 0.2 * GREEN) / covered;
        assert!(close(mesh.reflectance(&scene, triangle, patch), 0.5 * mean));
        assert!(close(mesh.exitance(&scene, triangle, patch, Side::Front), 0.5 * mean));
        assert_eq!(mesh.exitance(&scene, triangle, patch, Side::Back), Rgb::ZERO, "its back does not emit");
        let sum: f64 = scene.triangle_ids().map(|t| mesh.covered_area_of(&scene, t)).sum();
        assert!((sum - 4.0 * 0.6).abs() < 1e-6);
    }

    #[test]
    fn finer_patches_have_the_same_sum() {
        let scene = square(Opacity::default(), None);
        for n in [1, 2, 3, 10, 57] {
            let mesh = PatchMesh::new(&scene, Subdivision::Triangles(PatchSize::Count(2 * n * n))).unwrap();
            let mut sum = Rgb::ZERO;
            mesh.for_each_side(|t, patch, side, id| {
                assert_eq!(mesh.patch_of_side(t, id), patch);
                if side == Side::Front {
                    sum += mesh.covered_area(t, patch) * mesh.reflectance(&scene, t, patch);
                }
            });
            assert!((sum - (RED + 0.2 * GREEN)).length() < 1e-5, "{n}: {sum}");
        }
    }

    #[test]
    fn a_cutoff_leaves_out_what_is_below_it() {
        for (cutoff, covered, reflected) in [(0.2, 4.0, RED + GREEN), (0.21, 2.0, RED), (1.5, 0.0, Rgb::ZERO)]
        {
            let scene = square(Opacity { cutoff: Some(cutoff), ..Opacity::default() }, None);
            let mesh = PatchMesh::new(&scene, Subdivision::PerFace).unwrap();
            let of = |t: TriangleId| {
                let patch = mesh.patch_at(t, Barycentric { v: 0.0, w: 0.0 });
                mesh.covered_area(t, patch) * mesh.reflectance(&scene, t, patch)
            };
            let areas: f64 = scene.triangle_ids().map(|t| mesh.covered_area_of(&scene, t)).sum();
            assert!((areas - covered).abs() < 1e-6, "{cutoff}: {areas}");
            assert!((scene.triangle_ids().map(of).sum::<Rgb>() - reflected).length() < 1e-6);
        }
    }

    #[test]
    fn corners_tint_what_lies_between_them() {
        // White in the first corner of each triangle, opaque; black and clear in the others.
        let tint = Some([Vec4::ONE, Vec4::ZERO, Vec4::ZERO]);
        let scene = square(Opacity::default(), tint);
        let mesh = PatchMesh::new(&scene, Subdivision::PerTriangle).unwrap();
        let untinted = PatchMesh::new(&square(Opacity::default(), None), Subdivision::PerTriangle).unwrap();
        for t in scene.triangle_ids() {
            let patch = PatchId(t.0);
            let third = untinted.reflectance(&scene, t, patch) / 3.0;
            assert!(close(mesh.reflectance(&scene, t, patch), third));
            assert!((3.0 * mesh.covered_area(t, patch) - untinted.covered_area(t, patch)).abs() < 1e-6);
        }
    }

    #[test]
    fn plain_scenes_need_no_memory() {
        let mut b = SceneBuilder::new();
        let m = b.add_material(Material::diffuse("m", Rgb::splat(0.5)));
        let v = [DVec3::ZERO, DVec3::X, DVec3::Y].map(|p| b.add_vertex(p));
        b.add_polygon(&v, m);
        let scene = b.build().unwrap().scene;
        let mesh = PatchMesh::new(&scene, Subdivision::Triangles(PatchSize::Count(100))).unwrap();
        assert!(!mesh.is_varied(TriangleId(0)) && mesh.paint_bytes() == 0);
    }
}
