//! Imperfect geometry against exact answers: coincident and intersecting surfaces, walls of a single sheet, scenes in
//! millimeters and kilometers, scenes far from the origin, a ground under a room.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "test helpers may panic and print")]

mod common;

use common::{Estimate, batches, gray, received, runs, scene, shoot};
use glam::{DQuat, DVec3};
use sir_geom::shapes::{Facing, cuboid, quad};
use sir_geom::{Material, MaterialId, Rgb, SceneBuilder, Side, Sides};
use sir_mesh::{PatchSize, Subdivision};
use sir_radiosity::{Model, Solution};

const fn v(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

fn model(builder: SceneBuilder, subdivision: Subdivision) -> Model {
    Model::new(scene(builder), subdivision).unwrap()
}

/// Returns a gray material whose two sides are equal, including emission.
fn both(m: f64, rho: f64) -> Material {
    Material { back_emits: true, ..gray(m, rho).with_sides(Sides::Both) }
}

/// Asserts that a share of the lines is within four standard errors of a binomial variable.
#[track_caller]
fn assert_share(found: f64, exact: f64, lines: u64, what: &str) {
    let sigma = (exact * (1.0 - exact) / lines as f64).sqrt();
    println!("{what}: {found:.6}, exactly {exact:.6} ± {sigma:.6}");
    assert!((found - exact).abs() <= 4.0 * sigma, "{what}: {found}, exactly {exact} ± {sigma}");
}

/// In a room whose surfaces all emit and reflect equally on both sides, the radiosity is `M/(1 − ρ)` everywhere, in and
/// between boxes that intersect each other, the floor and a wall.
#[test]
fn a_furnace_of_boxes_that_go_through_each_other() {
    let (m, rho) = (1.0, 0.7);
    let mut b = SceneBuilder::new();
    let room = [0; 6].map(|_| b.add_material(both(m, rho)));
    cuboid(&mut b, DVec3::ZERO, v(4.0, 3.0, 2.0), room, Facing::Inward);
    for (min, max) in [
        (v(1.0, 1.0, -0.3), v(2.0, 2.0, 1.0)),
        (v(1.3, 0.7, 0.2), v(2.4, 1.6, 1.3)),
        (v(1.1, 1.2, 0.0), v(1.9, 4.0, 0.8)),
        (v(1.0, 1.0, 0.5), v(3.0, 2.0, 1.0)),
    ] {
        let box_material = b.add_material(both(m, rho));
        cuboid(&mut b, min, max, [box_material; 6], Facing::Outward);
    }
    // An enclosure around everything, so that parts outside the room are in a furnace, too.
    let outer = b.add_material(both(m, rho));
    cuboid(&mut b, DVec3::splat(-1.0), v(5.0, 5.0, 3.0), [outer; 6], Facing::Inward);
    let model = model(b, Subdivision::PerFace);
    let runs = runs(&model, batches, 400_000, 16);
    let exact = m / (1.0 - rho);
    for material in 0..runs[0].len() {
        let what = format!("furnace, material {material}");
        Estimate::of(runs.iter().map(|run| run[material].x)).assert_is(exact, &what);
    }
}

/// Two overlapping boxes emit the power that the surface of their union emits, although four of their faces coincide
/// and the others intersect.
#[test]
fn the_light_of_boxes_in_each_other_is_that_of_their_union() {
    let lines = 400_000;
    for turn in [DQuat::IDENTITY, DQuat::from_axis_angle(v(1.0, 2.0, 0.5).normalize(), 0.7)] {
        let mut b = SceneBuilder::new();
        let black = b.add_material(gray(0.0, 0.0));
        cuboid(&mut b, DVec3::splat(-6.0), DVec3::splat(6.0), [black; 6], Facing::Inward);
        let lamp = b.add_material(gray(1.0, 0.0));
        turned_box(&mut b, turn, DVec3::ZERO, v(2.0, 1.0, 1.0), lamp);
        turned_box(&mut b, turn, v(1.0, 0.0, 0.0), v(3.0, 1.0, 1.0), lamp);
        // Through both boxes, not in the plane of any face.
        turned_box(&mut b, turn, v(1.25, -1.0, 0.25), v(1.75, 2.0, 0.75), lamp);
        let model = model(b, Subdivision::PerTriangle);
        let shot = shoot(&model, lines, 5);
        assert!(shot.balance.closes());
        let (all, union) = (2.0 * 10.0 + 6.5, 14.0 - 2.0 * 0.25 + 4.0 + 2.0 * 0.25);
        assert!((shot.unit.watts(shot.balance.emitted).x / all - 1.0).abs() < 1e-9);
        // Power that meets another part of the union is received there.
        let on_fronts: f64 = received(&model, &shot).iter().sum();
        assert_share(on_fronts / all, union / all, lines, "union");
        let blocked = shot.unit.watts(shot.balance.blocked).x / all;
        assert_share(blocked, 1.0 - union / all, lines, "blocked");
    }
}

fn turned_box(b: &mut SceneBuilder, turn: DQuat, min: DVec3, max: DVec3, material: MaterialId) {
    let p = |i: usize| {
        let pick = |axis: usize| if i >> axis & 1 == 0 { min[axis] } else { max[axis] };
        turn * v(pick(0), pick(1), pick(2))
    };
    for [i, j, k, l] in [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]] {
        quad(b, [p(i), p(j), p(k), p(l)], material);
    }
}

