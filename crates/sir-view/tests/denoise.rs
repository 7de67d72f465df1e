//! Properties of denoised pictures: less noise, unchanged shadows, and no change beyond the stated error.

#![allow(clippy::unwrap_used, reason = "a step that fails is a test that fails")]

use glam::DVec3;
use sir_geom::{Material, Rgb, Scene, SceneBuilder, Sides, shapes};
use sir_lines::{Purpose, Streams};
use sir_mesh::{PatchMesh, PatchSize, Subdivision};
use sir_view::DisplayMesh;

/// Relative standard error of the patches.
const NOISE: f64 = 0.08;

/// A sheet of 2 m by 1 m.
fn sheet() -> (Scene, PatchMesh) {
    let mut builder = SceneBuilder::new();
    let gray = builder.add_material(Material::diffuse("gray", Rgb::splat(0.5)).with_sides(Sides::Front));
    let corner = |x: f64, y: f64| DVec3::new(x, y, 0.0);
    shapes::quad(
        &mut builder,
        [corner(0.0, 0.0), corner(2.0, 0.0), corner(2.0, 1.0), corner(0.0, 1.0)],
        gray,
    );
    let scene = builder.build().unwrap().scene;
    let mesh = PatchMesh::new(&scene, Subdivision::Triangles(PatchSize::Count(20_000))).unwrap();
    (scene, mesh)
}

/// Returns, for each patch, the x coordinate of its middle, the true irradiance, the computed one, and its standard
/// error.
fn noisy(scene: &Scene, mesh: &PatchMesh, real: impl Fn(DVec3) -> f64) -> [Vec<f64>; 4] {
    let streams = Streams::new(7, Purpose::PICTURE);
    let mut all = [const { Vec::new() }; 4];
    mesh.for_each_side(|t, patch, _, id| {
        let middle = mesh.center(scene, t, patch);
        let mut stream = streams.line(id.index() as u64);
        // The sum of twelve uniform numbers has the variance one.
        let normal = (0..12).map(|_| stream.unit()).sum::<f64>() - 6.0;
        let real = real(middle);
        for (list, value) in all.iter_mut().zip([middle.x, real, real * (1.0 + NOISE * normal), real * NOISE])
        {
            list.push(value);
        }
    });
    all
}

fn gray(values: &[f64]) -> Vec<Rgb> {
    values.iter().map(|&x| Rgb::splat(x)).collect()
}

/// Returns the relative root mean square deviation where `x` is not within 5 cm of the middle of the sheet.
fn deviation(x: &[f64], real: &[f64], shown: &[Rgb]) -> f64 {
    let off: Vec<f64> = x
        .iter()
        .zip(real.iter().zip(shown))
        .filter(|(x, _)| (**x - 1.0).abs() > 0.05)
        .map(|(_, (real, shown))| (shown.x / real - 1.0).powi(2))
        .collect();
    (off.iter().sum::<f64>() / off.len() as f64).sqrt()
}

#[test]
fn even_light_becomes_even_and_a_slope_stays() {
    let (scene, mesh) = sheet();
    for slope in [0.0, 0.5] {
        let [x, real, computed, errors] = noisy(&scene, &mesh, |p| 3.0 + slope * p.x);
        let (computed, errors) = (gray(&computed), gray(&errors));
        let display = DisplayMesh::new(&scene, &mesh, &computed);
        let before = deviation(&x, &real, &computed);
        let after = deviation(&x, &real, &display.denoise(&errors, 2));
        assert!(before > 0.9 * NOISE && after < 0.25 * before, "slope {slope}: {before:.4} to {after:.4}");
    }
}

#[test]
fn the_border_of_a_shadow_stays() {
    let (scene, mesh) = sheet();
    let [x, real, computed, errors] = noisy(&scene, &mesh, |p| if p.x < 1.0 { 1.0 } else { 3.0 });
    let (computed, errors) = (gray(&computed), gray(&errors));
    let shown = DisplayMesh::new(&scene, &mesh, &computed).denoise(&errors, 2);
    assert!(deviation(&x, &real, &shown) < 0.25 * deviation(&x, &real, &computed));
    let near_border = |x: &f64| (x - 1.0).abs() < 0.1;
    for (x, (real, shown)) in x.iter().zip(real.iter().zip(&shown)).filter(|(x, _)| near_border(x)) {
        assert!((shown.x - real).abs() < 0.5, "at {x} m {} instead of {real}", shown.x);
    }
}

