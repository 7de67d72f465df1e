//! Lines pass surfaces exactly where they are open.
#![allow(clippy::unwrap_used, reason = "helpers of tests fail like tests")]

mod common;

use common::{KINDS, arrange, difficult_line, furnished_room, furnished_room_of};
use glam::{DVec3, Vec2};
use sir_accel::Ray;
use sir_geom::{Line, Material, MaterialId, Opacity, Rgb, Scene, SceneBuilder, Texture, TextureMap, Wrap};
use sir_lines::{Purpose, Streams};

/// Returns unit squares `[0, 1]² × z` with texture coordinates equal to `x` and `y`.
fn squares(heights: &[f64], material: impl FnOnce(&mut SceneBuilder) -> MaterialId) -> Scene {
    let mut b = SceneBuilder::new();
    let m = material(&mut b);
    for &z in heights {
        let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
        let v = corners.map(|(x, y)| b.add_vertex(DVec3::new(x, y, z)));
        let places = corners.map(|(x, y)| Vec2::new(x as f32, y as f32));
        for [i, j, k] in [[0, 1, 2], [0, 2, 3]] {
            b.add_polygon(&[v[i], v[j], v[k]], m);
            b.set_corners(&[[places[i], places[j], places[k]]], None);
        }
    }
    b.build().unwrap().scene
}

/// Adds a checkerboard of 8 × 8 fields: the first one, at the origin, and every other one are open; the rest have the
/// given alpha.
fn checkerboard(b: &mut SceneBuilder, alpha: u8, cutoff: Option<f64>) -> MaterialId {
    let texel = |i: u32| [0, 0, 0, if (i % 8 + i / 8).is_multiple_of(2) { 0 } else { alpha }];
    let texture = b.add_texture(Texture::new(8, 8, (0..64).map(texel).collect()).unwrap());
    let map = TextureMap { texture, wrap: [Wrap::Repeat; 2], coordinates: 0 };
    let opacity = Opacity { factor: 1.0, map: Some(map), cutoff };
    b.add_material(Material { opacity, ..Material::diffuse("mask", Rgb::splat(0.5)) })
}

fn even(opacity: f64) -> impl FnOnce(&mut SceneBuilder) -> MaterialId {
    let opacity = Opacity { factor: opacity, ..Opacity::default() };
    move |b| b.add_material(Material { opacity, ..Material::diffuse("veil", Rgb::splat(0.5)) })
}

/// Returns a slanted line through a point of the unit square at height 0.
fn line_through(x: f64, y: f64, i: u64) -> Line {
    let mut s = Streams::new(5, Purpose::PROBE).line(i);
    let direction = DVec3::new(s.unit() - 0.5, s.unit() - 0.5, -1.0).normalize();
    Line { origin: DVec3::new(x, y, 0.0) - 2.0 * direction, direction }
}

#[test]
fn a_mask_stops_lines_exactly_where_it_is_closed() {
    // With a cutoff, half-covered fields are closed, too.
    for (alpha, cutoff) in [(255, None), (255, Some(0.5)), (140, Some(0.5))] {
        let scene = squares(&[0.0], |b| checkerboard(b, alpha, cutoff));
        let accel = arrange(&scene);
        let mut tracer = accel.tracer();
        let mut stopped = 0;
        // Centers of 16² cells in each of the fields.
        for i in 0..128 * 128u64 {
            let (column, row) = (i % 128, i / 128);
            let line = line_through((column as f64 + 0.5) / 128.0, (row as f64 + 0.5) / 128.0, i);
            let is_closed = (column / 16 + row / 16) % 2 == 1;
            assert_eq!(tracer.all_hits(&line).len(), usize::from(is_closed), "{line:?}");
            assert_eq!(tracer.closest(&line.into()).is_some(), is_closed, "{line:?}");
            stopped += u64::from(is_closed);
        }
        assert_eq!(stopped, 128 * 128 / 2);
    }
}