/// A square in the middle of the floor of a furnace, coplanar with the floor. Before or after the floor in the file, it is
/// on top, because it is smaller; the floor below receives nothing, and everything visible has `M/(1 − ρ)`.
#[test]
fn a_decal_covers_what_is_below_and_changes_nothing_else() {
    let (m, rho) = (1.0, 0.6);
    for decal_last in [true, false] {
        let mut b = SceneBuilder::new();
        let [walls, floor, decal] = [0; 3].map(|_| b.add_material(gray(m, rho)));
        let square = |b: &mut SceneBuilder| {
            let corners = [v(0.25, 0.25, 0.0), v(0.75, 0.25, 0.0), v(0.75, 0.75, 0.0), v(0.25, 0.75, 0.0)];
            quad(b, corners, decal);
        };
        if !decal_last {
            square(&mut b);
        }
        cuboid(&mut b, DVec3::ZERO, DVec3::ONE, [walls, walls, walls, walls, floor, walls], Facing::Inward);
        if decal_last {
            square(&mut b);
        }
        // Patch edges are a quarter of the edges of the cube, so that patches are covered completely or not at all.
        let model = model(b, Subdivision::Triangles(PatchSize::MaxEdge(0.36)));
        let shot = shoot(&model, 200_000, 2);
        assert!(shot.balance.closes());
        let solution = batches(&model, shot, 400_000, 2).solution(&model);
        let (mut seen, mut area) = (0.0, 0.0);
        model.mesh.for_each_side(|triangle, patch, _, side| {
            let middle = model.mesh.center(&model.scene, triangle, patch);
            let material = model.scene.triangle(triangle).material;
            let in_square = (middle - 0.5).truncate().abs().max_element() < 0.25;
            let covered = material == floor && in_square;
            let irradiance = solution.irradiance[side.index()].x;
            if covered {
                assert_eq!(irradiance, 0.0, "{material:?} at {middle}");
            } else {
                seen += irradiance * model.mesh.patch_area(triangle, patch);
                area += model.mesh.patch_area(triangle, patch);
            }
        });
        assert!((area - 6.0).abs() < 1e-12);
        let exact = m / (1.0 - rho);
        assert!((seen / area / exact - 1.0).abs() < 2e-3, "{} of {exact}", seen / area);
    }
}

