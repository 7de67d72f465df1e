//! Every line crosses a closed scene an even number of times, and nothing depends on the tree.
#![allow(clippy::unwrap_used, reason = "helpers of tests fail like tests")]

mod common;

use common::{KINDS, arrange, difficult_line, furnished_room};
use glam::DVec3;
use sir_accel::{Hit, Ray};
use sir_geom::shapes::{self, Facing};
use sir_geom::{Line, Material, Rgb, Scene, SceneBuilder, Side};
use sir_lines::{Purpose, Streams};

/// Returns a sphere: an icosahedron whose edges are halved `level` times.
fn ball(level: u32) -> Scene {
    let mut b = SceneBuilder::new();
    let m = b.add_material(Material::diffuse("m", Rgb::splat(0.5)));
    shapes::sphere(&mut b, DVec3::new(0.1, -0.2, 0.3), 1.7, level, Facing::Outward, |_| m);
    b.build().unwrap().scene
}

fn each_line(scene: &Scene, seed: u64, lines: u64, mut check: impl FnMut(&Line, &[Hit])) {
    let accel = arrange(scene);
    let mut tracer = accel.tracer();
    let streams = Streams::new(seed, Purpose::PROBE);
    for i in 0..lines {
        let mut s = streams.line(i);
        if let Some(line) = difficult_line(scene, i as usize % KINDS, &mut s) {
            check(&line, tracer.all_hits(&line));
        }
    }
}

#[test]
fn no_odd_counts_in_a_furnished_room() {
    let mut odd = 0;
    each_line(&furnished_room(), 1, 1_200_000, |_, hits| odd += hits.len() % 2);
    assert_eq!(odd, 0);
}

#[test]
fn a_convex_solid_is_entered_once_and_left_once() {
    let mut met = 0;
    each_line(&ball(4), 2, 700_000, |line, hits| match hits {
        [] => {}
        [enter, leave] => {
            met += 1;
            assert_eq!((enter.side, leave.side), (Side::Front, Side::Back), "{line:?}");
            assert!(enter.t <= leave.t);
        }
        other => panic!("{line:?} met {} triangles: {other:?}", other.len()),
    });
    assert!(met > 400_000, "{met}");
}

/// A line in the opposite direction has the same hits, from the other sides, in reverse.
#[test]
fn both_directions_see_the_same_surfaces() {
    let scene = furnished_room();
    let accel = arrange(&scene);
    let mut backwards = accel.tracer();
    let sphere = scene.bounding_sphere();
    each_line(&scene, 3, 100_000, |line, hits| {
        // Origins far away are moved differently in the two directions, so the lines are not the same to the last bit.
        if line.origin.distance(sphere.center) > 1.5 * sphere.radius {
            return;
        }
        let reverse = Line { origin: line.origin, direction: -line.direction };
        let reversed: Vec<_> =
            backwards.all_hits(&reverse).iter().rev().map(|h| (h.triangle, h.side.flip())).collect();
        let hits: Vec<_> = hits.iter().map(|h| (h.triangle, h.side)).collect();
        assert_eq!(hits, reversed, "{line:?}");
    });
}

#[test]
fn hits_lie_where_they_say_and_in_order() {
    let scene = furnished_room();
    let size = scene.bounding_sphere().radius;
    each_line(&scene, 4, 200_000, |line, hits| {
        for pair in hits.windows(2) {
            assert!(pair[0].t <= pair[1].t + 2e-6 * size, "{pair:?}");
        }
        for hit in hits {
            let point = hit.point.point(scene.corners(hit.triangle));
            assert!(point.distance(line.at(hit.t)) < 1e-8 * size, "{hit:?}");
            let towards = scene.normal(hit.triangle).dot(line.direction);
            assert!(if hit.side == Side::Front { towards < 1e-8 } else { towards > -1e-8 });
        }
    });
}

/// The closest hit of a ray from outside is the first hit of its line.
#[test]
fn the_closest_hit_is_the_first_of_all() {
    let scene = furnished_room();
    let accel = arrange(&scene);
    let mut tracer = accel.tracer();
    let back = 4.0 * scene.bounding_sphere().radius;
    let streams = Streams::new(5, Purpose::PROBE);
    for i in 0..200_000u64 {
        let Some(line) = difficult_line(&scene, i as usize % KINDS, &mut streams.line(i)) else { continue };
        let from_outside = Line { origin: line.at(-back), ..line };
        let first = tracer.all_hits(&from_outside).first().copied();
        assert_eq!(tracer.closest(&from_outside.into()), first, "{line:?}");
    }
}

/// The closest hit of a ray that leaves a triangle is the next hit of the whole line.
#[test]
fn the_next_surface_is_the_next_of_all() {
    let scene = furnished_room();
    let accel = arrange(&scene);
    let (mut along, mut ahead) = (accel.tracer(), accel.tracer());
    let streams = Streams::new(6, Purpose::PROBE);
    let (mut compared, mut different) = (0, 0);
    for i in 0..100_000u64 {
        let Some(line) = difficult_line(&scene, 0, &mut streams.line(i)) else { continue };
        for pair in along.all_hits(&line).windows(2) {
            let ray = Line { origin: line.at(pair[0].t), ..line };
            let next = ahead.closest(&Ray::leaving(ray, pair[0].triangle)).map(|h| h.triangle);
            compared += 1;
            // The rounded origin makes a slightly different line, which may pass an edge on the other side.
            different += u32::from(next != Some(pair[1].triangle));
        }
    }
    assert!(compared > 50_000);
    assert!(different <= 2, "{different} of {compared}");
}
