//! Layouts: charts, pages, and what does not fit.

use std::collections::BTreeMap;

use glam::DVec2;
use sir_geom::shapes::{self, Facing};
use sir_geom::{Material, Rgb, Scene, SceneBuilder, Side};
use sir_lightmap::{Lightmap, LightmapOptions};
use sir_mesh::{PatchMesh, Subdivision};

use crate::scenes::{bake, light, options, patches, room};

/// Returns true if a triangle and the inside of a texel have a point in common.
fn overlap([a, b, c]: [DVec2; 3], texel: DVec2) -> bool {
    let square = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y].map(|p| texel + p);
    let apart = |axis: DVec2| {
        let range = |points: &[DVec2]| {
            points.iter().map(|p| p.dot(axis)).fold((f64::MAX, f64::MIN), |(l, h), x| (l.min(x), h.max(x)))
        };
        let (t, s) = (range(&[a, b, c]), range(&square));
        t.1 <= s.0 + 1e-6 || s.1 <= t.0 + 1e-6
    };
    let edges = [b - a, c - b, a - c].map(DVec2::perp);
    ![DVec2::X, DVec2::Y].iter().chain(&edges).any(|&axis| apart(axis))
}

/// Checks that no two triangles share a texel unless they touch on the surface, and returns the number of texels.
fn check_texels(scene: &Scene, lightmap: &Lightmap<'_>) -> usize {
    let mut owners: BTreeMap<(u32, i64, i64), Vec<(sir_geom::TriangleId, Side)>> = BTreeMap::new();
    for t in scene.triangle_ids() {
        for side in [Side::Front, Side::Back] {
            let Some((page, corners)) = lightmap.place(t, side) else { continue };
            let low = corners.iter().copied().fold(DVec2::MAX, DVec2::min).floor();
            let high = corners.iter().copied().fold(DVec2::MIN, DVec2::max).ceil();
            for y in low.y as i64..high.y as i64 {
                for x in low.x as i64..high.x as i64 {
                    if overlap(corners, DVec2::new(x as f64, y as f64)) {
                        owners.entry((page, x, y)).or_default().push((t, side));
                    }
                }
            }
        }
    }
    for (texel, all) in &owners {
        let (t, side) = all[0];
        for &(other, other_side) in &all[1..] {
            // Triangles of one chart in one texel are near each other and face the same way.
            let distance = (scene.corners(t)[0] - scene.corners(other)[0]).length();
            let cosine = scene.normal(t).dot(scene.normal(other));
            assert!(side == other_side && cosine > 0.3 && distance < 6.0, "{texel:?}: {t:?} and {other:?}");
        }
    }
    owners.len()
}

#[test]
fn charts_share_no_texels() {
    let scene = room();
    let mesh = patches(&scene, 500, true);
    let light = light(&mesh);
    for size in [128, 500] {
        let lightmap = bake(&scene, &mesh, &light, &light, options(size)).unwrap();
        let texels = check_texels(&scene, &lightmap);
        assert!(texels > (size * size / 4) as usize);
        let ([width, height], pages) = lightmap.size();
        assert!(width <= size && height <= size && pages == 1);
    }
}

/// Returns eight cubes of 1 m, each a mesh of its own.
fn cubes() -> Scene {
    let mut b = SceneBuilder::new();
    let gray = b.add_material(Material::diffuse("gray", Rgb::splat(0.5)));
    for i in 0..8u8 {
        b.begin_group(&format!("cube {i}"));
        let low = glam::DVec3::new(2.0 * f64::from(i), 0.0, 0.0);
        shapes::cuboid(&mut b, low, low + 1.0, [gray; 6], Facing::Outward);
    }
    b.build().unwrap().scene
}