/// A room divided by a single sheet, with a lamp in one half. The other half receives no light at all, whether the
/// sheet has one side or two, whether it ends at the walls or behind them, and however the room is rotated.
#[test]
fn a_wall_of_one_sheet_lets_nothing_through() {
    for sides in [Sides::Front, Sides::Both] {
        for beyond in [0.0, 0.1] {
            for turn in [DQuat::IDENTITY, DQuat::from_axis_angle(v(1.0, 2.0, 0.5).normalize(), 0.7)] {
                let mut b = SceneBuilder::new();
                let at = |p: DVec3| turn * p;
                let halves = [0; 2].map(|_| b.add_material(gray(0.0, 0.8)));
                let sheet = b.add_material(gray(0.0, 0.8).with_sides(sides));
                let lamp = b.add_material(gray(10.0, 0.0));
                let x = [0.0, 2.0, 4.0];
                for half in 0..2 {
                    let (l, r) = (x[half], x[half + 1]);
                    // No wall in the plane of the sheet.
                    let faces = [
                        [v(l, 0., 0.), v(r, 0., 0.), v(r, 3., 0.), v(l, 3., 0.)],
                        [v(l, 0., 2.), v(l, 3., 2.), v(r, 3., 2.), v(r, 0., 2.)],
                        [v(l, 0., 0.), v(l, 0., 2.), v(r, 0., 2.), v(r, 0., 0.)],
                        [v(l, 3., 0.), v(r, 3., 0.), v(r, 3., 2.), v(l, 3., 2.)],
                    ];
                    for face in faces {
                        quad(&mut b, face.map(at), halves[half]);
                    }
                }
                let ends = [
                    [v(0., 0., 0.), v(0., 3., 0.), v(0., 3., 2.), v(0., 0., 2.)],
                    [v(4., 0., 0.), v(4., 0., 2.), v(4., 3., 2.), v(4., 3., 0.)],
                ];
                quad(&mut b, ends[0].map(at), halves[0]);
                quad(&mut b, ends[1].map(at), halves[1]);
                let (lo, y, z) = (-beyond, 3.0 + beyond, 2.0 + beyond);
                quad(&mut b, [v(2., lo, lo), v(2., lo, z), v(2., y, z), v(2., y, lo)].map(at), sheet);
                quad(
                    &mut b,
                    [v(1., 1., 1.9), v(1., 2., 1.9), v(1.9, 2., 1.9), v(1.9, 1., 1.9)].map(at),
                    lamp,
                );
                let model = model(b, Subdivision::Triangles(PatchSize::Count(500)));
                let shot = shoot(&model, 300_000, 3);
                assert!(shot.balance.closes());
                let run = batches(&model, shot, 600_000, 3);
                assert!(run.balance.closes());
                let solution = run.solution(&model);
                let mut lit = 0;
                model.mesh.for_each_side(|triangle, _, side, id| {
                    let material = model.scene.triangle(triangle).material;
                    // The front of the sheet faces the lamp.
                    let dark = material == halves[1] || material == sheet && side == Side::Back;
                    if dark {
                        assert_eq!(
                            solution.irradiance[id.index()],
                            Rgb::ZERO,
                            "{sides:?} {beyond} {triangle}"
                        );
                    } else if material == sheet {
                        lit += i32::from(solution.irradiance[id.index()] != Rgb::ZERO);
                    }
                });
                assert!(lit > 0);
            }
        }
    }
}

/// Returns a room with a lamp and a box, with all corners on multiples of an eighth.
fn furnished(scale: f64, offset: DVec3) -> Model {
    let mut b = SceneBuilder::new();
    let at = |p: DVec3| offset + scale * p;
    let [white, red, lamp] =
        [(0.0, 0.8), (0.0, 0.4), (5.0, 0.0)].map(|(m, rho)| b.add_material(gray(m, rho)));
    cuboid(
        &mut b,
        at(DVec3::ZERO),
        at(v(4.0, 3.0, 2.5)),
        [red, white, white, white, white, white],
        Facing::Inward,
    );
    cuboid(&mut b, at(v(1.0, 1.0, 0.0)), at(v(2.0, 2.0, 1.25)), [white; 6], Facing::Outward);
    let (l, r, h) = (1.5, 2.5, 2.375);
    quad(&mut b, [v(l, l, h), v(l, r, h), v(r, r, h), v(r, l, h)].map(at), lamp);
    model(b, Subdivision::PerTriangle)
}

