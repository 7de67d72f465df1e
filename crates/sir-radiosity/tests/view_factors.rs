//! View factors against exact ones, and their stated errors against true ones.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use std::f64::consts::PI;

use glam::DVec3;
use sir_geom::shapes::{Facing, cuboid, quad};
use sir_geom::{Material, MaterialId, Rgb, SceneBuilder, Sides};
use sir_mesh::Subdivision;
use sir_radiosity::{
    Accuracy, AnyOrder, Grouping, Model, OneWorker, Receiver, SolveError, Stage, StageTotals,
    ViewFactorLines, ViewFactorSettings, ViewFactorTask, ViewFactors,
};

/// Opposite and adjacent faces of a cube (Howell, catalog of configuration factors, C-11 and C-14).
const OPPOSITE: f64 = 0.199_824_895_698_387;
const ADJACENT: f64 = 0.200_043_776_075_403;

fn materials<const N: usize>(builder: &mut SceneBuilder, sides: Sides) -> [MaterialId; N] {
    std::array::from_fn(|i| {
        builder.add_material(Material::diffuse(&format!("{i}"), Rgb::splat(0.5)).with_sides(sides))
    })
}

fn model(builder: SceneBuilder) -> Model {
    Model::new(builder.build().unwrap().scene, Subdivision::PerTriangle).unwrap()
}

fn count(model: &Model, settings: ViewFactorSettings) -> ViewFactors {
    let grouping = Grouping::by_material(&model.scene);
    let task = ViewFactorTask { model, grouping: &grouping, settings };
    let mut stage = ViewFactorLines::begin(task, (), &OneWorker).unwrap();
    loop {
        let mut totals = StageTotals::default();
        stage.trace(0, &mut AnyOrder, stage.round(), &mut totals);
        assert_eq!(totals.counts.lines, stage.round().end - stage.round().start);
        if !stage.advance(&OneWorker) {
            return stage.finish(totals, &OneWorker).unwrap();
        }
    }
}

/// Returns the error of settings for which view factors cannot be computed.
fn refusal(model: &Model, grouping: &Grouping, settings: ViewFactorSettings) -> SolveError {
    let task = ViewFactorTask { model, grouping, settings };
    ViewFactorLines::begin(task, (), &OneWorker).unwrap_err()
}

/// Asserts that the factor is exact within four standard errors, which are at most `error`.
#[track_caller]
fn assert_factor(factors: &ViewFactors, i: usize, j: usize, exact: f64, error: f64) {
    let (found, sigma) = (factors.factor(i, j), factors.error(i, j));
    assert!(sigma <= error, "F_{i}{j} has the error {sigma}");
    assert!((found - exact).abs() <= 4.0 * sigma, "F_{i}{j} = {found} ± {sigma}, exact {exact}");
}

fn receivers(groups: usize) -> impl Iterator<Item = Receiver> {
    (0..groups).map(Receiver::Group).chain([Receiver::Blocked, Receiver::Escaped])
}

fn cube() -> Model {
    let mut b = SceneBuilder::new();
    let faces = materials(&mut b, Sides::Front);
    cuboid(&mut b, DVec3::ZERO, DVec3::ONE, faces, Facing::Inward);
    model(b)
}

/// Faces 0 and 1, 2 and 3, 4 and 5 of a cube are opposite.
fn of_cube(i: usize, j: usize) -> f64 {
    match (i == j, i / 2 == j / 2) {
        (true, _) => 0.0,
        (false, true) => OPPOSITE,
        (false, false) => ADJACENT,
    }
}

#[test]
fn faces_of_a_cube() {
    let factors = count(&cube(), ViewFactorSettings::to_error(1e-3, 1));
    for i in 0..6 {
        assert!((factors.area(i) - 1.0).abs() < 1e-15);
        for j in 0..6 {
            assert_factor(&factors, i, j, of_cube(i, j), 1e-3);
            assert!(factors.reciprocity(i, j).z().abs() < 4.0);
        }
        let own = factors.share(i, Receiver::Group(i));
        assert_eq!((own.value, own.bound), (0.0, Some(3.0 / factors.lines()[i] as f64)));
        assert_eq!(receivers(6).map(|r| factors.count(i, r)).sum::<u64>(), factors.lines()[i]);
        assert_eq!(factors.count(i, Receiver::Blocked) + factors.count(i, Receiver::Escaped), 0);
    }
    // At most a quarter more lines than needed.
    let needed = 6.0 * ADJACENT * (1.0 - ADJACENT) / 1e-6;
    let lines = factors.total_lines() as f64;
    assert!(lines > 0.98 * needed && lines < 1.27 * needed, "{lines} lines, {needed} needed");
}

