//! Whether the standard errors that a single run states are those that many runs show.
//!
//! They take the lines that reach a patch as independent, which is nearly so where patches are many. Of few patches the
//! stated errors are too large, for two reasons. What a patch holds leaves with the next line, sooner or later: chance
//! decides only who gets it, and a patch that gets the share `F` scatters by `√(1−F)` of what it would if the number
//! of gifts were random too. And who got more than usual passes it on to all but itself: what it gets later is
//! less than usual, so that for equal view factors `F` a deviation shrinks by `1 + ρF`.
//!
//! Batches correct the number of lines that meet a patch, but not what a patch sends on: its neighbors inherit that noise, which
//! the stated errors leave out. It shows where little other noise is left, as in a furnace of high reflectance.

#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "helpers of tests fail and talk like tests")]

mod common;

use common::{TRANSPORTS, gray, scene, shoot};
use glam::DVec3;
use sir_geom::shapes::{self, Facing};
use sir_geom::{Material, Rgb, SceneBuilder};
use sir_mesh::Subdivision;
use sir_radiosity::{Model, Solution};

/// A cube of these materials, the top's last.
fn cube(walls: Material, top: Material, subdivision: Subdivision) -> Model {
    let mut b = SceneBuilder::new();
    let (walls, top) = (b.add_material(walls), b.add_material(top));
    shapes::cuboid(&mut b, DVec3::ZERO, DVec3::ONE, [walls, walls, walls, walls, walls, top], Facing::Inward);
    Model::new(scene(b), subdivision).unwrap()
}

/// Every face glows.
fn furnace(subdivision: Subdivision) -> Model {
    let glowing = Material::diffuse("", Rgb::new(0.5, 0.8, 0.9)).emitting(Rgb::ONE);
    cube(glowing.clone(), glowing, subdivision)
}

/// One face glows.
fn lamp(subdivision: Subdivision) -> Model {
    cube(gray(0.0, 0.8), gray(1.0, 0.8), subdivision)
}

/// How far results lie from their mean over all seeds, in units of the errors that the runs state: root mean square
/// over all patches and seeds, per band.
fn spread(runs: &[Solution]) -> Rgb {
    let n = runs.len() as f64;
    let (mut sum, mut freedom) = (Rgb::ZERO, 0.0);
    for side in 0..runs[0].irradiance.len() {
        let mean = runs.iter().map(|r| r.irradiance[side]).sum::<Rgb>() / n;
        // The mean, because a run that brought a patch less than usual states a smaller error as well.
        let variance = runs.iter().map(|r| r.error[side] * r.error[side]).sum::<Rgb>() / n;
        // Lamps that cannot see each other receive nothing from the first shot.
        if variance != Rgb::ZERO {
            let squares = runs.iter().map(|r| (r.irradiance[side] - mean) * (r.irradiance[side] - mean));
            sum += squares.sum::<Rgb>() / variance;
            freedom += n - 1.0;
        }
    }
    (sum / freedom).map(f64::sqrt)
}

/// The spread must lie between `least` and `most`, but for `chance` to either side.
#[track_caller]
fn assert_honest(what: &str, runs: &[Solution], [least, most]: [f64; 2], chance: f64) {
    let spread = spread(runs);
    println!("{what}: {spread:.3}");
    assert!(spread.min_element() > least - chance, "{what}: the stated errors are too large: {spread}");
    assert!(spread.max_element() < most + chance, "{what}: the stated errors are too small: {spread}");
}

/// How much larger than 1 the spread may be, but for chance: what is inherited in batches.
fn inherited(way: &str) -> f64 {
    if way == "batches" { 0.06 } else { 0.0 }
}

/// Seeds enough for a relative error of the spread of 0.5 % if patches were independent and normal; they are not quite.
#[test]
fn errors_of_many_patches_are_honest() {
    const LINES: u64 = 50_000;
    for (what, model) in
        [("furnace", furnace(Subdivision::Patches(600))), ("lamp", lamp(Subdivision::Patches(600)))]
    {
        for (way, transport) in TRANSPORTS {
            let run = |seed| transport(&model, shoot(&model, LINES, seed), LINES, seed).solution;
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
            let run = |seed| transport(&model, shoot(&model, LINES, seed), LINES, seed).solution;
            let runs: Vec<_> = (1..=150).map(run).collect();
            assert_honest(&format!("{what} of six patches, {way}"), &runs, [least, 1.0], 0.08);
        }
    }
}

/// The noise of the first shot travels on with the reflected light, which the errors leave out: it is shared by all
/// lines of the shot, and small unless they are fewer than the lines that cross a patch.
#[test]
fn noise_of_the_first_shot_that_is_reflected_can_be_left_out() {
    let model = lamp(Subdivision::Patches(600));
    for (way, transport) in TRANSPORTS {
        let run = |seed| transport(&model, shoot(&model, 5_000, seed), 50_000, seed).solution;
        let runs: Vec<_> = (1..=40).map(run).collect();
        assert_honest(
            &format!("lamp with a short first shot, {way}"),
            &runs,
            [1.0, 1.0 + inherited(way)],
            0.03,
        );
    }
}
