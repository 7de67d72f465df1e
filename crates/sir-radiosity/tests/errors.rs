//! The standard errors that a single run states agree with the spread of many runs.
//!
//! Stated errors assume that the lines that reach a patch are independent, which is nearly true if there are many
//! patches. With few patches the stated errors are too large, for two reasons. First, the power that a patch holds
//! leaves with the next line, sooner or later. Chance decides only which patch receives it, so a patch that receives
//! the share `F` scatters by `√(1−F)` of the scatter with a random number of contributions. Second, a patch that
//! received more than usual passes the excess on to all patches except itself. What it receives later is less than
//! usual, so that for equal view factors `F` a deviation shrinks by `1 + ρF`.
//!
//! Batches correct the number of lines that meet a patch, but not the power that a patch sends on. Its neighbors
//! inherit that noise, which the stated errors leave out. It shows where there is little other noise, as in a furnace
//! of high reflectance.

#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "test helpers may panic and print")]

mod common;

use common::{TRANSPORTS, gray, scene, shoot};
use glam::DVec3;
use sir_geom::shapes::{self, Facing};
use sir_geom::{Material, Rgb, SceneBuilder};
use sir_mesh::{PatchSize, Subdivision};
use sir_radiosity::{Model, Solution};

/// Returns a cube with these materials, where `top` is the last face.
fn cube(walls: Material, top: Material, subdivision: Subdivision) -> Model {
    let mut b = SceneBuilder::new();
    let (walls, top) = (b.add_material(walls), b.add_material(top));
    shapes::cuboid(&mut b, DVec3::ZERO, DVec3::ONE, [walls, walls, walls, walls, walls, top], Facing::Inward);
    Model::new(scene(b), subdivision).unwrap()
}

/// Returns a cube in which every face emits.
fn furnace(subdivision: Subdivision) -> Model {
    let glowing = Material::diffuse("", Rgb::new(0.5, 0.8, 0.9)).emitting(Rgb::ONE);
    cube(glowing.clone(), glowing, subdivision)
}

/// Returns a cube in which one face emits.
fn lamp(subdivision: Subdivision) -> Model {
    cube(gray(0.0, 0.8), gray(1.0, 0.8), subdivision)
}

/// Returns the deviations from the mean over all seeds in units of the stated errors: the root mean square over all
/// patches and seeds, per band.
fn spread(runs: &[Solution]) -> Rgb {
    let n = runs.len() as f64;
    let (mut sum, mut freedom) = (Rgb::ZERO, 0.0);
    for side in 0..runs[0].irradiance.len() {
        let mean = runs.iter().map(|r| r.irradiance[side]).sum::<Rgb>() / n;
        // The mean variance, because a run that brought less than usual to a patch also states a smaller error.
        let variance = runs.iter().map(|r| r.error[side] * r.error[side]).sum::<Rgb>() / n;
        // Patches of the lamp cannot see each other, so they receive nothing from the first shot.
        if variance != Rgb::ZERO {
            let squares = runs.iter().map(|r| (r.irradiance[side] - mean) * (r.irradiance[side] - mean));
            sum += squares.sum::<Rgb>() / variance;
            freedom += n - 1.0;
        }
    }
    (sum / freedom).map(f64::sqrt)
}

/// Asserts that the spread lies between `least` and `most`, with a tolerance of `chance` on either side.
#[track_caller]
fn assert_honest(what: &str, runs: &[Solution], [least, most]: [f64; 2], chance: f64) {
    let spread = spread(runs);
    println!("{what}: {spread:.3}");
    assert!(spread.min_element() > least - chance, "{what}: the stated errors are too large: {spread}");
    assert!(spread.max_element() < most + chance, "{what}: the stated errors are too small: {spread}");
}

/// Returns the excess of the spread over 1 due to noise that patches inherit in batches.
fn inherited(way: &str) -> f64 {
    if way == "batches" { 0.06 } else { 0.0 }
}

/// The number of seeds gives a relative error of the spread of 0.5 % if patches are independent and normal, which they
/// are only approximately.
#[test]
fn errors_of_many_patches_are_honest() {
    const LINES: u64 = 50_000;
    for (what, model) in [
        ("furnace", furnace(Subdivision::Triangles(PatchSize::Count(600)))),
        ("lamp", lamp(Subdivision::Triangles(PatchSize::Count(600)))),
    ] {
        for (way, transport) in TRANSPORTS {
            let run = |seed| transport(&model, shoot(&model, LINES, seed), LINES, seed).solution(&model);
            let runs: Vec<_> = (1..=40).map(run).collect();
            assert_honest(&format!("{what}, {way}"), &runs, [1.0, 1.0 + inherited(way)], 0.03);
        }
        let runs: Vec<_> = (1..=40).map(|seed| shoot(&model, LINES, seed).solution(&model)).collect();
        assert_honest(&format!("{what}, direct light"), &runs, [1.0, 1.0], 0.03);
    }
}

/// Between faces of a cube, `F` is 1/5. The relative error of the spread is 3 % for 150 seeds and five free patches.
#[test]
fn errors_of_few_patches_are_not_too_small() {
    const LINES: u64 = 20_000;
    let (f, rho) = (0.2, 0.9);
    let least = f64::sqrt(1.0 - f) / (1.0 + rho * f);
    for (what, model) in [("furnace", furnace(Subdivision::PerFace)), ("lamp", lamp(Subdivision::PerFace))] {
        for (way, transport) in TRANSPORTS {
            let run = |seed| transport(&model, shoot(&model, LINES, seed), LINES, seed).solution(&model);
            let runs: Vec<_> = (1..=150).map(run).collect();
            assert_honest(&format!("{what} of six patches, {way}"), &runs, [least, 1.0], 0.08);
        }
    }
}

/// The noise of the first shot is passed on with the reflected light, which the stated errors leave out. It is common
/// to all lines of the transport, and small unless the shot has fewer lines than cross a patch.
#[test]
fn noise_of_the_first_shot_that_is_reflected_can_be_left_out() {
    let model = lamp(Subdivision::Triangles(PatchSize::Count(600)));
    for (way, transport) in TRANSPORTS {
        let run = |seed| transport(&model, shoot(&model, 5_000, seed), 50_000, seed).solution(&model);
        let runs: Vec<_> = (1..=40).map(run).collect();
        assert_honest(
            &format!("lamp with a short first shot, {way}"),
            &runs,
            [1.0, 1.0 + inherited(way)],
            0.03,
        );
    }
}