#[test]
fn nothing_moves_beyond_three_standard_errors_on_any_number_of_threads() {
    let (scene, mesh) = sheet();
    let [_, _, computed, errors] = noisy(&scene, &mesh, |p| 1.0 + 5.0 * p.x * p.x);
    let (computed, errors) = (gray(&computed), gray(&errors));
    let display = DisplayMesh::new(&scene, &mesh, &computed);
    let shown = display.denoise(&errors, 1);
    assert_eq!(shown, display.denoise(&errors, 3));
    // The error of a patch is its own, or that of shot noise with the mean grain around it, whichever is larger.
    for ((shown, computed), error) in shown.iter().zip(&computed).zip(&errors) {
        assert!((shown.x - computed.x).abs() <= 5.0 * error.x, "{} {} {}", shown.x, computed.x, error.x);
    }
}

#[test]
fn what_is_known_exactly_is_shown_as_it_is() {
    let (scene, mesh) = sheet();
    let [_, _, computed, _] = noisy(&scene, &mesh, |p| 1.0 + p.x);
    let computed = gray(&computed);
    let shown = DisplayMesh::new(&scene, &mesh, &computed).denoise(&vec![Rgb::ZERO; computed.len()], 2);
    assert_eq!(shown, computed);
}

#[test]
fn a_patch_that_no_line_has_met_takes_the_light_around_it() {
    let (scene, mesh) = sheet();
    let [_, _, computed, errors] = noisy(&scene, &mesh, |_| 2.0);
    // Two grains per patch on average: many patches have none.
    let grains = |x: f64| (2.0 + 2.0 * (x / 2.0 - 1.0) / NOISE).round().max(0.0);
    let counts: Vec<f64> = computed.iter().map(|&x| grains(x)).collect();
    let values = gray(&counts);
    let own = gray(&counts.iter().map(|n| n.sqrt()).collect::<Vec<_>>());
    assert!(counts.iter().filter(|&&n| n == 0.0).count() > 500 && errors.len() == counts.len());
    let shown = DisplayMesh::new(&scene, &mesh, &values).denoise(&own, 2);
    assert!(shown.iter().all(|e| e.x > 0.5), "{:?}", shown.iter().map(|e| e.x).fold(f64::INFINITY, f64::min));
}

#[test]
fn what_is_too_small_to_know_shows_the_light_beyond_its_edges() {
    // A lit floor, a wall that is large enough to be dark, and a tiny face that no line has met.
    let mut builder = SceneBuilder::new();
    let gray = builder.add_material(Material::diffuse("gray", Rgb::splat(0.5)).with_sides(Sides::Front));
    let at = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
    shapes::quad(
        &mut builder,
        [at(0.0, 0.0, 0.0), at(1.0, 0.0, 0.0), at(1.0, 1.0, 0.0), at(0.0, 1.0, 0.0)],
        gray,
    );
    shapes::quad(
        &mut builder,
        [at(1.0, 0.0, 0.0), at(1.0, 0.0, 1.0), at(1.0, 1.0, 1.0), at(1.0, 1.0, 0.0)],
        gray,
    );
    let tiny = |x: f64, z: f64| at(x, 1.0, z);
    shapes::quad(
        &mut builder,
        [tiny(0.0, 0.0), tiny(0.002, 0.0), tiny(0.002, 0.002), tiny(0.0, 0.002)],
        gray,
    );
    let scene = builder.build().unwrap().scene;
    let mesh = PatchMesh::new(&scene, Subdivision::Triangles(PatchSize::MaxArea(0.01))).unwrap();
    let (mut computed, mut errors) = (Vec::new(), Vec::new());
    mesh.for_each_side(|t, _, _, _| {
        let lit = t.0 < 2;
        // A hundred grains per patch.
        computed.push(if lit { Rgb::ONE } else { Rgb::ZERO });
        errors.push(if lit { Rgb::splat(0.1) } else { Rgb::ZERO });
    });
    let shown = DisplayMesh::new(&scene, &mesh, &computed).denoise(&errors, 2);
    mesh.for_each_side(|t, _, _, id| {
        let e = shown[id.index()].x;
        match t.0 {
            0 | 1 => assert!(e > 0.9, "the floor is {e}"),
            2 | 3 => assert!(e < 0.1, "the wall is {e}"),
            _ => assert!(e > 0.5, "the tiny face is {e}"),
        }
    });
}

/// A band may be zero with colored light, and negative where more power was sent than there was.
#[test]
fn bands_without_light_do_no_harm() {
    let (scene, mesh) = sheet();
    let [_, _, computed, errors] = noisy(&scene, &mesh, |p| 1.0 + p.x);
    let mut computed = gray(&computed);
    let errors = gray(&errors);
    for (i, e) in computed.iter_mut().enumerate() {
        match i % 50 {
            0 => e.z = 0.0,
            1 => *e = Rgb::ZERO,
            2 => e.y = -0.01,
            _ => {}
        }
    }
    let shown = DisplayMesh::new(&scene, &mesh, &computed).denoise(&errors, 2);
    assert!(shown.iter().all(|e| e.is_finite()), "{:?}", shown.iter().find(|e| !e.is_finite()));
}
