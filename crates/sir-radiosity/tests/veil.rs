//! Light that passes through gaps in surfaces.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "test helpers may panic and print")]

mod common;

use common::{Estimate, TRANSPORTS, gray, scene, shoot};
use glam::{DVec3, Vec2};
use sir_geom::shapes::{self, Facing};
use sir_geom::{Material, MaterialId, Opacity, Rgb, SceneBuilder, Sides, Texture, TextureMap, Wrap};
use sir_mesh::{PatchSize, Subdivision};
use sir_radiosity::Model;

/// Adds a rectangle across the x axis with texture coordinates from 0 to 1.
fn across(b: &mut SceneBuilder, x: f64, material: MaterialId) {
    let corners = [(0.1, 0.0), (0.9, 0.0), (0.9, 0.8), (0.1, 0.8)];
    let v = corners.map(|(y, z)| b.add_vertex(DVec3::new(x, y, z)));
    let places = [Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y];
    for [i, j, k] in [[0, 1, 2], [0, 2, 3]] {
        b.add_polygon(&[v[i], v[j], v[k]], material);
        b.set_corners(&[[places[i], places[j], places[k]]], None);
    }
}

/// A closed room in which everything emits and reflects equally, including three partitions: two let 40 % of the light
/// pass, one of these with an irregular mask, and the third has no covered area. All covered area has the radiosity
/// `M / (1 − ρ)`. A partition that stopped more or fewer lines than its covered area implies would be brighter or
/// darker.
#[test]
fn a_furnace_with_partitions_that_have_gaps() {
    let (m, rho) = (1.0, 0.6);
    let mut b = SceneBuilder::new();
    let walls = b.add_material(gray(m, rho));
    shapes::cuboid(&mut b, DVec3::ZERO, DVec3::new(2.0, 1.0, 1.0), [walls; 6], Facing::Inward);
    // Two texels in five are open.
    let texel = |i: u32| [0, 0, 0, if i.wrapping_mul(7) % 5 < 2 { 20 } else { 240 }];
    let texture = b.add_texture(Texture::new(8, 5, (0..40).map(texel).collect()).unwrap());
    let map = TextureMap { texture, wrap: [Wrap::Clamp; 2], coordinates: 0 };
    let opacities = [
        Opacity { factor: 1.0, map: Some(map), cutoff: Some(0.5) },
        Opacity { factor: 0.6, ..Opacity::default() },
        Opacity { factor: 0.0, ..Opacity::default() },
    ];
    for (opacity, x) in opacities.into_iter().zip([0.5, 1.1, 1.5]) {
        let both = gray(m, rho).with_sides(Sides::Both);
        let material = b.add_material(Material { opacity, back_emits: true, ..both });
        across(&mut b, x, material);
    }
    let model = Model::new(scene(b), Subdivision::Triangles(PatchSize::MaxArea(0.05))).unwrap();
    for (way, transport) in TRANSPORTS {
        let runs: Vec<Vec<f64>> = (1..=16)
            .map(|seed| {
                let run = transport(&model, shoot(&model, 300_000, seed), 300_000, seed);
                let solution = run.solution(&model);
                // Walls, and both sides of the partitions with covered area.
                let (mut sums, mut areas) = ([0.0; 5], [0.0; 5]);
                model.mesh.for_each_side(|t, patch, side, id| {
                    let material = model.scene.triangle(t).material.index();
                    let area = model.mesh.covered_area(t, patch);
                    if material == 3 {
                        assert_eq!((area, solution.irradiance[id.index()]), (0.0, Rgb::ZERO));
                        return;
                    }
                    let place = 2 * material - material.min(1) + usize::from(side == sir_geom::Side::Back);
                    sums[place] += area * solution.irradiance[id.index()].x;
                    areas[place] += area;
                });
                assert!(
                    (areas[1] / 0.64 - 0.6).abs() < 1e-6 && (areas[3] / 0.64 - 0.6).abs() < 1e-6,
                    "{areas:?}"
                );
                (0..5).map(|i| m + rho * sums[i] / areas[i]).collect()
            })
            .collect();
        for (place, name) in ["walls", "mask", "mask's back", "veil", "veil's back"].into_iter().enumerate() {
            let found = Estimate::of(runs.iter().map(|run| run[place]));
            found.assert_is(m / (1.0 - rho), &format!("{way}, {name}"));
        }
    }
}

/// A veil between two squares lets its share of the light between them pass, within five standard deviations for
/// 400,000 lines.
#[test]
fn a_veil_dims_what_is_behind_it() {
    const LINES: u64 = 400_000;
    let mut b = SceneBuilder::new();
    let lamp = b.add_material(gray(1.0, 0.0));
    let black = b.add_material(gray(0.0, 0.0));
    let opacity = Opacity { factor: 0.3, ..Opacity::default() };
    let veil = b.add_material(Material { opacity, ..gray(0.0, 0.0).with_sides(Sides::Both) });
    let square = |z: f64| [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(x, y)| DVec3::new(x, y, z));
    shapes::quad(&mut b, square(0.0), lamp);
    let [p, q, r, s] = square(1.0);
    shapes::quad(&mut b, [s, r, q, p], black);
    shapes::quad(&mut b, square(0.5), veil);
    let model = Model::new(scene(b), Subdivision::PerFace).unwrap();
    let shot = shoot(&model, LINES, 1);
    // Directly opposed unit squares at distances 1 and ½ (Howell, configuration C-11).
    for (material, expected) in [(1, 0.7 * 0.199_824_895_7), (2, 0.3 * 0.415_253_284)] {
        let mut found = 0.0;
        model.mesh.for_each_side(|t, patch, _, id| {
            if model.scene.triangle(t).material.index() == material {
                found += model.mesh.covered_area(t, patch) * shot.solution(&model).irradiance[id.index()].x;
            }
        });
        let deviation = (expected * (1.0 - expected) / LINES as f64).sqrt();
        println!("{found} of {expected} ± {deviation}");
        assert!((found - expected).abs() < 5.0 * deviation, "{found} of {expected}");
    }
}
