//! Surfaces in contact are ordered by priority, in both directions of the line.
#![allow(clippy::unwrap_used, reason = "helpers of tests fail like tests")]

mod common;

use common::arrange;
use glam::DVec3;
use sir_accel::{Accel, Options, Ray, TriangleId};
use sir_geom::{Line, Material, Rgb, Scene, SceneBuilder, Side, shapes};
use sir_lines::{Purpose, Streams};

/// Returns squares in planes at the given heights, facing up or down, in the order given.
fn sheets(sheets: &[(f64, Side)]) -> Scene {
    let mut b = SceneBuilder::new();
    let m = b.add_material(Material::diffuse("m", Rgb::splat(0.5)));
    // Tilted, so that rounding affects the distances.
    let tilt = glam::DQuat::from_axis_angle(DVec3::new(1.0, 2.0, 0.5).normalize(), 0.7);
    for (i, &(height, facing)) in sheets.iter().enumerate() {
        let r = 1.0 + 0.37 * i as f64;
        let mut corners = [(-r, -r), (r, -r), (r, r), (-r, r)].map(|(x, y)| tilt * DVec3::new(x, y, height));
        if facing == Side::Back {
            corners.reverse();
        }
        shapes::quad(&mut b, corners, m);
    }
    b.build().unwrap().scene
}

fn order(scene: &Scene, upwards: bool) -> Vec<(u32, Side)> {
    let tilt = glam::DQuat::from_axis_angle(DVec3::new(1.0, 2.0, 0.5).normalize(), 0.7);
    let direction = tilt * DVec3::new(0.3, 0.2, if upwards { 1.0 } else { -1.0 }).normalize();
    let line = Line { origin: tilt * DVec3::new(0.15, -0.11, 0.0) - direction, direction };
    let accel = arrange(scene);
    accel.tracer().all_hits(&line).iter().map(|h| (scene.triangle(h.triangle).face.0, h.side)).collect()
}

#[test]
fn a_later_decal_lies_on_top() {
    let scene = sheets(&[(0.0, Side::Front), (0.0, Side::Front)]);
    assert_eq!(order(&scene, false), [(1, Side::Front), (0, Side::Front)]);
    assert_eq!(order(&scene, true), [(0, Side::Back), (1, Side::Back)]);
}

#[test]
fn of_two_sheets_back_to_back_each_shows_its_front() {
    for (first, second) in [(Side::Front, Side::Back), (Side::Back, Side::Front)] {
        let scene = sheets(&[(0.0, first), (0.0, second)]);
        let up = u32::from(first == Side::Back);
        assert_eq!(order(&scene, false), [(up, Side::Front), (1 - up, Side::Back)]);
        assert_eq!(order(&scene, true), [(1 - up, Side::Front), (up, Side::Back)]);
    }
}

/// So many exact copies that quadratic running time would be noticed.
#[test]
fn a_thick_stack_of_copies_is_in_order() {
    const COPIES: u32 = 4000;
    let mut b = SceneBuilder::new();
    let m = b.add_material(Material::diffuse("m", Rgb::splat(0.5)));
    let vertices =
        [DVec3::ZERO, DVec3::new(1.0, 0.1, 0.3), DVec3::new(0.2, 1.0, 0.1)].map(|p| b.add_vertex(p));
    let [first, second, third] = vertices;
    for i in 0..COPIES {
        let corners = if i % 2 == 0 { vertices } else { [first, third, second] };
        b.add_polygon(&corners, m);
    }
    let scene = b.build().unwrap().scene;
    let line = Line { origin: DVec3::new(0.4, 0.4, 2.0), direction: -DVec3::Z };
    let accel = arrange(&scene);
    let met: Vec<_> = accel.tracer().all_hits(&line).iter().map(|h| (h.triangle.0, h.side)).collect();
    let fronts = (0..COPIES).rev().filter(|i| i % 2 == 0).map(|i| (i, Side::Front));
    let backs = (0..COPIES).filter(|i| i % 2 == 1).map(|i| (i, Side::Back));
    assert_eq!(met, fronts.chain(backs).collect::<Vec<_>>());
}

/// The other half of a square is in the same plane as the first, but not on top of it.
#[test]
fn a_ray_from_the_common_edge_of_coplanar_triangles_is_free() {
    let scene = sheets(&[(0.0, Side::Front)]);
    let accel = arrange(&scene);
    for t in scene.triangle_ids() {
        let [a, b, c] = scene.corners(t);
        for (p, q) in [(a, b), (b, c), (c, a)] {
            for direction in [scene.normal(t), (scene.normal(t) + 0.3 * DVec3::X).normalize()] {
                let ray = Ray::leaving(Line { origin: p.midpoint(q), direction }, t);
                assert_eq!(accel.tracer().closest(&ray), None);
            }
        }
    }
}

#[test]
fn a_gap_wider_than_contact_is_a_gap() {
    let scene = sheets(&[(1e-4, Side::Front), (0.0, Side::Front)]);
    assert_eq!(order(&scene, false), [(0, Side::Front), (1, Side::Front)]);
}

/// Sheets so close that each is in contact with the next one, but the first not with the last.
#[test]
fn contacts_are_transitive() {
    let (below, heights) = (3.0 * 2f64.powi(-21), [0.0, 0.65, 1.3].map(|h| h * 2f64.powi(-21)));
    let permutations = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];
    for facing in [Side::Front, Side::Back] {
        for permutation in permutations {
            let scene = sheets(&permutation.map(|i| (heights[i] - below, facing)));
            let (up, down) =
                if facing == Side::Front { ([0, 1, 2], [2, 1, 0]) } else { ([2, 1, 0], [0, 1, 2]) };
            for (upwards, expected) in [(true, up), (false, down)] {
                let met = order(&scene, upwards);
                let side = if upwards == (facing == Side::Back) { Side::Front } else { Side::Back };
                assert_eq!(met, expected.map(|face| (face, side)), "{permutation:?}, {facing:?}");
            }
        }
    }
}

