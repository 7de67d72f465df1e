//! Fewer patches for scenes that would be too large for a page.

use sir_geom::{Barycentric, Rgb, Scene};
use sir_mesh::{PatchMesh, PatchSize, Subdivision};

/// Returns about this number of patches of a scene; `None` if the scene cannot be divided.
pub(crate) fn patches(scene: &Scene, count: usize) -> Option<PatchMesh> {
    PatchMesh::new(scene, Subdivision::Surfaces(PatchSize::Count(count as u64))).ok()
}

/// Returns the means of `values`, which belong to the sides of `fine`, over the sides of `coarse`. A part of a fine patch belongs
/// to the coarse patch in which its center lies.
pub(crate) fn means(scene: &Scene, fine: &PatchMesh, coarse: &PatchMesh, values: &[Rgb]) -> Vec<Rgb> {
    let mut sums = vec![(Rgb::ZERO, 0.0); coarse.side_count()];
    for t in scene.triangle_ids() {
        fine.for_each_piece_of(t, |patch, piece| {
            let corners = piece.corners();
            let mean =
                |of: fn(&Barycentric) -> f64| corners.iter().map(of).sum::<f64>() / corners.len() as f64;
            let center = Barycentric { v: mean(|p| p.v), w: mean(|p| p.w) };
            let area = scene.area(t) * piece.share();
            for &side in fine.sides_of(t) {
                let ids = (fine.side_of(t, patch, side), coarse.side_at(t, center, side));
                if let (Some(from), Some(to)) = ids {
                    let (sum, all) = &mut sums[to.index()];
                    *sum += area * values[from.index()];
                    *all += area;
                }
            }
        });
    }
    sums.into_iter().map(|(sum, area)| if area > 0.0 { sum / area } else { Rgb::ZERO }).collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a step that fails is a test that fails")]
mod tests {
    use glam::DVec3;
    use sir_geom::shapes::{Facing, cuboid};
    use sir_geom::{Material, SceneBuilder};

    use super::*;

    #[test]
    fn means_keep_the_power() {
        let mut builder = SceneBuilder::new();
        let gray = builder.add_material(Material::diffuse("gray", Rgb::splat(0.5)));
        cuboid(&mut builder, DVec3::ZERO, DVec3::ONE, [gray; 6], Facing::Inward);
        let scene = builder.build().unwrap().scene;
        let [fine, coarse] = [5000, 300].map(|count| patches(&scene, count).unwrap());
        let mut values = vec![Rgb::ZERO; fine.side_count()];
        fine.for_each_side(|t, patch, _, side| values[side.index()] = fine.center(&scene, t, patch));
        let means = means(&scene, &fine, &coarse, &values);
        let power = |mesh: &PatchMesh, values: &[Rgb]| {
            let mut sum = Rgb::ZERO;
            mesh.for_each_side(|t, patch, _, side| sum += mesh.patch_area(t, patch) * values[side.index()]);
            sum
        };
        let [before, after] = [power(&fine, &values), power(&coarse, &means)];
        assert!((before - after).length() < 1e-3 * before.length(), "{before} {after}");
        coarse.for_each_side(|t, patch, _, side| {
            let off = (means[side.index()] - coarse.center(&scene, t, patch)).length();
            assert!(off < 0.02, "a mean of positions is near the center: {off}");
        });
    }
}