#[test]
fn perpendicular_rectangles_of_different_size() {
    let mut b = SceneBuilder::new();
    let [floor, wall] = materials(&mut b, Sides::Front);
    let at = |x: [f64; 3]| DVec3::from_array(x);
    quad(&mut b, [[0., 0., 0.], [1., 0., 0.], [1., 3., 0.], [0., 3., 0.]].map(at), floor);
    quad(&mut b, [[0., 0., 0.], [0., 3., 0.], [0., 3., 2.], [0., 0., 2.]].map(at), wall);
    let factors = count(&model(b), ViewFactorSettings::to_error(1e-3, 2));
    assert_factor(&factors, 0, 1, 0.318_996_701_479_05, 1e-3);
    assert_factor(&factors, 1, 0, 0.159_498_350_739_525, 1e-3);
    let escaped = factors.share(0, Receiver::Escaped);
    assert_eq!(escaped.value + factors.factor(0, 1), 1.0);
}

#[test]
fn opposed_squares_with_an_obstacle_that_absorbs() {
    let mut b = SceneBuilder::new();
    let [low, high, obstacle] = materials(&mut b, Sides::Front);
    let square = |b: &mut SceneBuilder, size: f64, z: f64, down: bool, material| {
        let mut corners = [(0., 0.), (size, 0.), (size, size), (0., size)].map(|(x, y)| DVec3::new(x, y, z));
        if down {
            corners.reverse();
        }
        quad(b, corners, material);
    };
    square(&mut b, 1.0, 0.0, false, low);
    square(&mut b, 1.0, 1.0, true, high);
    square(&mut b, 0.5, 0.5, false, obstacle);
    let factors = count(&model(b), ViewFactorSettings::to_error(1e-3, 3));
    let exact = 0.75 * OPPOSITE;
    assert_factor(&factors, 0, 1, exact, 1e-3);
    assert_factor(&factors, 1, 0, exact, 1e-3);
    // The lower square sees the back of the one-sided obstacle. The upper square sees its front, which looks as large
    // from above as the back does from below.
    assert_eq!(factors.factor(0, 2), 0.0);
    let (below, above) = (factors.share(0, Receiver::Blocked), factors.share(1, Receiver::Group(2)));
    let sigma = (below.error * below.error + above.error * above.error).sqrt();
    assert!(below.value > 0.1 && (below.value - above.value).abs() < 4.0 * sigma, "{below:?}, {above:?}");
}

#[test]
fn a_box_in_a_box() {
    let mut b = SceneBuilder::new();
    let [inner, outer] = materials(&mut b, Sides::Front);
    cuboid(&mut b, DVec3::splat(-0.5), DVec3::splat(0.5), [inner; 6], Facing::Outward);
    cuboid(&mut b, DVec3::splat(-1.0), DVec3::splat(1.0), [outer; 6], Facing::Inward);
    let factors = count(&model(b), ViewFactorSettings::to_error(1e-3, 4));
    for (i, j, exact) in [(0, 0, 0.0), (0, 1, 1.0), (1, 0, 0.25), (1, 1, 0.75)] {
        assert_factor(&factors, i, j, exact, 1e-3);
    }
    // All light that leaves the inner box arrives at the outer one, so closure leaves no noise.
    let closed = factors.closed().unwrap();
    assert!((closed.factor(1, 0) - 0.25).abs() < 1e-9 && (closed.factor(1, 1) - 0.75).abs() < 1e-9);
    assert!(closed.share(1, Receiver::Group(0)).1 < 1e-6);
    // For the same reason, few lines from the inner box are needed.
    assert!(factors.lines()[0] < factors.lines()[1] / 10);
}