/// The number of 200,000 lines that are stopped agrees with a binomial distribution within five standard deviations: a
/// correct program would fail with one seed in a million.
#[test]
fn opacity_is_the_share_of_lines_that_are_stopped() {
    const LINES: u64 = 200_000;
    let assert_share = |count: u64, expected: f64| {
        let deviation = (expected * (1.0 - expected) / LINES as f64).sqrt();
        let share = count as f64 / LINES as f64;
        assert!((share - expected).abs() < 5.0 * deviation, "{share} of {expected}");
    };
    let scene = squares(&[0.0, -0.001], even(0.3));
    let accel = arrange(&scene);
    let mut tracer = accel.tracer();
    let streams = Streams::new(6, Purpose::PROBE);
    let (mut by_number, mut first_is_upper) = ([0; 3], 0);
    for i in 0..LINES {
        let mut s = streams.line(i);
        let line = line_through(0.1 + 0.8 * s.unit(), 0.1 + 0.8 * s.unit(), i);
        by_number[tracer.all_hits(&line).len()] += 1;
        first_is_upper += u64::from(tracer.closest(&line.into()).is_some_and(|hit| hit.triangle.0 < 2));
    }
    // The two squares stop lines independently.
    assert_share(by_number[0], 0.49);
    assert_share(by_number[1], 0.42);
    assert_share(by_number[2], 0.09);
    assert_share(first_is_upper, 0.3);
}

#[test]
fn closest_hits_are_the_first_of_all_hits() {
    let scene = furnished_room_of(Opacity { factor: 0.4, ..Opacity::default() });
    let accel = arrange(&scene);
    let (mut tracer, mut other) = (accel.tracer(), accel.tracer());
    let streams = Streams::new(7, Purpose::PROBE);
    let lines: Vec<Line> = (0..50_000u64)
        .filter_map(|i| difficult_line(&scene, i as usize % KINDS, &mut streams.line(i)))
        .collect();
    let rays: Vec<Ray> = lines.iter().map(|&line| line.into()).collect();
    let mut firsts = vec![None; lines.len()];
    tracer.closest_each(&rays, |i, hit| firsts[i] = hit);
    let mut all = Vec::new();
    tracer.all_hits_each(&lines, |found| {
        all.extend(found.lines().map(|line| found.hits()[line].to_vec()));
    });
    let mut later = 0;
    for ((line, first), all) in lines.iter().zip(&firsts).zip(&all) {
        // A line traced alone has the same hits as among others.
        assert_eq!(other.all_hits(line), &all[..]);
        assert_eq!(other.closest(&(*line).into()), *first);
        // Rounding may put hits at the origin before or behind it.
        if all.iter().all(|hit| hit.t.abs() > 1e-5) {
            let ahead = all.iter().find(|hit| hit.t > 0.0);
            assert_eq!(ahead.map(|hit| hit.triangle), first.map(|hit| hit.triangle), "{line:?}");
            later += usize::from(ahead.is_some());
        }
    }
    assert!(later > 20_000, "{later}");
}

#[test]
fn all_crossings_are_those_of_the_same_scene_without_gaps() {
    let open = furnished_room_of(Opacity { factor: 0.0, ..Opacity::default() });
    let closed = furnished_room();
    let (accel, opaque) = (arrange(&open), arrange(&closed));
    assert!(accel.bytes() > opaque.bytes());
    let (mut tracer, mut reference) = (accel.tracer(), opaque.tracer());
    assert!(accel.has_transparency() && !opaque.has_transparency());
    let streams = Streams::new(8, Purpose::PROBE);
    let lines: Vec<Line> = (0..20_000u64)
        .filter_map(|i| difficult_line(&open, i as usize % KINDS, &mut streams.line(i)))
        .collect();
    let mut found = Vec::new();
    tracer.all_crossings_each(&lines, |hits| found.extend_from_slice(hits.hits()));
    let mut expected = Vec::new();
    reference.all_hits_each(&lines, |hits| expected.extend_from_slice(hits.hits()));
    assert!(found == expected && found.len() > lines.len());
    assert!(lines.iter().all(|line| tracer.all_hits(line).is_empty()));
    assert!(lines.iter().all(|line| tracer.closest(&(*line).into()).is_none()));
}