fn solve(model: &Model) -> Solution {
    let shot = shoot(model, 100_000, 11);
    assert!(shot.balance.closes());
    batches(model, shot, 200_000, 11).solution(model)
}

/// Returns the mean deviation of the irradiances from those of another solution, weighted by area and relative to the
/// mean.
fn deviation(model: &Model, found: &Solution, expected: &Solution) -> f64 {
    let (mut off, mut sum) = (0.0, 0.0);
    model.mesh.for_each_side(|triangle, patch, _, side| {
        let [a, b] = [found, expected].map(|s| s.irradiance[side.index()].x);
        off += (a - b).abs() * model.mesh.patch_area(triangle, patch);
        sum += b * model.mesh.patch_area(triangle, patch);
    });
    off / sum
}

/// The same room in other units has the same irradiances if its lamps have the same exitance. They have the same bits
/// if the scale is a power of two. Otherwise they differ by rounding, which may also split a flat side of the convex
/// hull along its other diagonal, and then some of the lines differ.
#[test]
fn millimeters_and_kilometers() {
    let model = furnished(1.0, DVec3::ZERO);
    let meters = solve(&model);
    for scale in [1024.0, 1.0 / 1024.0, 1_048_576.0] {
        assert_eq!(solve(&furnished(scale, DVec3::ZERO)).irradiance, meters.irradiance, "{scale}");
    }
    for scale in [1e-3, 1e3, 1e6, 1e-6, 0.0254] {
        let off = deviation(&model, &solve(&furnished(scale, DVec3::ZERO)), &meters);
        println!("scale {scale}: {off:e}");
        assert!(off < 5e-3, "{scale}: {off}");
    }
}

/// The light is the same far from the origin, as long as coordinates have enough digits: their step is 10⁻¹⁰ m at 10⁶
/// m, 10⁻⁷ m at 10⁹ m, and 0.1 mm at 10¹² m. Smaller distances are lost.
#[test]
fn far_from_the_origin() {
    let model = furnished(1.0, DVec3::ZERO);
    let here = solve(&model);
    for offset in [1e6, 1e9, 1e12] {
        let there = solve(&furnished(1.0, v(offset + 0.1, -offset, 0.3 * offset)));
        let off = deviation(&model, &there, &here);
        println!("offset {offset}: {off:e}");
        assert!(off < 2e-3, "{offset}: {off}");
    }
}

/// Adds a disc 200 m wide, in the plane of the floor.
fn ground(b: &mut SceneBuilder, material: MaterialId) {
    let corners: Vec<_> = (0..64)
        .map(|i| std::f64::consts::TAU * f64::from(i) / 64.0)
        .map(|a| b.add_vertex(v(100.0 * a.cos(), 100.0 * a.sin(), 0.0)))
        .collect();
    b.add_polygon(&corners, material);
}