#[test]
fn a_small_sphere_in_a_sphere_has_good_errors_too() {
    let mut b = SceneBuilder::new();
    let [inner, outer] = materials(&mut b, Sides::Front);
    sir_geom::shapes::sphere(&mut b, DVec3::ZERO, 0.1, 3, Facing::Outward, |_| inner);
    sir_geom::shapes::sphere(&mut b, DVec3::ZERO, 1.0, 3, Facing::Inward, |_| outer);
    let accuracy = Some(Accuracy { error: 1e-4, relative: 0.03 });
    let factors = count(&model(b), ViewFactorSettings { accuracy, lines: 10_000_000, seed: 5 });
    // Both solids are convex and similar, so this is exact for them, as it is for spheres.
    assert_factor(&factors, 1, 0, 0.01, 3e-4);
    assert_factor(&factors, 0, 1, 1.0, 1e-2);
    assert!(factors.total_lines() < 300_000, "{} lines", factors.total_lines());
}

#[test]
fn inside_of_a_cylinder() {
    // With 180 sides, a prism differs by less than 10⁻⁴.
    let segments = 180;
    let mut b = SceneBuilder::new();
    let [side, base, top] = materials(&mut b, Sides::Front);
    let ring = |b: &mut SceneBuilder, z: f64| -> Vec<_> {
        let angles = (0..segments).map(|k| 2.0 * PI * f64::from(k) / f64::from(segments));
        angles.map(|phi| b.add_vertex(DVec3::new(phi.cos(), phi.sin(), z))).collect()
    };
    let (low, mut high) = (ring(&mut b, 0.0), ring(&mut b, 2.0));
    for k in 0..segments as usize {
        let next = (k + 1) % segments as usize;
        b.add_polygon(&[low[next], low[k], high[k], high[next]], side);
    }
    b.add_polygon(&low, base);
    high.reverse();
    b.add_polygon(&high, top);
    let factors = count(&model(b), ViewFactorSettings::to_error(1.5e-3, 6));
    for (i, j, exact) in [
        (0, 0, 0.585_786_437_626_905),
        (0, 1, 0.207_106_781_186_548),
        (1, 0, 0.828_427_124_746_19),
        (1, 2, 0.171_572_875_253_81),
        (2, 0, 0.828_427_124_746_19),
        (1, 1, 0.0),
    ] {
        assert_factor(&factors, i, j, exact, 1.5e-3);
    }
}

#[test]
fn both_sides_of_a_sheet_count() {
    // Of each half of a cube, a sheet across its middle sees five faces and nothing else.
    let mut b = SceneBuilder::new();
    let [walls, _] = materials(&mut b, Sides::Front);
    let [sheet] = materials(&mut b, Sides::Both);
    cuboid(&mut b, DVec3::ZERO, DVec3::ONE, [walls; 6], Facing::Inward);
    let corners = [(0., 0.), (1., 0.), (1., 1.), (0., 1.)].map(|(x, y)| DVec3::new(x, y, 0.5));
    quad(&mut b, corners, sheet);
    let factors = count(&model(b), ViewFactorSettings::to_error(2e-3, 7));
    assert_eq!(factors.area(1), 2.0);
    assert_eq!(factors.factor(1, 0), 1.0);
    assert_factor(&factors, 0, 1, 2.0 / 6.0, 2e-3);
}

/// Returns the root mean square of deviations in units of standard errors, over all factors of a cube that are not
/// exactly zero.
fn rms_z(runs: &[ViewFactors], of: impl Fn(&ViewFactors, usize, usize) -> (f64, f64)) -> f64 {
    let pairs = (0..36).map(|k| (k / 6, k % 6)).filter(|(i, j)| i != j);
    let squares = runs.iter().flat_map(|run| pairs.clone().map(|(i, j)| (i, j, of(run, i, j))));
    let (mut sum, mut number) = (0.0, 0.0);
    for (i, j, (found, sigma)) in squares {
        let z = (found - of_cube(i, j)) / sigma;
        sum += z * z;
        number += 1.0;
    }
    f64::sqrt(sum / number)
}

