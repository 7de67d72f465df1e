//! Rooms whose surfaces vary from place to place, but whose light is known.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "test helpers may panic and print")]

mod common;

use common::{Estimate, TRANSPORTS, runs, scene, shoot_again};
use glam::{DVec3, Vec2};
use sir_geom::{ColorMap, Material, Rgb, SceneBuilder, Side, Texture, TextureMap, Wrap};
use sir_mesh::{PatchSize, Subdivision};
use sir_radiosity::{Emitter, Model, sources};

/// Bright and dark texels, and the 8-bit sRGB value closest to the linear value .2.
const DARK: [u8; 4] = [0, 0, 0, 255];
const WHITE: [u8; 4] = [255; 4];
const GRAY: [u8; 4] = [124, 124, 124, 255];

/// Returns an irregular pattern of two texels.
fn pattern([one, other]: [[u8; 4]; 2]) -> Texture {
    let texel = |i: u32| if i.wrapping_mul(2_654_435_761) >> 30 == 0 { one } else { other };
    Texture::new(13, 7, (0..91).map(texel).collect()).unwrap()
}

/// Returns a cube whose walls emit where they do not reflect: `M = 1 − ρ`, so that `B = E = 1` everywhere.
fn complementary_cube(subdivision: Subdivision) -> Model {
    let mut b = SceneBuilder::new();
    let gray = Texture::new(1, 1, vec![GRAY]).unwrap().mean_color().x;
    let reflectance = b.add_texture(pattern([WHITE, DARK]));
    let exitance = b.add_texture(pattern([GRAY, WHITE]));
    let map = |texture| TextureMap { texture, wrap: [Wrap::Repeat, Wrap::Mirror], coordinates: 0 };
    let material = b.add_material(Material {
        reflectance_map: Some(ColorMap { map: map(reflectance), factor: Rgb::splat(1.0 - gray) }),
        exitance_map: Some(ColorMap { map: map(exitance), factor: Rgb::ONE }),
        ..Material::diffuse("", Rgb::splat(0.5)).emitting(Rgb::splat(0.5))
    });
    for axis in 0..3 {
        let [x, y, z] = [0, 1, 2].map(|i| DVec3::AXES[(axis + i) % 3]);
        for (corner, edges) in [(DVec3::ZERO, [x, y]), (z, [y, x])] {
            let corners = [corner, corner + edges[0], corner + edges[0] + edges[1], corner + edges[1]];
            let v = corners.map(|p| b.add_vertex(p));
            let at = |i: usize| {
                Vec2::new(1.7 * (i / 2) as f32 + 0.3, if [0, 3].contains(&i) { -0.4 } else { 2.1 })
            };
            for [i, j, k] in [[0, 1, 2], [0, 2, 3]] {
                b.add_polygon(&[v[i], v[j], v[k]], material);
                b.set_corners(&[[at(i), at(j), at(k)]], None);
            }
        }
    }
    Model::new(scene(b), subdivision).unwrap()
}

#[test]
fn where_light_is_emitted_that_is_not_reflected_all_is_equally_bright() {
    let model = complementary_cube(Subdivision::Triangles(PatchSize::MaxArea(0.02)));
    let mut varied = Vec::new();
    model.mesh.for_each_side(|t, patch, _, _| varied.push(model.mesh.reflectance(&model.scene, t, patch).x));
    let (least, most) = varied.iter().fold((1.0, 0.0), |(a, b), &x| (f64::min(a, x), f64::max(b, x)));
    assert!(least < 0.05 && most > 0.4, "patches differ: {least} to {most}");
    for (way, transport) in TRANSPORTS {
        let runs = runs(&model, transport, 400_000, 16);
        for band in 0..3 {
            Estimate::of(runs.iter().map(|r| r[0][band])).assert_is(1.0, way);
        }
    }
}

#[test]
fn a_second_shot_sends_what_each_patch_reflects() {
    let model = complementary_cube(Subdivision::Triangles(PatchSize::MaxArea(0.02)));
    let runs: Vec<f64> = (1..=16)
        .map(|seed| {
            let shot = common::shoot(&model, 400_000, seed);
            let shot = shoot_again(&model, &shot, 100_000, seed);
            let run = common::batches(&model, shot, 400_000, seed);
            common::radiosities(&model, &run)[0].x
        })
        .collect();
    Estimate::of(runs).assert_is(1.0, "second shot");
}

#[test]
fn sources_are_patches_where_a_texture_emits() {
    let model = complementary_cube(Subdivision::Triangles(PatchSize::MaxArea(0.1)));
    let sources = sources(&model.scene, &model.mesh);
    assert!(sources.len() > 12 && sources.len() <= model.mesh.patch_count());
    for source in &sources {
        let Emitter::Surface { triangle, patch: Some(patch), side: Side::Front, .. } = source.emitter else {
            panic!("{source:?}")
        };
        let expected = model.exitance(triangle, patch, Side::Front) * model.mesh.patch_area(triangle, patch);
        assert!((source.power - expected).length() < 1e-12);
    }
    // Each wall shows the pattern 1.7 times across and 2.5 times along. The mean over triangles is therefore not the
    // mean of the image, but it equals the same integral over the whole wall.
    let coarse = complementary_cube(Subdivision::PerTriangle);
    let whole: Rgb = sir_radiosity::sources(&coarse.scene, &coarse.mesh).iter().map(|s| s.power).sum();
    let sum: Rgb = sources.iter().map(|s| s.power).sum();
    assert!((sum - whole).length() < 1e-6 * whole.length(), "{sum} {whole}");
}

#[test]
fn sensors_see_the_pattern() {
    let model = complementary_cube(Subdivision::Triangles(PatchSize::MaxArea(0.02)));
    let run = common::batches(&model, common::shoot(&model, 2_000_000, 1), 2_000_000, 1);
    let settings = sir_radiosity::SensorSettings::new(8192, 0.0);
    let solution = run.solution(&model);
    let sensors = sir_radiosity::Gatherer::new(&model, &solution, settings, 1);
    for (number, direction) in [DVec3::X, DVec3::new(1.0, -2.0, 0.5)].into_iter().enumerate() {
        let sensor = sir_radiosity::Sensor::new(DVec3::new(0.3, 0.6, 0.45), direction).unwrap();
        let measured = sensors.measure(number as u64, &sensor);
        println!("{measured:?}");
        let found = measured.irradiance;
        let error =
            (measured.sampling * measured.sampling + measured.inherited * measured.inherited).map(f64::sqrt);
        assert!((found - 1.0).abs().cmplt(4.0 * error + 1e-9).all(), "{found} ± {error}");
        assert!(error.max_element() < 0.01, "{error}");
    }
}