#[test]
fn a_density_takes_as_many_pages_as_it_needs() {
    let scene = cubes();
    let mesh = patches(&scene, 500, true);
    let light = light(&mesh);
    let with = |size, texels| {
        let options = LightmapOptions { texels_per_meter: Some(texels), ..options(size) };
        bake(&scene, &mesh, &light, &light, options)
    };
    for (size, pages) in [(512, 1..=1), (260, 2..=8)] {
        let lightmap = with(size, 50.0).unwrap();
        assert!(pages.contains(&lightmap.size().1), "{:?}", lightmap.size());
        assert!((lightmap.texels_per_meter() - 50.0).abs() < 1e-3);
        check_texels(&scene, &lightmap);
        // An edge of a cube is 1 m long.
        let (_, [a, b, c]) = lightmap.place(sir_geom::TriangleId(0), Side::Front).unwrap();
        let mut lengths = [a.distance(b), b.distance(c), c.distance(a)];
        lengths.sort_by(f64::total_cmp);
        assert!((lengths[1] - 50.0).abs() < 1e-2, "{lengths:?}");
    }
    let grown = with(100, 50.0).unwrap();
    assert!(grown.notes()[0].contains("one mesh needs"), "{:?}", grown.notes());
    assert!((grown.texels_per_meter() - 50.0).abs() < 1e-3);
    let error = with(100, 50_000.0).err().unwrap().to_string();
    assert!(error.contains("texels") && error.contains("or a smaller `texels_per_meter`"), "{error}");
}

#[test]
fn pages_share_the_meshes() {
    let scene = cubes();
    let mesh = patches(&scene, 500, true);
    let light = light(&mesh);
    let with =
        |pages| bake(&scene, &mesh, &light, &light, LightmapOptions { pages, ..options(256) }).unwrap();
    let (one, four) = (with(1), with(4));
    assert!(four.size().1 == 4, "{:?}", four.size());
    assert!(four.texels_per_meter() > 1.6 * one.texels_per_meter(), "{}", four.texels_per_meter());
    check_texels(&scene, &four);
}

/// Returns triangles that do not touch each other.
fn loose(count: u32) -> Scene {
    let mut b = SceneBuilder::new();
    let gray = b.add_material(Material::diffuse("gray", Rgb::splat(0.5)));
    for i in 0..count {
        let at = glam::DVec3::new(f64::from(i % 100), f64::from(i / 100), 0.0);
        let corners =
            [[0.0, 0.0], [0.5, 0.0], [0.0, 0.5]].map(|[x, y]| b.add_vertex(at + glam::DVec3::new(x, y, 0.0)));
        b.add_polygon(&corners, gray);
    }
    b.build().unwrap().scene
}

#[test]
fn a_page_that_is_too_small_grows_and_says_so() {
    let scene = loose(5_000);
    let mesh = PatchMesh::new(&scene, Subdivision::PerTriangle).unwrap();
    let light = light(&mesh);
    let lightmap = bake(&scene, &mesh, &light, &light, options(128)).unwrap();
    let note = &lightmap.notes()[0];
    assert!(note.contains("the 5,000 charts") && note.contains("do not fit a page of 128"), "{note}");
    let used: u32 = note.split("pages of ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
    assert!(used > 128 && lightmap.size().0[0] <= used, "{note}");
    assert_eq!(lightmap.charts(), 5_000);
}

#[test]
fn surfaces_without_light_take_hardly_any_texels() {
    let scene = room();
    let mesh = patches(&scene, 500, true);
    let mut light = light(&mesh);
    let errors = vec![Rgb::ZERO; light.len()];
    let all = bake(&scene, &mesh, &light, &errors, options(256)).unwrap().texels_per_meter();
    // The walls are dark.
    mesh.for_each_side(|t, _, _, id| {
        if scene.groups()[scene.triangle(t).group.index()] == "room" {
            light[id.index()] = Rgb::ZERO;
        }
    });
    let lightmap = bake(&scene, &mesh, &light, &errors, options(256)).unwrap();
    assert!(lightmap.texels_per_meter() > 2.5 * all, "{} {all}", lightmap.texels_per_meter());
    let (page, corners) = lightmap.place(sir_geom::TriangleId(0), Side::Front).unwrap();
    assert!(page == 0 && corners[0].distance(corners[1]) < 10.0);
}