/// Rectangles in one plane: at each point, all rays and lines see the same order, whatever leaves of the tree they are
/// in.
#[test]
fn many_rectangles_in_one_plane_have_one_order() {
    const COUNT: u32 = 300;
    let streams = Streams::new(3, Purpose::PROBE);
    let tilt = glam::DQuat::from_axis_angle(DVec3::new(1.0, 2.0, 0.5).normalize(), 0.7);
    let mut b = SceneBuilder::new();
    let m = b.add_material(Material::diffuse("m", Rgb::splat(0.5)));
    for i in 0..COUNT {
        let [x, y, width, height, turned, _]: [f64; 6] = streams.line(i.into()).point();
        let (x, y) = (3.0 * x, 3.0 * y);
        let (right, top) = (x + 0.1 + width, y + 0.1 + height);
        let mut corners =
            [(x, y), (right, y), (right, top), (x, top)].map(|(x, y)| tilt * DVec3::new(x, y, 1.0));
        if turned < 0.3 {
            corners.reverse();
        }
        shapes::quad(&mut b, corners, m);
    }
    let scene = b.build().unwrap().scene;
    let accel = arrange(&scene);
    let mut tracer = accel.tracer();
    let mut crossings = 0;
    for i in 0..2000 {
        let [x, y, dx, dy]: [f64; 4] = streams.line((COUNT + i).into()).point();
        let target = tilt * DVec3::new(4.0 * x, 4.0 * y, 1.0);
        let direction = (tilt * DVec3::new(dx - 0.5, dy - 0.5, -0.7)).normalize();
        let line = Line { origin: target - direction, direction };
        let hits = tracer.all_hits(&line).to_vec();
        crossings += hits.len();
        // Fronts with later ones first, then backs with earlier ones first.
        let order: Vec<_> = hits.iter().map(|hit| (hit.side, hit.triangle)).collect();
        let mut sorted = order.clone();
        sorted.sort_unstable_by_key(
            |&(side, TriangleId(id))| if side == Side::Front { (side, !id) } else { (side, id) },
        );
        assert_eq!(order, sorted);
        assert_eq!(tracer.closest(&line.into()), hits.first().copied());
        let back = Line { origin: target + direction, direction: -direction };
        let reversed: Vec<_> = tracer.all_hits(&back).iter().rev().map(|hit| hit.triangle).collect();
        assert_eq!(reversed, hits.iter().map(|hit| hit.triangle).collect::<Vec<_>>());
        for (k, hit) in hits.iter().enumerate() {
            let ray = Ray::leaving(Line { origin: line.at(hit.t), direction }, hit.triangle);
            let ahead = tracer.closest(&ray).map(|hit| hit.triangle);
            assert_eq!(ahead, hits.get(k + 1).map(|hit| hit.triangle));
            assert_eq!(tracer.occluded(&ray), ahead.is_some());
        }
    }
    assert!(crossings > 10_000, "{crossings}");
}

/// A triangle far away does not change which surfaces are in contact.
#[test]
fn contacts_do_not_depend_on_the_size_of_the_scene() {
    for far in [10.0, 1e3, 1e5] {
        let [mut apart, mut together] =
            [1e-3, 1e-8].map(|gap| sheets(&[(gap, Side::Front), (0.0, Side::Front)]));
        for (scene, expected) in [(&mut apart, [0, 1]), (&mut together, [1, 0])] {
            let mut positions = scene.vertices().to_vec();
            let mut indices: Vec<[u32; 3]> =
                scene.triangles().iter().map(|triangle| triangle.vertices.map(|v| v.0)).collect();
            let next = positions.len() as u32;
            positions.extend([DVec3::X, DVec3::Y, DVec3::Z].map(|p| p + far));
            indices.push([next, next + 1, next + 2]);
            let accel = Accel::build(&positions, &indices, Options::default()).unwrap();
            let t = TriangleId(0);
            let [a, b, c] = scene.corners(t);
            let normal = scene.normal(t);
            let line = Line { origin: (a + b + c) / 3.0 + normal, direction: -normal };
            let met: Vec<_> = accel.tracer().all_hits(&line).iter().map(|h| h.triangle.0 / 2).collect();
            assert_eq!(met, expected, "{far}: {:?}", accel.contact_distance(t));
        }
    }
}

/// A ray that leaves the lower of two fronts is stopped by the upper one, and not vice versa.
#[test]
fn rays_follow_the_same_rule() {
    let scene = sheets(&[(0.0, Side::Front), (0.0, Side::Front)]);
    let accel = arrange(&scene);
    let mut tracer = accel.tracer();
    for t in scene.triangle_ids() {
        let [a, b, c] = scene.corners(t);
        let line = Line { origin: (a + b + c) / 3.0, direction: scene.normal(t) };
        let met = tracer.closest(&Ray::leaving(line, t)).map(|h| scene.triangle(h.triangle).face.0);
        let lower = scene.triangle(t).face.0 == 0;
        assert_eq!(met, lower.then_some(1), "{t}");
        let from_above = Line { origin: line.at(0.5), direction: -line.direction };
        assert_eq!(tracer.closest(&from_above.into()).map(|h| h.side), Some(Side::Front));
    }
}