#[test]
fn errors_are_what_they_say() {
    // 40 runs of 24 independent numbers: the root mean square of z has a standard deviation of 2.3 %.
    let cube = cube();
    let runs: Vec<_> = (0..40).map(|seed| count(&cube, ViewFactorSettings::of_lines(12_000, seed))).collect();
    let counted = rms_z(&runs, |run, i, j| (run.factor(i, j), run.error(i, j)));
    assert!((0.9..=1.1).contains(&counted), "rms z = {counted}");
    let pairs = || (0..6).flat_map(|i| (0..i).map(move |j| (i, j)));
    let residuals = runs.iter().flat_map(|run| pairs().map(|(i, j)| run.reciprocity(i, j).z()));
    let squares: f64 = residuals.map(|z| z * z).sum();
    let reciprocity = (squares / (runs.len() as f64 * 15.0)).sqrt();
    assert!((0.9..=1.1).contains(&reciprocity), "rms z of reciprocity = {reciprocity}");
    // Four times the lines, half the error.
    let more = count(&cube, ViewFactorSettings::of_lines(48_000, 0));
    let ratio = runs[0].error(0, 1) / more.error(0, 1);
    assert!((ratio - 2.0).abs() < 0.1, "{ratio}");

    // Closed factors have smaller errors, and these are correct, too.
    let closed: Vec<_> = runs.iter().map(|run| run.closed().unwrap()).collect();
    for (run, closed) in runs.iter().zip(&closed) {
        for i in 0..6 {
            let row: f64 = receivers(6).map(|receiver| closed.share(i, receiver).0).sum();
            assert!((row - 1.0).abs() < 1e-9);
            assert_eq!(closed.factor(i, i), 0.0);
            for j in (0..6).filter(|&j| j != i) {
                assert!(closed.reciprocity(i, j).abs() < 1e-15);
                assert!(closed.share(i, Receiver::Group(j)).1 < run.error(i, j));
            }
        }
    }
    // Of 30 numbers 9 are independent: a standard deviation of 3.7 %.
    let find = |run: &ViewFactors| runs.iter().position(|other| other == run).unwrap();
    let adjusted = rms_z(&runs, |run, i, j| closed[find(run)].share(i, Receiver::Group(j)));
    assert!((0.85..=1.15).contains(&adjusted), "rms z = {adjusted}");
}

#[test]
fn lines_used_give_the_same_again() {
    let cube = cube();
    for error in [3e-3, 4e-3, 7.7e-3] {
        let to_error = count(&cube, ViewFactorSettings::to_error(error, 8));
        let again = count(&cube, ViewFactorSettings::of_lines(to_error.total_lines(), 8));
        assert_eq!(to_error, again);
    }
    // Any number of lines is traced to the last one.
    assert_eq!(count(&cube, ViewFactorSettings::of_lines(23_457, 8)).total_lines(), 23_457);
    let with = |seed| count(&cube, ViewFactorSettings::of_lines(5_000, seed));
    assert_ne!(with(8), with(9));
}

#[test]
fn too_few_lines_and_too_many_groups_are_refused() {
    let cube = cube();
    let grouping = Grouping::by_material(&cube.scene);
    let refused = refusal(&cube, &grouping, ViewFactorSettings::of_lines(95, 1));
    assert_eq!(refused, SolveError::TooFewLines { lines: 95, groups: 6, fewest: 96 });

    let mut b = SceneBuilder::new();
    let [material] = materials(&mut b, Sides::Front);
    for k in 0..=4096 {
        b.begin_group(&format!("part {k}"));
        let corners = [DVec3::ZERO, DVec3::X, DVec3::Y].map(|p| b.add_vertex(p + f64::from(k) * DVec3::Z));
        b.add_polygon(&corners, material);
    }
    let many = model(b);
    let parts = Grouping::by_part(&many.scene);
    let refused = refusal(&many, &parts, ViewFactorSettings::to_error(0.1, 1));
    assert_eq!(refused, SolveError::TooManyGroups { groups: 4097, most: 4096 });
}