/// A furnace on a ground 200 m wide keeps its light: nothing escapes below the walls.
#[test]
fn a_room_on_a_wide_ground_is_as_tight_as_one_without() {
    let (m, rho) = (1.0, 0.5);
    // With a floor of its own in the plane of the ground, or on the ground alone.
    for own_floor in [true, false] {
        let mut b = SceneBuilder::new();
        let outside = b.add_material(gray(0.0, 0.5));
        ground(&mut b, outside);
        // Walls are single two-sided sheets. Only the insides emit.
        let wall = b.add_material(gray(m, rho).with_sides(Sides::Both));
        let size = v(4.0, 3.0, 2.5);
        let [x, y, z] = [DVec3::X * size.x, DVec3::Y * size.y, DVec3::Z * size.z];
        let mut faces = vec![
            [DVec3::ZERO, y, y + z, z],
            [x, x + z, x + y + z, x + y],
            [DVec3::ZERO, z, x + z, x],
            [y, x + y, x + y + z, y + z],
            [z, y + z, x + y + z, x + z],
        ];
        if own_floor {
            faces.push([DVec3::ZERO, x, x + y, y]);
        }
        for face in faces {
            quad(&mut b, face, wall);
        }
        let model = model(b, Subdivision::PerFace);
        let lines = 100_000;
        let shot = shoot(&model, lines, 4);
        assert!(shot.balance.closes());
        assert_eq!((shot.counts.empty, shot.balance.escaped.0), (0, [0; 3]));
        let of_ground = received(&model, &shot)[outside.index()];
        if own_floor {
            let mut radiosity = Vec::new();
            for seed in 1..=8 {
                let run = batches(&model, shoot(&model, lines, seed), 2_000_000, seed);
                assert_eq!(run.balance.escaped.0, [0; 3]);
                let (mut inside, solution) = (0.0, run.solution(&model));
                model.mesh.for_each_side(|triangle, patch, side, id| {
                    let material = model.scene.triangle(triangle).material;
                    if material == outside || side == Side::Back {
                        assert_eq!(solution.irradiance[id.index()], Rgb::ZERO, "{triangle} {side:?}");
                    } else {
                        let area = model.mesh.patch_area(triangle, patch);
                        inside += area * solution.irradiance[id.index()].x / 59.0;
                    }
                });
                radiosity.push(m + rho * inside);
            }
            let mean = Estimate::of(radiosity);
            mean.assert_is(m / (1.0 - rho), "furnace on a ground");
            assert_eq!(of_ground, 0.0);
        } else {
            // The ground receives what a floor would receive. By reciprocity, that is the share of a face that sees the
            // same exitance everywhere.
            let power = 47.0 * m;
            assert_share(of_ground / power, 12.0 / 47.0, lines, "ground as a floor");
        }
    }
}

/// A room whose wall at x = 0 has its front outside. It is a furnace if surfaces are two-sided. If they are one-sided,
/// the back of the wall absorbs a sixth of all light, and another sixth, its own, escapes.
#[test]
fn a_wall_turned_outside_is_a_matter_of_sides() {
    let (m, rho) = (1.0, 0.6);
    for sides in [Sides::Both, Sides::Front] {
        let mut b = SceneBuilder::new();
        let material = Material { back_emits: true, ..gray(m, rho).with_sides(sides) };
        let [wall, turned] = [0; 2].map(|_| b.add_material(material.clone()));
        let max = DVec3::ONE;
        let open = [turned, wall, wall, wall, wall, wall];
        let mut inward = SceneBuilder::new();
        let same = open.map(|_| inward.add_material(material.clone()));
        cuboid(&mut inward, DVec3::ZERO, max, same, Facing::Inward);
        let inward = scene(inward);
        for t in inward.triangle_ids() {
            let mut corners = inward.corners(t).map(|p| b.add_vertex(p));
            let face = inward.triangle(t).face.index();
            if face == 0 {
                corners.reverse();
            }
            b.add_polygon(&corners, open[face]);
        }
        let model = model(b, Subdivision::PerTriangle);
        if sides == Sides::Both {
            let runs = runs(&model, batches, 200_000, 16);
            Estimate::of(runs.iter().map(|run| run[0].x)).assert_is(m / (1.0 - rho), "fronts inside");
            for run in runs {
                assert!((run[turned.index()].x - m).abs() < 1e-9, "the outside gets nothing");
            }
        } else {
            let lines = 200_000;
            let shot = shoot(&model, lines, 6);
            let share = |power| shot.unit.watts(power).x / (6.0 * m);
            assert_share(share(shot.balance.blocked), 1.0 / 6.0, lines, "blocked");
            assert_share(share(shot.balance.escaped), 1.0 / 6.0, lines, "escaped");
        }
    }
}
